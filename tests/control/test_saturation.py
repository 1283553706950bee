"""What limits leave of rates that no constraint was thought of for."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.control.saturation import attainable, speed_share
from sinuous.robots.robot_file import load_robot

ROBOTS = {name: load_robot(name) for name in ("hachen2025", "opencr_v4")}
DT = 1 / 30
ROUNDING = 1e-12  # [m] or [m/s], of sums of a dozen lengths below 1 m
# Length limits and the coupling rules are met in turn, three times: what is left of a violation.
LEFT = 2e-5  # [m]


@pytest.mark.parametrize("name", ROBOTS)
@given(seed=st.integers(0, 2**32 - 1), pace=st.floats(1e-3, 30.0))
def test_limits_hold_whatever_is_asked_for(name: str, seed: int, pace: float) -> None:
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    lengths = robot.lengths(robot.home)
    low, high = robot.length_limits.T
    slowest, fastest = robot.rate_limits.T
    for _ in range(40):  # always on, so that stops are reached
        asked = pace * fastest * rng.uniform(-1.0, 1.0, len(lengths))
        rates = attainable(robot, lengths, asked, DT)
        assert np.all(rates <= fastest + ROUNDING)
        assert np.all(rates >= slowest - ROUNDING)
        lengths = lengths + DT * rates
        c = robot.configuration(lengths)
        np.testing.assert_allclose(robot.lengths(c), lengths, rtol=0, atol=ROUNDING)  # (19)
        assert np.all(lengths >= low - LEFT)
        assert np.all(lengths <= high + LEFT)
        assert np.min(robot.bend_slack(c)) >= -LEFT


def test_what_is_possible_is_not_changed() -> None:
    robot, rng = ROBOTS["hachen2025"], np.random.default_rng(1)
    c = robot.home + 0.1 * rng.normal(size=9) * np.tile([1.0, 1.0, 0.01], 3)
    rates = robot.lengths_jacobian(c) @ (rng.normal(size=9) * np.tile([0.3, 0.3, 0.002], 3))
    assert speed_share(robot, rates) == 1.0
    got = attainable(robot, robot.lengths(c), rates, DT)
    np.testing.assert_allclose(got, rates, rtol=0, atol=1e-11)  # lengths by the time of a step


def test_a_segment_at_its_stop_does_not_hold_the_others() -> None:
    robot = ROBOTS["hachen2025"]
    c = robot.home.copy()
    c[2] = 0.090  # the first backbone is as long as it gets
    ask = np.zeros(9)
    ask[2] = ask[8] = 0.005
    rates = attainable(robot, robot.lengths(c), robot.lengths_jacobian(c) @ ask, DT)
    moved = robot.configuration(robot.lengths(c) + DT * rates) - c
    assert abs(moved[2]) < ROUNDING
    assert moved[8] == pytest.approx(0.005 * DT)


def test_speeds_are_scaled_together() -> None:
    robot = ROBOTS["hachen2025"]
    rates = robot.lengths_jacobian(robot.home) @ np.array([9.0, 0, 0, 0, 0, 0, 0, 0, 0])
    share = speed_share(robot, rates)
    assert 0.0 < share < 1.0
    assert np.max(np.abs(share * rates)) == pytest.approx(0.02)
    # On top of what uses all of it nothing is left, against it there is twice as much.
    assert speed_share(robot, rates, share * rates) == 0.0
    assert speed_share(robot, -rates, share * rates) == pytest.approx(2.0 * share)
