"""Second derivatives of the body: against differences of the Jacobian, and of sampled ways."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from sinuous.arrays import Array
from sinuous.robots import arc_series, chain_kernels, chain_second
from sinuous.robots.chain_robot import ChainRobot
from sinuous.robots.robot_file import load_jointed, load_robot

from .random_jointed import any_configurations, any_robots, jointed_configurations
from .random_robots import configurations, seeds
from .test_pcc import PRESETS, ROUNDING, SERIES

CURVATURE = 1e-8  # relative; differences of the Jacobian by Richardson reach 1e-9
STEP = 1e-3  # [rad or m] of those differences: errors STEP^4 / 5! and 1e-16 / STEP relative
SAMPLES = 64  # pieces of a straight way, a power of two
TIGHT = 5.0  # the bound against the largest acceleration found, in the middle of many ways
TIGHT_JOINTED = 7.0  # the two turns of a joint are added, though they are about different axes


def derivative(robot: ChainRobot, c: Array, forces: Array) -> Array:
    """Derivative of sum_s J_s' f_s by central differences of two steps, extrapolated."""

    def pull(c: Array) -> Array:
        return np.einsum("...sin,si->...n", robot.points_jacobian(c), forces)

    steps = STEP * np.eye(len(c))
    wide = (pull(c + steps) - pull(c - steps)) / (2 * STEP)
    half = (pull(c + steps / 2) - pull(c - steps / 2)) / STEP
    return ((4 * half - wide) / 3).T


def bound(robot: ChainRobot, c: Array, delta: Array) -> Array:
    """`acceleration_bound`, with an array that is not clean."""
    out = np.full(len(robot.radii), np.nan)
    chain_second.acceleration_bound(robot.chain, c, delta, out)
    return out


# --- curvature ------------------------------------------------------------------------------


