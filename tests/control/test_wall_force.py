"""What walls hold back, against closed forms, against differences of the cost, on both robots."""

from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.control.metric import actuator_metric
from sinuous.control.mpc import RESERVE, MPCState, ShapeConstrainedMPC
from sinuous.control.report import Report
from sinuous.control.wall_force import Walls, at_tip, closeness
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot
from sinuous.scenario import load_scenario

SCENARIOS = Path(__file__).parents[2] / "examples" / "scenarios"

AT_REST = 2e-5  # what a way may be off the tip's error at rest [m]: the plan creeps by less a step
SLOPE = 2e-2  # relative; differences of the cost over 0.4 mm of margin, around a curved optimum
DAMPED = 1e-3  # relative; by the damping of the tip's mapping, 1e-5 by squared gains of some 0.1

MARGIN, HALF = 0.003, 0.12
TOP = 0.16  # of a room with flat walls [m]


@cache
def room() -> ShapeConstrainedMPC:
    """The robot of paper B, its base on the floor of a box 240 mm wide."""
    box = shapes.box((2 * HALF, 2 * HALF, TOP), centre=(0.0, 0.0, 0.5 * TOP))
    zone = SafeZone.from_mesh(box, entrance=[0.0, 0.0, 0.0])
    T_w_b = np.eye(4)
    T_w_b[2, 3] = -0.04
    return ShapeConstrainedMPC(
        load_robot("hachen2025").at(T_w_b), zone, margin=MARGIN, dt=0.02, horizon=5
    )


@cache
def vessel(margin: float = 0.008) -> ShapeConstrainedMPC:
    """The robot of rigid modules in its vessel with the beam."""
    return replace(load_scenario(SCENARIOS / "live_jointed.toml").mpc, margin=margin, dt=0.02)


def settle(
    mpc: ShapeConstrainedMPC, state: MPCState, target: Array, steps: int
) -> tuple[MPCState, Report]:
    """Where a target leads to."""
    for _ in range(steps - 1):
        state, _ = mpc.step(state, target)
    state, command = mpc.step(state, target)
    return state, command.report


def walls_of(report: Report) -> Walls:
    assert report.walls is not None
    return report.walls


@cache
def at_the_wall() -> MPCState:
    """The robot's tip beside a flat wall."""
    mpc = room()
    start = np.array([0.0, 0.0, 0.045] * 3)
    return settle(mpc, mpc.init(start), np.array([0.085, 0.0, 0.08]), 150)[0]


@cache
def elbow(margin: float = 0.008) -> tuple[MPCState, Report, Array]:
    """The forearm leans on the beam; the tip is 0.1 m from everything."""
    mpc, scene = vessel(margin), load_scenario(SCENARIOS / "live_jointed.toml")
    state, _ = settle(mpc, mpc.init(scene.first_configuration), np.array([0.0, 0.56, 0.13]), 60)
    target = np.array([0.0, 0.56, 0.20])
    state, report = settle(mpc, state, target, 150)
    return state, report, target


def flat_wall_stop(mpc: ShapeConstrainedMPC) -> float:
    """Where the tip stops [m] on its way to the wall at x = HALF."""
    return HALF - float(mpc.robot.required_distance(mpc.margin)[-1]) - RESERVE


@settings(max_examples=8, deadline=None)
@given(depth=st.floats(0.5e-3, 0.03))
def test_at_a_flat_wall_the_way_is_the_depth_along_the_normal(depth: float) -> None:
    mpc = room()
    stop = flat_wall_stop(mpc)
    _, report = settle(mpc, at_the_wall(), np.array([stop + depth, 0.0, 0.08]), 60)
    np.testing.assert_allclose(walls_of(report).way, [-depth, 0.0, 0.0], atol=AT_REST)
    np.testing.assert_allclose(walls_of(report).body, [-depth, 0.0, 0.0], atol=AT_REST)
    assert walls_of(report).pushed == len(mpc.robot.radii) - 1


