"""Whole-body sensing: how well a shape is known from encoders, a tip tracker and a fibre.

The paper had the tip alone (IV) and expects a measured shape to help (V). Robots that differ
from the model are sent to random poses; their shape is estimated from ever more sensors and
compared with the true one, and so is what the estimate says of its own error.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cache
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.shape_sensing.figures import draw
from sinuous.papers.workers import Workers
from sinuous.plants.fibre import Fibre, FibreReader
from sinuous.plants.mismatched import Mismatch, MismatchedPlant
from sinuous.plants.plant import Truth
from sinuous.plants.sensors import TipTracker
from sinuous.plants.shape_estimate import ShapeEstimate, ShapeEstimator, ShapePrior, TipFix
from sinuous.robots.centreline import Centreline
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc

SENSORS: dict[str, tuple[bool, bool]] = {
    "encoders alone": (False, False),
    "encoders, tip": (False, True),
    "encoders, fibre": (True, False),
    "encoders, fibre, tip": (True, True),
}
"""Whether there are a fibre and a tip tracker."""

ONE_SEGMENT = "hachen2025, one segment"
ROBOTS = ("hachen2025", "opencr_v4", ONE_SEGMENT)

_USUAL = Mismatch.representative()
MISMATCHES = {
    "representative": _USUAL,
    "twice that": replace(
        _USUAL,
        pitch_factor=1.0 + 2.0 * (_USUAL.pitch_factor - 1.0),
        cable_angle=2.0 * _USUAL.cable_angle,
        coupling=2.0 * _USUAL.coupling,
        unevenness=2.0 * _USUAL.unevenness,
        sag=2.0 * _USUAL.sag,
        base_tilt=(2.0 * _USUAL.base_tilt[0], 2.0 * _USUAL.base_tilt[1]),
        play=2.0 * _USUAL.play,
    ),
    "uneven bends": Mismatch(unevenness=0.3),
    "slack cables": replace(_USUAL, slack_bend=0.8),
    "none": Mismatch(),
}

INDIVIDUALS, POSES = 40, 5  # robots of each kind with sensors of their own, poses of each
QUICK_INDIVIDUALS, QUICK_POSES = 3, 2
LARGEST_BEND = 1.6  # of a segment in random poses [rad]
BINS = np.linspace(-4.0, 4.0, 33)  # of errors over their stated standard deviation

Item = tuple[str, str, int, int]


@dataclass(frozen=True, kw_only=True, eq=False)
class Rig:
    """A robot's model with its instruments, and what fuses them."""

    robot: PccRobot
    line: Centreline
    tracker: TipTracker
    fibre: Fibre
    estimator: ShapeEstimator


@cache
def rig(name: str) -> Rig:
    """A robot with the tracker of paper B, IV, and a fibre."""
    robot, tracker = load_pcc(name.split(",")[0]), TipTracker.printed()
    if name == ONE_SEGMENT:
        robot = replace(robot, segments=robot.segments[:1])
    line = Centreline(robot=robot, coil=tracker.coil)
    return Rig(
        robot=robot,
        line=line,
        tracker=tracker,
        fibre=Fibre(),
        estimator=ShapeEstimator(line, ShapePrior()),
    )


def run(workers: Workers, quick: bool) -> Data:
    """Every kind of robot with every kind of mismatch, many individuals of each."""
    individuals, poses = (QUICK_INDIVIDUALS, QUICK_POSES) if quick else (INDIVIDUALS, POSES)
    items: list[Item] = [
        (robot, mismatch, seed, poses)
        for robot in ROBOTS
        for mismatch in MISMATCHES
        for seed in range(individuals)
    ]
    found = workers.map("shape estimates", individual, items)
    rows = [
        _summary(robot, mismatch, sensors, [
            one[sensors] for item, one in zip(items, found, strict=True)
            if item[:2] == (robot, mismatch)
        ])
        for robot in ROBOTS
        for mismatch in MISMATCHES
        for sensors in SENSORS
    ]  # fmt: skip
    return {
        "individuals": individuals,
        "poses": poses,
        "bins": BINS.tolist(),
        "rows": rows,
        "example": example(),
    }


