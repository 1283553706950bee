"""The centre line cut into arcs: the model's shape, any other shape, and its derivative."""

import numpy as np
from hypothesis import given, settings
from scipy.integrate import solve_ivp

from sinuous.arrays import Array
from sinuous.robots.centreline import TILT, Bends, Centreline
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

from .random_robots import configurations, robots, seeds

ROUNDING = 1e-12  # [m] a few hundred products of rotations, and places within a metre
STEP = 1e-6  # [rad] or [1/m] of central differences
SLOPE = 1e-8  # what differences of STEP leave in slopes below one: STEP^2 and 1e-16 / STEP


def some_shape(line: Centreline, rng: np.random.Generator) -> Bends:
    """Bent differently in every arc, the base tilted."""
    robot = line.robot
    assert isinstance(robot, PccRobot)
    c = configurations(robot, rng, 5)[4]
    model = line.model(c)
    change = 3.0 * rng.normal(size=model.curvature.shape) * line.bends[:, None]
    return Bends(
        lengths=model.lengths, curvature=model.curvature + change, tilt=0.1 * rng.normal(size=2)
    )


@given(robots, seeds)
@settings(max_examples=40)
def test_the_model_s_shape_is_the_robot_s(robot: PccRobot, seed: int) -> None:
    line = Centreline(robot=robot)
    for c in configurations(robot, np.random.default_rng(seed), 4):
        R, p = line.frames(line.model(c))
        np.testing.assert_allclose(p, robot.points(c), rtol=0, atol=ROUNDING)
        np.testing.assert_allclose(R[-1], robot.tip_pose(c)[:3, :3], rtol=0, atol=ROUNDING)


@given(robots, seeds)
@settings(max_examples=20)
def test_derivative_by_central_differences(robot: PccRobot, seed: int) -> None:
    line = Centreline(robot=robot, coil=(0.002, -0.001, 0.01))
    rng = np.random.default_rng(seed)
    for bends in (some_shape(line, rng), line.model(robot.home)):  # the second is straight
        _, jacobian = line.points_with_jacobian(bends)
        for column in rng.integers(0, line.coordinates, 4):
            ends = [
                line.points_with_jacobian(moved(line, bends, int(column), by))[0]
                for by in (STEP, -STEP)
            ]
            expected = (ends[0] - ends[1]) / (2.0 * STEP)
            np.testing.assert_allclose(jacobian[:, :, column], expected, rtol=0, atol=SLOPE)


def moved(line: Centreline, bends: Bends, column: int, by: float) -> Bends:
    """A shape with one of its coordinates changed."""
    x = np.zeros(line.coordinates)
    x[column] = by
    curvature = bends.curvature.copy()
    curvature[line.bends] += x[TILT:].reshape(-1, 2)
    return Bends(lengths=bends.lengths, curvature=curvature, tilt=bends.tilt + x[:TILT])


def test_the_coil_is_where_it_sits_on_the_tip() -> None:
    coil = (0.002, -0.001, 0.01)
    line = Centreline(robot=load_robot("hachen2025"), coil=coil)
    bends = some_shape(line, np.random.default_rng(3))
    R, p = line.frames(bends)
    points, _ = line.points_with_jacobian(bends)
    np.testing.assert_allclose(points[:-1], p, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(points[-1], p[-1] + R[-1] @ coil, rtol=0, atol=ROUNDING)


def integrated(robot: PccRobot, curvature: Array, slope: Array) -> Array:
    """The tip (3,) of a robot whose curvature changes linearly, by an ODE solver."""

    def change(s: float, y: Array) -> Array:
        R = y[3:].reshape(3, 3)
        kx, ky = curvature + slope * s
        turn = np.array([[0, 0, kx], [0, 0, ky], [-kx, -ky, 0]])
        return np.concatenate([R[:, 2], (R @ turn).ravel()])

    length = float(np.sum(Centreline(robot=robot).section_lengths(robot.home)))
    start = np.concatenate([np.zeros(3), np.eye(3).ravel()])
    found = solve_ivp(change, (0.0, length), start, rtol=1e-12, atol=1e-14)
    return np.array(found.y[:3, -1])


def test_uneven_curvature_by_an_ode_solver_and_order_two() -> None:
    """Arcs with the curvature of their middle: the error falls with the square of their length."""
    curvature, slope = np.array([12.0, -4.0]), np.array([-90.0, 60.0])  # [1/m], [1/m^2]
    errors = list[float]()
    for spacing in (0.0045, 0.00225):  # two and four arcs between disks
        robot = load_robot("hachen2025").sampled(spacing)
        line = Centreline(robot=robot)
        lengths = line.model(robot.home).lengths
        middle = np.cumsum(lengths) - 0.5 * lengths
        bends = Bends(
            lengths=lengths, curvature=curvature + middle[:, None] * slope, tilt=np.zeros(2)
        )
        tip = line.frames(bends)[1][-1]
        errors.append(float(np.linalg.norm(tip - integrated(robot, curvature, slope))))
    assert errors[1] < 1e-5  # [m]
    assert 3.5 < errors[0] / errors[1] < 4.5


def test_a_tilt_turns_the_whole_body_about_the_base() -> None:
    """Towards x by a right angle: what stood upright lies along x."""
    robot = load_robot("hachen2025")
    line = Centreline(robot=robot)
    straight = line.model(robot.home)
    tilted = Bends(
        lengths=straight.lengths, curvature=straight.curvature, tilt=np.array([np.pi / 2, 0.0])
    )
    upright, lying = line.frames(straight)[1], line.frames(tilted)[1]
    np.testing.assert_allclose(lying, upright[:, [2, 1, 0]], rtol=0, atol=ROUNDING)
