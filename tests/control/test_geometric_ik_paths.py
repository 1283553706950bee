"""How the geometric solution moves along paths of the tip, and what that asks of the cables."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.control.geometric_arms import IK, QIN, L, arms, in_disc

from sinuous.arrays import Array
from sinuous.control.geometric_ik import CHI, GeometricIK, IKStatus
from sinuous.control.geometric_rates import RateLimiter, path_rates
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.parts import JointOrder
from sinuous.robots.robot_file import load_jointed

DT = 0.001  # [s]
PATHS = 1000
POINTS = 60  # of a path: enough to cross all switches of k, which are a link's way apart
ROUNDING = 1e-9  # share of a limit by which rounding of lengths may exceed it

ROOT = 1e-7  # [rad]: the root of the rounding of a length, where a bend begins with a root

# [rad / sqrt(m)], see `GeometricIK`: 0.110 rad by root millimetre in the plane
IN_PLANE = 2.0 * np.sqrt(np.sin(CHI) / L) / np.cos(CHI)
ANYWHERE = 2.0 * np.sqrt(1.0 / L) / np.cos(CHI)

ALTERNATE = replace(QIN, orders=(JointOrder.ZX, JointOrder.XZ) * 2 + (JointOrder.ZX,))
both_orders = pytest.mark.parametrize("ik", [IK, GeometricIK(ALTERNATE)])


def steepest(ik: GeometricIK, first: Array, last: Array, step: float) -> float:
    """Largest change of an angle by the root of a step [rad / sqrt(m)] along a straight path."""
    way = last - first
    length = float(np.linalg.norm(way))
    points = first + way * np.arange(min(int(length / step), POINTS))[:, None] * step / length
    found = ik.solve(points)
    assert not np.any(found.status == IKStatus.UNREACHABLE)
    return float(np.abs(np.diff(found.c, axis=0)).max(initial=0.0)) / np.sqrt(step)


@both_orders
def test_a_thousand_straight_paths_move_no_joint_by_more_than_the_root_of_a_step(
    ik: GeometricIK,
) -> None:
    rng, radius = np.random.default_rng(0), IK.radius(CHI)
    ends = ik.on_plane(in_disc(rng, radius, 2 * PATHS), CHI).reshape(2, PATHS, 3)
    steps = 10.0 ** rng.uniform(-5.0, -2.0, PATHS)
    worst = [steepest(ik, *pair, step) for *pair, step in zip(*ends, steps, strict=True)]
    assert max(worst) < IN_PLANE
    assert max(worst) > 0.8 * IN_PLANE  # the constant is no guess


@both_orders
def test_the_constant_is_met_where_all_switches_meet(ik: GeometricIK) -> None:
    """At the reference point, going towards the middle, with links 1 to N-2 at rest."""
    start, end = ik.on_plane([[0.0, IK.radius(CHI)], [0.0, 0.0]], CHI)
    for step in (1e-3, 1e-5, 1e-7):
        assert steepest(ik, start, end, step) == pytest.approx(np.cos(CHI) * IN_PLANE, rel=0.01)


def test_no_constant_makes_it_linear() -> None:
    """Notes A5: the shorter the step, the larger the rate. That is what saturates cables."""
    start, end = IK.on_plane([[0.0, IK.radius(CHI)], [0.0, 0.0]], CHI)
    rates = [steepest(IK, start, end, step) / np.sqrt(step) for step in (1e-3, 1e-5, 1e-7)]
    assert rates[1] == pytest.approx(10.0 * rates[0], rel=0.02)
    assert rates[2] == pytest.approx(10.0 * rates[1], rel=0.02)


@both_orders
def test_in_depth_the_tip_moves_smoothly_too(ik: GeometricIK) -> None:
    """Assumption 3: chi and y0 change together, with the target's depth."""
    rng = np.random.default_rng(1)
    for _ in range(PATHS // 4):
        chis, step = rng.uniform(0.0, CHI, 2), 10.0 ** rng.uniform(-5.0, -2.0)
        ends = [ik.on_plane(in_disc(rng, ik.radius(chi), 1)[0], chi) for chi in chis]
        assert steepest(ik, ends[0], ends[1], step) < ANYWHERE
        deeper = ends[0] + np.array([0.0, -0.02, 0.0])
        assert ik.chi(deeper[1]) < 1.3 * CHI
        assert steepest(ik, ends[0], deeper, step) < ANYWHERE


def test_in_depth_joint_one_follows_the_plane() -> None:
    """At the reference point of every plane the pose is the reference pose of its chi."""
    chis = np.linspace(0.0, CHI, 50)
    c = np.array([IK.reference(chi) for chi in chis])
    expected = np.zeros_like(c)
    expected[:, 1], expected[:, -1] = chis, -chis
    np.testing.assert_allclose(c, expected, atol=ROOT)


# --- cables ----------------------------------------------------------------------------------


SLOW = load_jointed("qin2020", limits="hardware")  # 60 mm/s
SLOW_IK = GeometricIK(SLOW)
ACROSS = IK.on_plane([[0.05, 0.14], [-0.04, -0.12]], CHI)  # through all discs


def straight(speed: float, first: Array, last: Array) -> Array:
    """Targets every millisecond at that speed [m/s]."""
    length = float(np.linalg.norm(last - first))
    return first + (last - first) * np.arange(0.0, length, speed * DT)[:, None] / length


def test_cables_saturate_at_switches_and_nowhere_else() -> None:
    path = straight(0.1, *ACROSS)
    found = path_rates(SLOW_IK, path, DT)
    lengths = SLOW.lengths(IK.solve(path).c)
    np.testing.assert_allclose(found.rates, np.diff(lengths, axis=0) / DT, atol=1e-12)
    np.testing.assert_allclose(found.load, np.abs(found.rates).max(axis=1) / 0.06)
    np.testing.assert_array_equal(found.saturated, found.load > 1.0)
    switches = np.flatnonzero(found.switches)
    assert len(switches) >= 2
    assert np.all(found.load[switches] > 4.0)
    near = np.abs(np.arange(len(found.load))[:, None] - switches).min(axis=1) < 0.1 / DT
    assert found.load[~near].max() < 1.0
    assert np.any(near)


def test_rates_at_switches_grow_with_the_root_of_the_speed_elsewhere_with_the_speed() -> None:
    slow, fast = (path_rates(IK, straight(speed, *ACROSS), DT).load for speed in (0.05, 0.2))
    assert np.median(fast) == pytest.approx(4.0 * np.median(slow), rel=0.1)
    assert fast.max() == pytest.approx(2.0 * slow.max(), rel=0.3)


def test_a_rate_limit_is_kept_along_the_joint_path_and_the_tip_catches_up() -> None:
    path = straight(0.1, *ACROSS)
    path = np.concatenate([path, np.repeat(path[-1:], 400, axis=0)])
    goals, limiter = IK.solve(path).c, RateLimiter(robot=SLOW, dt=DT)
    c, errors, shares = goals[0], list[float](), list[float]()
    for goal, target in zip(goals, path, strict=True):
        before = SLOW.lengths(c)
        c, share = limiter.step(c, goal)
        rates = (SLOW.lengths(c) - before) / DT
        assert np.all(np.abs(rates) <= SLOW.rate_limits[:, 1] * (1.0 + ROUNDING))
        errors.append(float(np.linalg.norm(SLOW.tip(c) - target)))
        shares.append(share)
    assert min(shares) < 0.25  # it did saturate,
    assert 1e-4 < max(errors) < 5e-3  # so the tip lagged behind, though not far
    assert shares[-1] == 1.0
    assert errors[-1] < 1e-12


@settings(max_examples=60, deadline=None)
@given(robot=arms, seed=st.integers(0, 2**32 - 1), dt=st.sampled_from([1e-4, 1e-3, 1.0]))
def test_any_robot_goes_straight_and_as_far_as_it_can(
    robot: JointedRobot, seed: int, dt: float
) -> None:
    rng = np.random.default_rng(seed)
    c, goal = rng.uniform(-0.6, 0.6, (2, len(robot.home)))
    ahead, share = RateLimiter(robot=robot, dt=dt).step(c, goal)
    np.testing.assert_allclose(ahead, c + share * (goal - c), atol=1e-12)
    limits = robot.rate_limits[:, 1]
    load = np.abs(robot.lengths(ahead) - robot.lengths(c)) / dt
    assert np.all(load <= limits * (1.0 + ROUNDING) + 1e-15 / dt)
    if share == 1.0:
        np.testing.assert_array_equal(ahead, goal)
    else:
        stands = not np.all(limits > 0.0)  # a stage without a speed holds all of them
        assert share == 0.0 if stands else np.max(load / limits) > 0.998


def test_on_the_way_no_joint_is_bent_further_than_at_the_ends() -> None:
    rng, limiter = np.random.default_rng(2), RateLimiter(robot=QIN, dt=0.02)
    for _ in range(200):
        c, goal = (bounded(rng) for _ in range(2))
        ahead, _ = limiter.step(c, goal)
        assert np.all(QIN.bend_slack(ahead) >= -1e-15)


def bounded(rng: np.random.Generator) -> Array:
    """A configuration within the bend limits, on them in half of the joints."""
    c = rng.normal(size=2 * QIN.joints)
    for i in range(0, len(c), 2):
        while np.cos(c[i]) * np.cos(c[i + 1]) < np.cos(QIN.bend_limit):
            c[i : i + 2] *= 0.99
    return c


def test_bad_input_ends_in_one_sentence() -> None:
    path = IK.on_plane([[0.0, 0.1], [0.0, 0.0]], CHI)
    for dt in (0.0, -1.0, np.nan, np.inf):
        with pytest.raises(ValueError, match="positive time"):
            path_rates(IK, path, dt)
        with pytest.raises(ValueError, match="positive time"):
            RateLimiter(robot=QIN, dt=dt)
    with pytest.raises(ValueError, match="two targets or more"):
        path_rates(IK, path[:1], DT)
