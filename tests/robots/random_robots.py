"""Robots and configurations of every kind that the package allows, for property tests."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.robots.parts import CableConvention, Insertion, Segment, SpeedLimits, Tool
from sinuous.robots.pcc import PccRobot

# Least ratio of the singular values of a segment's cable offsets. Files allow 1e-3; with more,
# rounding is amplified little and tolerances can be tight.
SPREAD = 0.1


def random_pose(rng: np.random.Generator) -> Array:
    T = np.eye(4)
    T[:3, :3] = Rotation.random(rng=rng).as_matrix()
    T[:3, 3] = rng.uniform(-0.3, 0.3, 3)
    return T


def random_segment(rng: np.random.Generator, cables: int, extensible: bool) -> Segment:
    """A segment with cables at any angles and radii."""
    spread, angles, radii = 0.0, np.zeros(0), np.zeros(0)
    while spread < SPREAD:
        angles, radii = rng.uniform(-np.pi, np.pi, cables), rng.uniform(2e-3, 8e-3, cables)
        values = np.linalg.svd(radii * [np.cos(angles), np.sin(angles)], compute_uv=False)
        spread = values[1] / values[0]
    shortest, disks = rng.uniform(0.03, 0.1), int(rng.integers(1, 12))
    longest = shortest * rng.uniform(1.2, 2.5) if extensible else shortest
    return Segment(
        length=(shortest, longest),
        home_length=rng.uniform(shortest, longest),
        disks=disks,
        cable_angles=tuple(angles),
        pitch_radii=tuple(radii),
        body_radius=float(np.max(radii) + rng.uniform(0.5e-3, 3e-3)),
        disk_thickness=rng.uniform(0.1, 0.6) * shortest / disks,
        max_curvature=float(rng.choice([np.inf, 1.0 / rng.uniform(0.02, 0.06)])),
        cable_length=(0.0, 1.0),
    )


def random_robot(
    *,
    seed: int,
    segments: list[tuple[int, bool]],
    convention: CableConvention,
    insertion: bool,
    tool: bool,
) -> PccRobot:
    """A robot with (number of cables, extensible) for every segment."""
    rng = np.random.default_rng(seed)
    x, y, z = rng.uniform(-0.02, 0.02, 3)
    return PccRobot(
        name="random",
        segments=tuple(random_segment(rng, *kind) for kind in segments),
        speed=SpeedLimits(cable=0.02, backbone=0.01, insertion=0.03),
        convention=convention,
        insertion=Insertion(travel=(0.0, 0.2), home=0.05, radius=0.004) if insertion else None,
        tool=Tool(offset=(x, y, z), radius=0.003) if tool else None,
        T_w_b=random_pose(rng),
    )


def configurations(robot: PccRobot, rng: np.random.Generator, count: int) -> Array:
    """Configurations (count, n) within the limits of length and bend, up to a full turn.

    In every third one all segments are nearly straight, by 1e-9 to 1e-3 rad; one is straight.
    """
    c, column = np.empty((count, len(robot.home))), 0
    share = np.sqrt(rng.uniform(size=(count, len(robot.segments))))
    if robot.insertion:
        c[:, 0] = rng.uniform(*robot.insertion.travel, count)
        column = 1
    for j, segment in enumerate(robot.segments):
        gamma = rng.uniform(*segment.length, count) if segment.extensible else segment.home_length
        slope, offset = segment.bend_planes.T
        largest = np.min(slope * np.reshape(gamma, (-1, 1)) + offset, axis=1)
        bend = share[:, j] * np.minimum(largest, 2 * np.pi)
        bend[::3] = 10.0 ** rng.uniform(-9.0, -3.0, len(bend[::3]))
        bend[0] = 0.0
        angle = rng.uniform(-np.pi, np.pi, count)
        c[:, column], c[:, column + 1] = bend * np.cos(angle), bend * np.sin(angle)
        if segment.extensible:
            c[:, column + 2] = gamma
        column += 3 if segment.extensible else 2
    return c


def twin(robot: PccRobot, convention: CableConvention) -> PccRobot:
    """The same robot with its cables counted in the other way."""
    return replace(robot, convention=convention)


robots = st.builds(
    random_robot,
    seed=st.integers(0, 2**32 - 1),
    segments=st.lists(st.tuples(st.integers(3, 6), st.booleans()), min_size=1, max_size=6),
    convention=st.sampled_from(CableConvention),
    insertion=st.booleans(),
    tool=st.booleans(),
)
seeds = st.integers(0, 2**32 - 1)
