"""From the rotation of an actuator to the length of its cable."""

from dataclasses import dataclass
from math import pi

import numpy as np

from sinuous.arrays import Array


@dataclass(frozen=True, kw_only=True)
class Transmission:
    """A lead screw behind a reducer pulls the cable (paper A, section 2.1).

    The defaults are representative: nothing about them is printed but the motor, Maxon EC-max 30.

    Arguments:
        lead: way of the nut in one turn of the screw [m]
        ratio: turns of the motor in one turn of the screw
        speed: largest of the motor [rad/s]

    Raises:
        ValueError: if one is not positive and finite
    """

    lead: float = 0.01
    ratio: float = 4.3
    speed: float = 9000.0 * pi / 30.0

    def __post_init__(self) -> None:
        for name in ("lead", "ratio", "speed"):
            value = getattr(self, name)
            if not (np.isfinite(value) and value > 0.0):
                raise ValueError(f"{name} must be positive and finite, not {value}")

    @property
    def travel(self) -> float:
        """Way of the cable by angle of the motor [m/rad]."""
        return self.lead / (2.0 * pi * self.ratio)

    @property
    def cable_speed(self) -> float:
        """Largest speed of the cable [m/s]."""
        return self.speed * self.travel

    def rotation(self, rates: Array) -> Array:
        """Speeds of the motors [rad/s] that move cables at rates [m/s]."""
        return rates / self.travel

    def rates(self, rotation: Array) -> Array:
        """Rates of the cables [m/s] of motors that turn [rad/s]."""
        return rotation * self.travel
