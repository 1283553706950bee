"""The device in the operator's hand (27)."""

from dataclasses import dataclass
from math import inf, isnan

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import positive


@dataclass(frozen=True, kw_only=True)
class LeaderDevice:
    """A particle between the operator's force and the one fed back: F_h - F_m = M x'' (27).

    A port that answers a velocity with a force D v is integrated explicitly: M must be above
    dt D / 2, with D the sum of what damps the device, K b scale of the waves and the hand's own.

    Arguments:
        mass: M_m [kg]
        limit: of its workspace, to either side of zero along every axis [m]; it stops there

    Raises:
        ValueError: if one is not positive
    """

    mass: float = 0.1
    limit: float = inf

    def __post_init__(self) -> None:
        positive("mass", self.mass)
        if isnan(self.limit) or self.limit <= 0.0:
            raise ValueError(f"limit must be positive, not {self.limit}")

    def step(self, x: Array, v: Array, F_h: Array, F_m: Array, dt: float) -> tuple[Array, Array]:
        """Position [m] and velocity [m/s] (A,) after a tick of dt [s] under two forces [N]."""
        place, speed = np.empty(x.size), np.empty(x.size)
        kernels.move_device(self.mass, dt, self.limit, x, v, F_h, F_m, place, speed)
        return place, speed

    def force_for(self, speed: Array, v: Array, F_m: Array, dt: float) -> Array:
        """The operator's force (A,) [N] that takes the device from velocity v to speed [m/s]."""
        F_h = np.empty(v.size)
        kernels.drive(self.mass, dt, speed, v, F_m, F_h)
        return F_h