@given(robot=any_robots, seed=seeds)
@settings(max_examples=60)
def test_curvature_is_the_derivative_of_the_force(robot: ChainRobot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    forces = rng.normal(size=(len(robot.radii), 3)) * rng.integers(0, 2, (len(robot.radii), 1))
    forces[-1] = rng.normal(size=3)
    for c in any_configurations(robot, rng, 4):
        value = robot.points_curvature(c, forces)
        np.testing.assert_array_equal(value, value.T)
        expected = derivative(robot, c, forces)
        assert np.max(np.abs(value - expected)) < CURVATURE * np.max(np.abs(expected))


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("bend", [0.0, 1e-12, 1e-8, 1e-5, 1e-4, 1e-3, 3.16, 3.17, 7.0])
def test_curvature_is_smooth_at_the_straight_shape_and_past_a_turn(name: str, bend: float) -> None:
    """Also where the series of the coefficients ends, at an angle of sqrt(10)."""
    robot, rng = load_robot(name), np.random.default_rng(2)
    c = robot.home.copy()
    for column, what in enumerate(robot.coordinate_names):
        c[column] += bend * {"theta_x": 0.6, "theta_y": -0.8}.get(what.split()[-1], 0.0)
    forces = rng.normal(size=(len(robot.radii), 3))
    expected = derivative(robot, c, forces)
    error = np.max(np.abs(robot.points_curvature(c, forces) - expected))
    assert error < CURVATURE * np.max(np.abs(expected))


@given(robot=any_robots, seed=seeds)
@settings(max_examples=30)
def test_curvature_of_listed_points(robot: ChainRobot, seed: int) -> None:
    """Points may repeat, entries beyond the count are not read, and nothing is left over."""
    rng = np.random.default_rng(seed)
    c, n = any_configurations(robot, rng, 4)[-1], len(robot.home)
    M, S = robot.chain.theta_column.size, len(robot.radii)
    R, p, ends = np.empty((M + 1, 3, 3)), np.empty((M + 1, 3)), np.empty((M, 3, 3))
    spins, scratch = np.empty((M, 3, 2)), np.full(chain_second.scratch_size(M, n), np.nan)
    chain_kernels.chain_derivative(robot.chain, robot.T_w_b, c, R, p, ends, spins)
    numbers = np.append(rng.integers(0, S, 6), [S - 1, S - 1, -1])
    listed, out = rng.normal(size=(9, 3)), np.full((n, n), np.nan)
    listed[-1] = np.nan
    chain_second.curvature(robot.chain, c, R, p, ends, spins, numbers, listed, 8, scratch, out)
    forces = np.zeros((S, 3))
    np.add.at(forces, numbers[:8], listed[:8])
    expected = robot.points_curvature(c, forces)
    size = np.max(np.abs(robot.points_curvature(c, np.ones((S, 3)))))
    np.testing.assert_allclose(out, expected, rtol=0, atol=ROUNDING * max(size, 1.0))
    chain_second.curvature(robot.chain, c, R, p, ends, spins, numbers, listed, 0, scratch, out)
    assert np.all(out == 0.0)


def test_curvature_is_linear_in_the_forces() -> None:
    robot, rng = load_robot("hachen2025"), np.random.default_rng(3)
    c = configurations(robot, rng, 2)[-1]
    f, g = rng.normal(size=(2, len(robot.radii), 3))
    together = robot.points_curvature(c, f + 2.0 * g)
    apart = robot.points_curvature(c, f) + 2.0 * robot.points_curvature(c, g)
    np.testing.assert_allclose(together, apart, rtol=0, atol=ROUNDING * np.max(np.abs(together)))
    assert np.all(robot.points_curvature(c, 0.0 * f) == 0.0)


@pytest.mark.parametrize("w", [0.0, 1e-6, 0.3, 2.0, 9.9, 10.1, 25.0, 60.0])
def test_second_coefficients_are_derivatives(w: float) -> None:
    """Against the differential equations of sin a / a and (1 - cos a) / a^2, by w = a^2."""
    s, c, s1, c1, s2, c2 = arc_series.second_coefficients(w)
    a = np.sqrt(w)
    assert abs(1.0 - w * c - np.cos(a)) < 10 * SERIES
    assert abs(2.0 * w * s1 + s - np.cos(a)) < 10 * SERIES * max(w, 1.0)
    assert abs(2.0 * w * c1 + 2.0 * c - s) < 10 * SERIES * max(w, 1.0)
    # a S and a^2 C - 1 have the second derivatives -a S and 1 - a^2 C by a.
    assert abs(4.0 * w * s2 + 6.0 * s1 + s) < 10 * SERIES * max(w, 1.0)
    assert abs(4.0 * w * w * c2 + 10.0 * w * c1 + 2.0 * c + w * c - 1.0) < 10 * SERIES * max(
        w * w, 1.0
    )


# --- points and ways ------------------------------------------------------------------------


@given(robot=any_robots, seed=seeds)
@settings(max_examples=100)
def test_points_stray_from_chords_by_no_more_than_the_bound(robot: ChainRobot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    a, b = any_configurations(robot, rng, 6)[rng.choice(6, 2, replace=False)]
    allowed = bound(robot, a, b - a)
    t = np.linspace(0.0, 1.0, SAMPLES + 1)
    points = robot.points(a + t[:, None] * (b - a))
    for length in 2 ** np.arange(1, 7):
        first, last = points[:-length:length], points[length::length]
        for k in range(1, length):
            chord = first + k / length * (last - first)
            strayed = np.linalg.norm(points[k:SAMPLES:length] - chord, axis=2)
            assert np.all(strayed <= allowed * (length / SAMPLES) ** 2 / 8 + ROUNDING)


@given(robot=any_robots, seed=seeds)
@settings(max_examples=30)
def test_what_does_not_turn_does_not_stray(robot: ChainRobot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    c = any_configurations(robot, rng, 4)[-1]
    assert np.all(bound(robot, c, np.zeros(len(c))) == 0.0)
    lengths = rng.normal(size=len(c))
    for column in robot.chain.theta_column[robot.chain.theta_column >= 0]:
        lengths[column : column + 2] = 0.0
    assert np.all(bound(robot, c, lengths) == 0.0)
    first = np.min(robot.chain.theta_column[robot.chain.theta_column >= 0])
    lengths[first] = 0.1
    passed = robot.chain.section < np.argmax(robot.chain.theta_column == first)
    assert np.all(bound(robot, c, lengths)[passed] == 0.0)


@pytest.mark.parametrize("name", [*PRESETS, "qin2020"])
@pytest.mark.parametrize("share", [1.0, 0.1])
def test_bound_is_near_the_largest_acceleration(name: str, share: float) -> None:
    robot, rng = load_robot(name), np.random.default_rng(5)
    t, ratios = np.linspace(0.0, 1.0, SAMPLES + 1), list[float]()
    for a, b in any_configurations(robot, rng, 80).reshape(40, 2, -1):
        points = robot.points(a + t[:, None] * share * (b - a))[:, -1]
        found = np.linalg.norm(np.diff(points, 2, axis=0), axis=1) * SAMPLES**2
        ratios.append(bound(robot, a, share * (b - a))[-1] / np.max(found))
    assert np.min(ratios) >= 1.0
    assert np.median(ratios) < (TIGHT_JOINTED if name == "qin2020" else TIGHT)


def test_bound_is_reached_by_a_body_that_swings_as_a_whole() -> None:
    """A short segment that bends swings the straight, long ones beyond it about the base."""
    robot = load_robot("hachen2025")
    short = replace(robot.segments[0], length=(1e-4, 1e-4), home_length=1e-4)
    robot = replace(robot, segments=(short, *robot.segments[1:]))
    delta = np.zeros(len(robot.home))
    delta[0] = 1.0
    beyond = sum(s.home_length for s in robot.segments[1:])
    assert bound(robot, robot.home, delta)[-1] == pytest.approx(beyond, abs=1e-4)


@pytest.mark.parametrize("share", [0.01, 0.5, 1.0])
def test_curvature_of_a_jointed_robot_far_from_straight(share: float) -> None:
    """A second look at hinges, whose forces act on every point, from straight to the limit."""
    robot, rng = load_jointed("qin2020"), np.random.default_rng(6)
    forces = rng.normal(size=(len(robot.radii), 3))
    for c in share * jointed_configurations(robot, rng, 10):
        expected = derivative(robot, c, forces)
        error = np.max(np.abs(robot.points_curvature(c, forces) - expected))
        assert error < CURVATURE * np.max(np.abs(expected))


def test_bound_is_reached_by_a_joint_that_swings_the_straight_robot() -> None:
    robot = load_jointed("qin2020")
    delta = np.zeros(10)
    delta[0] = 0.4
    reach = 0.650 - 0.012
    assert bound(robot, robot.home, delta)[-1] == pytest.approx(reach * 0.4**2, rel=1e-12)