def test_pushed_further_all_the_time_the_way_only_grows() -> None:
    mpc, state = room(), at_the_wall()
    stop, sizes = flat_wall_stop(mpc), list[float]()
    state, _ = settle(mpc, state, np.array([stop, 0.0, 0.08]), 60)
    for depth in np.linspace(0.0, 0.03, 151):  # 10 mm/s
        state, command = mpc.step(state, np.array([stop + depth, 0.0, 0.08]))
        sizes.append(float(np.linalg.norm(walls_of(command.report).way)))
        assert command.report.clearance >= MARGIN - 1e-9
    assert np.all(np.diff(sizes) > 0.0)
    assert sizes[-1] == pytest.approx(0.03, abs=1e-3)


def test_in_free_motion_there_is_none_however_far_the_tip_is_behind() -> None:
    mpc = replace(room(), tip_speed=0.05)
    state = mpc.init(np.array([0.0, 0.0, 0.045] * 3))
    for _ in range(40):
        state, command = mpc.step(state, np.array([0.08, 0.0, 0.09]))
        behind = np.linalg.norm(command.report.points[-1] - [0.08, 0.0, 0.09])
        assert behind > 0.02
        assert not np.any(walls_of(command.report).way)
        assert not np.any(walls_of(command.report).body)


def test_the_elbow_leans_and_the_tip_is_held() -> None:
    mpc = vessel()
    _, report, target = elbow()
    walls = walls_of(report)
    room_at_tip = mpc.zone.clearance(report.points[-1:]) - mpc.robot.radii[-1]
    assert room_at_tip[0] > 0.05
    assert np.linalg.norm(walls.way) > 0.005
    np.testing.assert_allclose(walls.way, report.points[-1] - target, atol=AT_REST)
    normal = mpc.zone.nearest(report.points).gradient[walls.pushed]
    assert "module 4" in mpc.robot.point_name(walls.pushed)
    assert walls.body @ normal == pytest.approx(float(np.linalg.norm(walls.body)), rel=1e-3)


def cost(mpc: ShapeConstrainedMPC, c: Array, target: Array) -> float:
    """Of a stage at rest: that of the tip, for the posture's is a hundred thousandth of it."""
    return 1e5 * float(np.sum((mpc.robot.tip(c) - target) ** 2))


def test_multipliers_are_what_a_wall_costs_the_elbow() -> None:
    """By the envelope theorem, the cost grows by the sum of all multipliers with the margin."""
    h = 2e-4
    target = elbow()[2]
    less, more = (cost(vessel(m), elbow(m)[0].c, target) for m in (0.008 - h, 0.008 + h))
    push = walls_of(elbow()[1]).push
    multipliers = 2e5 * float(np.sum(np.linalg.norm(push, axis=1)))
    assert (more - less) / (2.0 * h) == pytest.approx(multipliers, rel=SLOPE)


def test_multipliers_are_what_a_flat_wall_costs_the_tip() -> None:
    h, target = 2e-4, np.array([HALF, 0.0, 0.08])
    costs = list[float]()
    for margin in (MARGIN - h, MARGIN + h):
        mpc = replace(room(), margin=margin)
        costs.append(cost(mpc, settle(mpc, at_the_wall(), target, 60)[0].c, target))
    push = walls_of(settle(room(), at_the_wall(), target, 60)[1]).push
    multipliers = 2e5 * float(np.sum(np.linalg.norm(push, axis=1)))
    assert (costs[1] - costs[0]) / (2.0 * h) == pytest.approx(multipliers, rel=SLOPE)


ANGLE = st.floats(-0.4, 0.4)


def both(bends: tuple[float, ...]) -> tuple[tuple[Robot, Array], ...]:
    """Both robots, bent."""
    pcc, jointed = room().robot, vessel().robot
    c = np.array([0.3, 0.0, 0.045, 0.0, 0.2, 0.045, -0.2, 0.1, 0.045])
    c[[0, 1, 3, 4, 6, 7]] += bends[:6]
    return (pcc, c), (jointed, jointed.home + 0.3 + np.resize(bends, len(jointed.home)))


