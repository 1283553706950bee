"""What stands in for hardware: takes actuator rates, yields a measurement."""

from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.measurement import Measurement


@dataclass(frozen=True, kw_only=True, eq=False)
class Truth:
    """How a plant really is: for sensors and judges, never for controllers.

    Arguments:
        points: guarded body points (S, 3) in the world frame [m]
        T_w_t: pose of the tip (4, 4)
        lengths: actuator lengths (P,) [m]
        curvature: of the centre line on the arcs between the points (S - 1, 2) [1/m], see
            `robots.centreline`; (0, 2) if the plant does not know it
    """

    points: Array
    T_w_t: Array
    lengths: Array
    curvature: Array = field(default_factory=lambda: np.zeros((0, 2)))


class Plant(Protocol):
    """A robot that moves."""

    @property
    def truth(self) -> Truth:
        """Where it really is after the last step."""
        ...

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        ...
