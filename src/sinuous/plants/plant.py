"""What stands in for hardware: takes actuator rates, yields a measurement."""

from dataclasses import dataclass
from typing import Protocol

from sinuous.arrays import Array
from sinuous.measurement import Measurement


@dataclass(frozen=True, kw_only=True, eq=False)
class Truth:
    """How a plant really is: for sensors and judges, never for controllers.

    Arguments:
        points: guarded body points (S, 3) in the world frame [m]
        T_w_t: pose of the tip (4, 4)
        lengths: actuator lengths (P,) [m]
    """

    points: Array
    T_w_t: Array
    lengths: Array


class Plant(Protocol):
    """A robot that moves."""

    @property
    def truth(self) -> Truth:
        """Where it really is after the last step."""
        ...

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        ...
