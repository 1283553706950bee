"""Filters: unit gain, no overshoot, bounded speed, the delay they promise."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial import ConvexHull

from sinuous.arrays import Array
from sinuous.leaders.motion import REST, Follower, Rates, Smoothing, beyond_dead_zone

DT = 0.001
ROUNDING = 1e-12  # of a few thousand sums of numbers below 1 [m]

coordinates = st.floats(-0.2, 0.2)
points = st.tuples(coordinates, coordinates, coordinates).map(np.array)
jumps = st.lists(st.tuples(points, st.integers(1, 120)), min_size=1, max_size=6)
"""Targets, and how many ticks each of them stays."""


def at_rest(place: Array) -> Follower:
    return Follower(place, place)


def follow(smoothing: Smoothing, targets: list[tuple[Array, int]], dt: float = DT) -> Array:
    """The way (K, 3) from zero along targets that jump."""
    state, way = at_rest(np.zeros(3)), [np.zeros(3)]
    for target, ticks in targets:
        for _ in range(ticks):
            state = smoothing.step(state, target, dt)
            way.append(state.second)
    return np.array(way)


@given(points, st.floats(0.005, 0.2))
def test_a_target_that_stays_is_reached(target: Array, delay: float) -> None:
    smoothing = Smoothing(delay=delay, speed=1.0)
    seconds = 0.4 + 20.0 * delay  # the way at full speed, and forty time constants
    way = follow(smoothing, [(target, round(seconds / DT))])
    np.testing.assert_allclose(way[-1], target, atol=ROUNDING)


@given(jumps, st.floats(0.01, 2.0))
def test_the_hull_of_the_targets_is_never_left(
    targets: list[tuple[Array, int]], speed: float
) -> None:
    way = follow(Smoothing(speed=speed), targets)
    corners = np.array([np.zeros(3), *[target for target, _ in targets]])
    # Of every direction, the way goes no further than the furthest target.
    rng = np.random.default_rng(0)
    directions = np.concatenate([np.eye(3), -np.eye(3), rng.normal(size=(40, 3))])
    furthest = np.maximum.accumulate(corners @ directions.T, axis=0)[-1]
    assert np.all(way @ directions.T <= furthest + ROUNDING)


def test_the_hull_is_that_of_the_targets_so_far() -> None:
    rng = np.random.default_rng(4)
    corners = rng.uniform(-0.1, 0.1, size=(6, 3))
    way = follow(Smoothing(), [(corner, 30) for corner in corners])
    hull = ConvexHull(np.array([np.zeros(3), *corners]))
    normals, offsets = hull.equations[:, :3], hull.equations[:, 3]
    assert np.max(way @ normals.T + offsets) <= ROUNDING


@given(jumps, st.floats(0.01, 2.0), st.lists(st.floats(1e-4, 0.03), min_size=1, max_size=5))
def test_the_speed_is_bounded_however_late_the_ticks(
    targets: list[tuple[Array, int]], speed: float, ticks: list[float]
) -> None:
    smoothing, state = Smoothing(speed=speed), at_rest(np.zeros(3))
    for target, count in targets:
        for k in range(count):
            dt, before = ticks[k % len(ticks)], state.second
            state = smoothing.step(state, target, dt)
            assert np.linalg.norm(state.second - before) <= speed * dt * (1.0 + 1e-9)


@pytest.mark.parametrize("delay", [0.02, 0.04, 0.1])
def test_a_steady_target_is_followed_a_delay_later(delay: float) -> None:
    velocity, state = np.array([0.03, -0.02, 0.01]), at_rest(np.zeros(3))
    smoothing, ticks = Smoothing(delay=delay), 2000
    for k in range(ticks):
        state = smoothing.step(state, velocity * k * DT, DT)
    behind = velocity * (ticks - 1) * DT - state.second
    # The target of a tick is where it was when the tick began: one tick less than in the limit.
    assert behind @ velocity / (velocity @ velocity) == pytest.approx(delay, abs=DT)


def test_a_jump_of_the_target_is_no_jump_of_the_speed() -> None:
    smoothing = Smoothing(delay=0.04, speed=10.0)
    way = follow(smoothing, [(np.array([0.01, 0.0, 0.0]), 200)])[:, 0]
    speeds = np.diff(way, prepend=0.0) / DT
    accelerations = np.diff(speeds, prepend=0.0) / DT
    # Of x'' = (g - 2 tau x' - x) / tau^2 the largest is g / tau^2, at the jump.
    assert np.max(np.abs(accelerations)) <= 0.01 / 0.02**2
    assert np.all(speeds >= 0.0)


def test_halving_the_ticks_halves_the_error() -> None:
    """Against the closed form of the step, x = g (1 - (1 + t/tau) exp(-t/tau))."""
    smoothing, goal, tau = Smoothing(delay=0.04, speed=10.0), 0.01, 0.02
    errors = list[float]()
    for dt in (0.001, 0.0005, 0.00025):
        way = follow(smoothing, [(np.array([goal, 0.0, 0.0]), round(0.1 / dt))], dt)[:, 0]
        t = dt * np.arange(len(way))
        errors.append(np.max(np.abs(way - goal * (1.0 - (1.0 + t / tau) * np.exp(-t / tau)))))
    assert errors[0] / errors[1] == pytest.approx(2.0, rel=0.1)
    assert errors[1] / errors[2] == pytest.approx(2.0, rel=0.1)


deflections = st.tuples(*[st.floats(-1.0, 1.0)] * 3).map(np.array)


@given(st.lists(st.tuples(deflections, st.integers(1, 80)), min_size=1, max_size=6))
def test_rates_are_bounded_and_start_and_stop_by_ramps(
    told: list[tuple[Array, int]],
) -> None:
    rates, motion = Rates(speed=0.03, acceleration=0.3), REST
    for deflection, ticks in told:
        for _ in range(ticks):
            before = motion
            motion = rates.step(motion, deflection, DT)
            assert np.linalg.norm(motion.velocity) <= 0.03 + ROUNDING
            change = np.linalg.norm(motion.velocity - before.velocity)
            assert change <= 0.3 * DT + ROUNDING
            way = motion.place - before.place
            np.testing.assert_allclose(
                way, 0.5 * DT * (before.velocity + motion.velocity), atol=ROUNDING
            )


def test_full_deflection_is_full_speed_and_letting_go_stops_after_the_ramp() -> None:
    rates, motion = Rates(speed=0.03, acceleration=0.3), REST
    for _ in range(500):
        motion = rates.step(motion, np.array([0.0, 1.0, 0.0]), DT)
    np.testing.assert_allclose(motion.velocity, [0.0, 0.03, 0.0], atol=ROUNDING)
    let_go = motion.place
    for _ in range(200):
        motion = rates.step(motion, np.zeros(3), DT)
    np.testing.assert_array_equal(motion.velocity, np.zeros(3))
    braking = 0.03**2 / (2.0 * 0.3)  # v^2 / 2a
    np.testing.assert_allclose(motion.place - let_go, [0.0, braking, 0.0], atol=ROUNDING)


def test_a_diagonal_is_no_faster_than_an_axis() -> None:
    rates, motion = Rates(speed=0.03), REST
    for _ in range(500):
        motion = rates.step(motion, np.ones(3), DT)
    assert np.linalg.norm(motion.velocity) == pytest.approx(0.03)


@given(deflections, st.floats(0.0, 0.5))
def test_a_dead_zone_keeps_the_direction_and_reaches_one(stick: Array, zone: float) -> None:
    length, out = np.linalg.norm(stick), beyond_dead_zone(stick, zone)
    if length <= zone:
        np.testing.assert_array_equal(out, np.zeros(3))
        return
    assert np.linalg.norm(out) == pytest.approx((min(length, 1.0) - zone) / (1.0 - zone), abs=1e-12)
    np.testing.assert_allclose(np.cross(out, stick), np.zeros(3), atol=ROUNDING)
    assert out @ stick >= 0.0


@pytest.mark.parametrize(
    "build",
    [
        lambda: Smoothing(delay=0.0),
        lambda: Smoothing(speed=float("inf")),
        lambda: Rates(speed=-0.1),
        lambda: Rates(acceleration=float("nan")),
    ],
)
def test_numbers_that_make_no_sense_are_refused(build: object) -> None:
    assert callable(build)
    with pytest.raises(ValueError, match="must be positive and finite"):
        build()