def individual(item: Item) -> dict[str, dict[str, Array]]:
    """One robot and its sensors, in some poses: errors and variances (K, S - 1, 3) by sensors."""
    name, mismatch, seed, count = item
    errors = {sensors: list[Array]() for sensors in SENSORS}
    variances = {sensors: list[Array]() for sensors in SENSORS}
    for truth, estimates in _visits(rig(name), MISMATCHES[mismatch], seed, count):
        for sensors, estimate in estimates.items():
            errors[sensors].append((estimate.points - truth.points)[1:])
            variances[sensors].append(np.diagonal(estimate.covariance, axis1=1, axis2=2)[1:])
    return {
        sensors: {"error": np.array(errors[sensors]), "variance": np.array(variances[sensors])}
        for sensors in SENSORS
    }


def example() -> dict[str, Any]:
    """One pose in full, for the first figure."""
    truth, estimates = list(_visits(rig("hachen2025"), MISMATCHES["representative"], 9, 2))[1]
    arc = np.cumsum(estimates["encoders alone"].bends.lengths)
    return {
        "arc_m": [0.0, *arc.tolist()],
        "true_m": truth.points.tolist(),
        "estimates": {
            sensors: {"points_m": one.points.tolist(), "covariance_m2": one.covariance.tolist()}
            for sensors, one in estimates.items()
        },
    }


def _visits(
    given: Rig, mismatch: Mismatch, seed: int, count: int
) -> Iterator[tuple[Truth, dict[str, ShapeEstimate]]]:
    """A robot goes from pose to pose; how it is, and what is estimated from which sensors."""
    plant = MismatchedPlant(given.robot, seed=seed, mismatch=mismatch)
    fibre, track = FibreReader(given.fibre, given.line, seed), given.tracker.reader(seed)
    rng, variance = np.random.default_rng(seed), given.tracker.accuracy.variance
    for _ in range(count):
        plant.step(given.robot.lengths(pose(given.robot, rng)) - plant.truth.lengths, 1.0)
        truth = plant.truth
        strain, tip = fibre.read(truth), TipFix(position=track(truth).tip, variance=variance)
        yield (
            truth,
            {
                name: given.estimator.estimate(
                    truth.lengths, strain=strain if along else None, tip=tip if at_tip else None
                )
                for name, (along, at_tip) in SENSORS.items()
            },
        )


def pose(robot: PccRobot, rng: np.random.Generator) -> Array:
    """A random configuration (n,): any length, bends uniform in the disc that limits allow."""
    parts = list[float]()
    for segment in robot.segments:
        gamma = rng.uniform(*segment.length) if segment.extensible else segment.home_length
        slope, offset = segment.bend_planes.T
        most = min(float(np.min(slope * gamma + offset)), LARGEST_BEND)
        bend, angle = most * np.sqrt(rng.uniform()), rng.uniform(-np.pi, np.pi)
        parts += [bend * np.cos(angle), bend * np.sin(angle)]
        parts += [gamma] if segment.extensible else []
    return np.array(parts)


def _summary(
    robot: str, mismatch: str, sensors: str, found: Sequence[dict[str, Array]]
) -> dict[str, Any]:
    """What all individuals of a kind come to."""
    error = np.array([one["error"] for one in found])  # (individuals, poses, S - 1, 3)
    variance = np.array([one["variance"] for one in found])
    normal = error / np.sqrt(variance)
    within = np.abs(normal) <= 2.0
    squares = np.sum(error**2, axis=3)
    histogram, _ = np.histogram(np.clip(normal, BINS[0], BINS[-1]), bins=BINS)
    return {
        "robot": robot,
        "mismatch": mismatch,
        "sensors": sensors,
        "tip_error_m": np.sqrt(squares[:, :, -1]).ravel().tolist(),
        "body_rms_m": np.sqrt(np.mean(squares, axis=2)).ravel().tolist(),
        "rms_by_point_m": np.sqrt(np.mean(squares, axis=(0, 1))).tolist(),
        "stated_by_point_m": np.sqrt(np.mean(np.sum(variance, axis=3), axis=(0, 1))).tolist(),
        "coverage_by_axis": np.mean(within, axis=(0, 1, 2)).tolist(),
        "coverage_by_individual": np.mean(within, axis=(1, 2, 3)).tolist(),
        "mean_square_normalised": float(np.mean(normal**2)),
        "histogram": histogram.tolist(),
    }


SHAPE_SENSING = Experiment(
    name="shape_sensing",
    title="The whole body from a fibre and a tip tracker",
    section="IV, V",
    run=run,
    draw=draw,
)
