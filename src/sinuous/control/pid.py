"""The cable length controller (26) of paper A: one PID for every cable.

    u = K_P e + K_I int e + K_D de/dt,   e = L_d - L_s,

with what a real loop needs and print leaves out: a filter on the derivative, a limit of u, and
an integral that stops while u is at its limit and would go further (anti-windup).
"""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel


class PidState(NamedTuple):
    """What the loop remembers, for every cable (P,)."""

    error: Array  # of the last tick [m]
    integral: Array  # of the error [m s]
    slope: Array  # of the error, filtered [m/s]


@dataclass(frozen=True, kw_only=True)
class Pid:
    """Gains from a length error to the speed of a cable; the defaults are those printed.

    Arguments:
        proportional: K_P [1/s]
        integral: K_I [1/s^2]
        derivative: K_D
        filter: time constant of the derivative's filter [s]

    Raises:
        ValueError: if a gain is negative or the filter not a time of zero or more
    """

    proportional: float = 5.0
    integral: float = 2.0
    derivative: float = 0.05
    filter: float = 0.005

    def __post_init__(self) -> None:
        for name in ("proportional", "integral", "derivative", "filter"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value >= 0.0):
                raise ValueError(f"{name} must be a number of zero or more, not {value}")

    @staticmethod
    def at_rest(cables: int) -> PidState:
        """The state to start from."""
        return PidState(np.zeros(cables), np.zeros(cables), np.zeros(cables))

    def step(
        self, state: PidState, error: Array, slowest: Array, fastest: Array, dt: float
    ) -> tuple[PidState, Array, float]:
        """One tick: the next state, the cables' speeds (P,) [m/s], and the share cut off.

        Arguments:
            error: L_d - L_s (P,) [m]
            slowest, fastest: limits of the speeds (P,) [m/s]
            dt: [s]
        """
        after = PidState(error, np.empty_like(error), np.empty_like(error))
        speed = np.empty_like(error)
        clipped = _step(
            self.proportional, self.integral, self.derivative, self.filter, state.error,
            state.integral, state.slope, error, slowest, fastest, dt, after.integral,
            after.slope, speed,
        )  # fmt: skip
        return after, speed, clipped


@kernel
def _step(
    proportional: float,
    gain: float,
    derivative: float,
    time_constant: float,
    before: Array,
    integral: Array,
    slope: Array,
    error: Array,
    slowest: Array,
    fastest: Array,
    dt: float,
    new_integral: Array,
    new_slope: Array,
    speed: Array,
) -> float:
    clipped = 0.0
    for k in range(error.size):
        change = (error[k] - before[k]) / dt
        new_slope[k] = slope[k] + dt / (time_constant + dt) * (change - slope[k])
        total = integral[k] + dt * error[k]
        asked = proportional * error[k] + gain * total + derivative * new_slope[k]
        speed[k] = min(max(asked, slowest[k]), fastest[k])
        winds_up = speed[k] != asked and (asked - speed[k]) * error[k] > 0.0
        new_integral[k] = integral[k] if winds_up else total
        if speed[k] != asked:
            clipped = max(clipped, 1.0 - speed[k] / asked)
    return clipped
