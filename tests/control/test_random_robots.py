"""Any robot: the promise does not depend on how it is built."""

from dataclasses import replace

import numpy as np
import pytest

from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.parts import CableConvention, Insertion, Segment, SpeedLimits, Tool
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

from .loops import assert_limits_kept, drive

BODY = 0.0045  # radius of all these robots [m]
MARGIN = 0.001


def random_segment(rng: np.random.Generator, extensible: bool) -> Segment:
    """A segment with three to six cables at uneven radii."""
    cables, length = int(rng.integers(3, 7)), rng.uniform(0.02, 0.06)
    angles = np.arange(cables) * 2.0 * np.pi / cables + rng.uniform(0.0, 6.0)
    return Segment(
        length=(length, 1.8 * length if extensible else length),
        home_length=1.3 * length if extensible else length,
        disks=int(rng.integers(3, 10)),
        cable_angles=tuple(angles),
        pitch_radii=tuple(rng.uniform(0.002, 0.004, cables)),
        body_radius=BODY,
        disk_thickness=0.0005,
        max_curvature=float(rng.choice([np.inf, 50.0])),
        cable_length=(-1.0, 2.0),
    )


def random_robot(rng: np.random.Generator) -> PccRobot:
    """One to six segments on an insertion stage, straight and in front of the passage."""
    extensible = rng.random() < 0.5
    robot = PccRobot(
        name="random",
        segments=tuple(
            random_segment(rng, extensible and rng.random() < 0.8)
            for _ in range(rng.integers(1, 7))
        ),
        speed=SpeedLimits(cable=0.02, backbone=0.01, insertion=0.02),
        convention=rng.choice(np.array(CableConvention)),
        insertion=Insertion(travel=(0.0, 0.15), home=0.0, radius=BODY),
        tool=Tool(offset=(0.001, 0.0, 0.01), radius=0.002) if rng.random() < 0.4 else None,
    )
    T_w_b = np.eye(4)
    T_w_b[2, 3] = -robot.tip(robot.home)[2] - 0.01
    return robot.at(T_w_b)


@pytest.mark.parametrize("seed", range(8))
def test_random_robots_keep_margins_and_limits_in_random_tubes(seed: int) -> None:
    rng = np.random.default_rng(seed)
    robot = random_robot(rng)
    axis = shapes.wandering_path(rng, length=0.2, bend=9.0)
    mesh = shapes.bumpy_tube(rng, path=axis, radius=0.015, roughness=0.1)
    zone = SafeZone.from_mesh(mesh, entrance=axis[0], approach=0.06 - robot.T_w_b[2, 3])
    if seed % 2:
        side = rng.normal(size=3)
        obstacle = axis[20] + 0.014 * side / np.linalg.norm(side)
        zone = zone.minus(shapes.sphere(0.006, centre=obstacle), name="obstacle")
    mpc = ShapeConstrainedMPC(
        robot,
        zone,
        margin=MARGIN,
        horizon=int(rng.choice([1, 2, 5])),
        dt=float(rng.choice([1 / 30, 1 / 100])),
        tip_speed=float(rng.choice([0.05, 0.2])),
    )
    assert mpc.slack(robot.home).min() > 0.0
    targets = axis[[14, 26, 36]] + rng.normal(0.0, 0.003, (3, 3))
    _, judged = drive(mpc, mpc.init(robot.home), list(targets), steps=70)
    assert judged.worst_margin >= 0.0
    assert judged.holds == 0
    assert_limits_kept(judged)


def test_segments_keep_their_own_length_where_actuators_count_from_the_motor() -> None:
    # The limits of lengths from the base would let one segment grow while another shrinks.
    robot = load_robot("hachen2025")
    wide = tuple(replace(segment, cable_length=(0.0, 0.4)) for segment in robot.segments)
    robot = replace(robot, convention=CableConvention.MOTOR, segments=wide)
    mpc = ShapeConstrainedMPC(robot, SafeZone.unbounded())
    almost, beyond = robot.home.copy(), robot.home.copy()
    almost[5], beyond[5] = 0.0899, 0.0901  # segment 2, its actuators far from their limits
    assert np.all(robot.lengths(beyond) <= robot.length_limits[:, 1] - 0.01)
    assert not np.any(robot.coordinate_limits[:, 1] < almost)
    assert np.flatnonzero(robot.coordinate_limits[:, 1] < beyond).tolist() == [5]

    state, longest = mpc.init(robot.home), 0.0
    for _ in range(300):
        state, command = mpc.step(state, [0.03, 0.0, 0.5])
        longest = max(longest, float(state.c[2::3].max()))
    names = [active.name for active in command.report.active]
    assert "segment 2 length at its limit" in names
    assert 0.0899 < longest <= 0.09 + 1e-12
