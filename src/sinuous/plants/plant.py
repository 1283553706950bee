"""What stands in for hardware: takes actuator rates, yields a measurement."""

from dataclasses import dataclass
from typing import Protocol

from sinuous.arrays import Array


@dataclass(frozen=True, kw_only=True)
class Measurement:
    """What is known of the robot after a step.

    Arguments:
        points: body points (S, 3) in the world frame [m]
        tip: tip position (3,) [m]
        lengths: actuator lengths (P,) as commanded [m]
    """

    points: Array
    tip: Array
    lengths: Array


class Plant(Protocol):
    """A robot that moves."""

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        ...