@settings(max_examples=20, deadline=None)
@given(bends=st.tuples(*[ANGLE] * 6), force=st.tuples(*[st.floats(-1.0, 1.0)] * 3))
def test_a_force_at_the_tip_is_itself(bends: tuple[float, ...], force: tuple[float, ...]) -> None:
    for robot, c in both(bends):
        f = np.array([force])
        last = np.array([len(robot.radii) - 1])
        J = robot.points_jacobian(c)[-1] @ np.linalg.inv(actuator_metric(robot))
        weakest = float(np.linalg.svd(J)[1][-1])
        tolerance = 2e-5 / weakest**2  # what the damping takes away in the weakest direction
        assert np.linalg.norm(at_tip(robot, c, last, f) - f[0]) <= tolerance * 2.0


@settings(max_examples=20, deadline=None)
@given(
    bends=st.tuples(*[ANGLE] * 6),
    force=st.tuples(*[st.floats(-1.0, 1.0)] * 3),
    share=st.floats(0.3, 1.0),
)
def test_it_does_the_same_work_in_the_least_motion_of_the_tip(
    bends: tuple[float, ...], force: tuple[float, ...], share: float
) -> None:
    """F . v is the power of the forces on the body while the actuators move the least for v."""
    for robot, c in both(bends):
        point = np.array([int(share * (len(robot.radii) - 1))])
        F = at_tip(robot, c, point, np.array([force]))
        J = robot.points_jacobian(c)
        by_y = np.linalg.inv(actuator_metric(robot))
        tip = J[-1] @ by_y
        for v in np.eye(3):
            moved = tip.T @ np.linalg.solve(tip @ tip.T + 1e-5 * np.eye(3), v)
            power = np.array(force) @ J[point[0]] @ by_y @ moved
            assert F @ v == pytest.approx(power, abs=1e-9)


def test_a_straight_robot_of_modules_feels_nothing_along_its_axis() -> None:
    robot = vessel().robot
    straight = robot.points(robot.home)
    axis = straight[-1] - straight[0]
    axis /= np.linalg.norm(axis)
    last = len(robot.radii) - 1
    np.testing.assert_allclose(np.cross(straight - straight[0], axis), 0.0, atol=1e-12)
    force = at_tip(robot, robot.home, np.array([last]), axis[None])
    assert np.linalg.norm(force) < 1e-9
    side = np.cross(axis, [1.0, 0.3, 0.2])
    side /= np.linalg.norm(side)
    force = at_tip(robot, robot.home, np.array([last]), side[None])
    np.testing.assert_allclose(force, side, atol=DAMPED)


def test_walls_hold_no_more_than_is_pulled() -> None:
    robot = room().robot
    c = np.array([0.3, 0.1, 0.05] * 3)
    last = np.array([len(robot.radii) - 1])
    goal = robot.tip(c) + [0.01, 0.0, 0.0]
    walls = Walls(robot=robot, c=c, point=last, push=np.array([[-0.5, 0.2, 0.0]]), goal=goal)
    assert np.linalg.norm(walls.way) == pytest.approx(0.01)
    np.testing.assert_allclose(walls.body, walls.way, atol=1e-5)


def test_without_walls_there_is_nothing() -> None:
    robot = room().robot
    nothing = np.zeros(0, dtype=np.int64)
    c = robot.home
    walls = Walls(robot=robot, c=c, point=nothing, push=np.zeros((0, 3)), goal=robot.tip(c))
    assert walls.pushed == 0
    assert not np.any(walls.way)
    assert not np.any(walls.body)


def test_closeness_begins_at_its_reach_and_is_the_reach_at_the_margin() -> None:
    mpc, c = room(), at_the_wall().c
    distance = mpc.robot.required_distance(mpc.margin)
    room_left = float(np.min(mpc.slack(c)))
    assert not np.any(closeness(mpc.robot, mpc.zone, c, distance, 0.9 * room_left))
    reach = room_left + 0.004
    way = closeness(mpc.robot, mpc.zone, c, distance, reach)
    closest = int(np.argmin(mpc.slack(c)))
    normal = mpc.zone.nearest(mpc.robot.points(c)).gradient[closest]
    expected = at_tip(mpc.robot, c, np.array([closest]), 0.004 * normal[None])
    np.testing.assert_allclose(way, expected, atol=1e-12)
