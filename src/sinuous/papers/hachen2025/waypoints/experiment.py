"""III-D: way-points inside passages, every controller, without and with the disturbance."""

from typing import Any

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.gains import DLS_BEST, DLS_PRINTED
from sinuous.papers.hachen2025.runs import scenario
from sinuous.papers.hachen2025.waypoints.figures import draw
from sinuous.papers.sketch import sketch
from sinuous.papers.workers import Workers
from sinuous.recording import Recording
from sinuous.session import run as run_session
from sinuous.summary import tip_error, violates_margin

SCENES = ("winding_tube", "inverted_u")
EXACT: dict[str, tuple[str, ...]] = {
    "MPC": (),
    "DLS, printed gains": DLS_PRINTED,
    "DLS, best gains": DLS_BEST,
}
PRINTED_DISTURBANCE = (
    "plant.disturbance.length_std_mm=0.2",
    "plant.disturbance.length_max_mm=2",
    "plant.disturbance.point_std_mm=1",
    "plant.disturbance.point_max_mm=5",
    "plant.disturbance.rate_hz=5",
)
DISTURBED: dict[str, tuple[str, ...]] = {
    "MPC alone": PRINTED_DISTURBANCE,
    "MPC + local": (
        *PRINTED_DISTURBANCE,
        "control.local.enabled=true",
        "control.offset_free.when=never",
    ),
    "DLS, printed gains": (*PRINTED_DISTURBANCE, *DLS_PRINTED),
}
SEEDS, QUICK_SEEDS = 5, 1  # runs with disturbance
EXACT_STEPS, DISTURBED_STEPS, QUICK_STEPS = 300, 150, 20  # per way-point, at most

Item = tuple[str, str, bool, int, bool]


def run(workers: Workers, quick: bool) -> Data:
    """Every scene with every controller."""
    items: list[Item] = [
        (scene, name, False, 0, quick) for scene in SCENES for name in EXACT
    ]  # fmt: skip
    seeds = QUICK_SEEDS if quick else SEEDS
    items += [
        (scene, name, True, seed, quick)
        for scene in SCENES
        for name in DISTURBED
        for seed in range(seeds)
    ]
    return {"rows": workers.map("way-points in passages", drive, items)}


def drive(item: Item) -> dict[str, Any]:
    """One run from way-point to way-point."""
    scene, name, disturbed, seed, quick = item
    changes = (DISTURBED if disturbed else EXACT)[name]
    most = QUICK_STEPS if quick else DISTURBED_STEPS if disturbed else EXACT_STEPS
    short = (f"path.max_steps={most}",)
    found = scenario(scene, *changes, f"seed={seed}", *short)
    recording = run_session(found).recording
    ends = last_steps(recording)
    dt = recording.header.dt
    return {
        "scene": scene,
        "controller": name,
        "disturbed": disturbed,
        "seed": seed,
        "margin_m": recording.header.margin,
        "nominal_violations": int(np.count_nonzero(violates_margin(recording))),
        "least_nominal_clearance_m": float(np.min(recording.nominal_clearance)),
        "least_actual_clearance_m": float(np.min(recording.actual_clearance)),
        "steps_in_the_wall": int(np.count_nonzero(recording.actual_clearance < 0.0)),
        "steps": len(recording),
        "time_at_waypoints_s": (dt * (ends + 1)).tolist(),
        "nominal_error_at_waypoints_m": at(ends, recording.nominal_tip, recording),
        "actual_error_at_waypoints_m": at(ends, recording.actual_tip, recording),
        "fastest_actuator": float(
            np.max(np.abs(recording.rates) / recording.header.rate_limits[:, 1])
        ),
        "fastest_tip_m_s": float(
            np.max(np.linalg.norm(np.diff(recording.nominal_tip, axis=0), axis=1)) / dt
        ),
        "tip_speed_limit_m_s": found.mpc.tip_speed,
        "bend_at_the_end_rad": float(bend(found.robot.bend_limits.column, recording)),
        "clearance_m": None if disturbed else recording.actual_clearance.round(6).tolist(),
        "time_s": None if disturbed else recording.time.round(6).tolist(),
        "sketch": None if disturbed else sketch(recording),
    }


def last_steps(recording: Recording) -> IntArray:
    """The last step towards each way-point (W,)."""
    jumps = np.flatnonzero(np.any(np.diff(recording.target, axis=0) != 0.0, axis=1))
    return np.append(jumps, len(recording) - 1)


def at(ends: IntArray, tip: Array, recording: Recording) -> list[float]:
    """Tip errors (W,) [m] in the last second before each switch of the target."""
    width = round(1.0 / recording.header.dt)
    error = tip_error(tip, recording.target)
    starts = np.concatenate(([0], ends[:-1] + 1))
    return [
        float(np.mean(error[max(first, last + 1 - width) : last + 1]))
        for first, last in zip(starts, ends, strict=True)
    ]


def bend(columns: IntArray, recording: Recording) -> float:
    """How much the segments bend in the last shape, all together [rad]."""
    c = recording.configuration[-1]
    return float(np.sum(np.hypot(c[columns], c[columns + 1])))


WAYPOINTS = Experiment(
    name="waypoints",
    title="Convergence under shape constraints (Figs. 7, 8)",
    section="III-D",
    run=run,
    draw=draw,
)
