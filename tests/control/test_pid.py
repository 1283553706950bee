"""The cable PID (26): against closed forms, and what keeps it sane at its limits."""

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from sinuous.control.pid import Pid
from sinuous.control.transmission import Transmission

DT = 1e-3
FREE = (np.array([-np.inf]), np.array([np.inf]))


def follow(
    pid: Pid, desired: np.ndarray, fastest: float = np.inf, start: float = 0.0
) -> tuple[np.ndarray, np.ndarray]:
    """Lengths (K,) and asked-for speeds (K,) of a cable that does as it is told."""
    state, length = pid.at_rest(1), start
    lengths, speeds = list[float](), list[float]()
    limit = np.array([fastest])
    for goal in desired:
        state, speed, _ = pid.step(state, np.array([goal - length]), -limit, limit, DT)
        length += DT * float(speed[0])
        lengths.append(length)
        speeds.append(float(speed[0]))
    return np.array(lengths), np.array(speeds)


def test_the_loop_is_the_printed_equation() -> None:
    """A ramp against the differential equation of (26) around an integrator, without filter."""
    kp, ki, kd, slope = 5.0, 2.0, 0.05, 0.1
    time = DT * np.arange(1, 3001)
    lengths, _ = follow(Pid(filter=0.0), slope * time)

    def rates(t: float, x: np.ndarray) -> list[float]:
        error = slope * t - x[0]
        # L' = kp e + ki int + kd (r' - L')
        return [(kp * error + ki * x[1] + kd * slope) / (1.0 + kd), error]

    exact = solve_ivp(rates, (0.0, time[-1]), [0.0, 0.0], t_eval=time, rtol=1e-10, atol=1e-12)
    # Euler at 1 ms of a loop with a time constant of 0.2 s: half a percent of the largest lag.
    lag = np.max(np.abs(slope * time - exact.y[0]))
    assert np.max(np.abs(lengths - exact.y[0])) < 0.01 * lag


def test_a_ramp_is_followed_with_the_lag_of_the_gains() -> None:
    """With the integral the lag vanishes; without, it is speed by K_P."""
    ramp = 0.05 * DT * np.arange(1, 8001)
    without, _ = follow(Pid(integral=0.0), ramp)
    assert ramp[-1] - without[-2] == pytest.approx(0.05 / 5.0, rel=1e-6)  # as the loop sees it
    with_integral, _ = follow(Pid(), ramp)
    assert abs(ramp[-1] - with_integral[-1]) < 0.1 * 0.05 / 5.0


def test_the_integral_does_not_wind_up() -> None:
    """A long way at the speed limit: the overshoot is that of a way without limit, not more."""
    pid = Pid(integral=2.0)
    step = np.full(20000, 1.0)
    limited, speeds = follow(pid, step, fastest=0.1)
    assert np.max(np.abs(speeds)) <= 0.1
    free, _ = follow(pid, step)
    assert np.max(limited) <= np.max(free) + 1e-6
    assert abs(limited[-1] - 1.0) < 1e-3


def test_winding_up_would_be_seen() -> None:
    """The same way with an integral that goes on at the limit overshoots by ten times as much."""
    length, total, largest = 0.0, 0.0, 0.0
    for _ in range(20000):
        error = 1.0 - length
        total += DT * error
        length += DT * min(max(5.0 * error + 2.0 * total, -0.1), 0.1)
        largest = max(largest, length)
    limited, _ = follow(Pid(derivative=0.0), np.full(20000, 1.0), fastest=0.1)
    assert largest - 1.0 > 3.0 * (np.max(limited) - 1.0)


def test_the_filter_tames_the_encoder() -> None:
    """One step of an encoder is a jump of speed of K_D step / (filter + dt), not step / dt."""
    pid, step = Pid(proportional=0.0, integral=0.0), np.array([1e-6])
    _, speed, _ = pid.step(pid.at_rest(1), step, *FREE, DT)
    assert speed[0] == pytest.approx(0.05 * 1e-6 / (0.005 + DT))
    bare = Pid(proportional=0.0, integral=0.0, filter=0.0)
    _, speed, _ = bare.step(bare.at_rest(1), step, *FREE, DT)
    assert speed[0] == pytest.approx(0.05 * 1e-6 / DT)


def test_what_the_limit_takes_is_told() -> None:
    pid, limit = Pid(integral=0.0, derivative=0.0), np.array([0.1, 0.1])
    _, speed, clipped = pid.step(pid.at_rest(2), np.array([0.01, -0.04]), -limit, limit, DT)
    np.testing.assert_allclose(speed, [0.05, -0.1])
    assert clipped == pytest.approx(0.5)


@pytest.mark.parametrize("name", ["proportional", "integral", "derivative", "filter"])
@pytest.mark.parametrize("value", [-1.0, np.nan, np.inf])
def test_bad_gains_are_refused(name: str, value: float) -> None:
    with pytest.raises(ValueError, match=name):
        Pid(**{name: value})


def test_a_transmission_turns_rotation_into_length() -> None:
    screw = Transmission(lead=0.01, ratio=4.0, speed=2.0 * np.pi * 100.0)
    one_turn = screw.rates(np.array([2.0 * np.pi]))
    np.testing.assert_allclose(one_turn, 0.01 / 4.0)
    assert screw.cable_speed == pytest.approx(0.25)
    np.testing.assert_allclose(screw.rotation(screw.rates(np.array([3.0]))), 3.0)


@pytest.mark.parametrize("name", ["lead", "ratio", "speed"])
def test_a_bad_transmission_is_refused(name: str) -> None:
    with pytest.raises(ValueError, match=name):
        Transmission(**{name: 0.0})
