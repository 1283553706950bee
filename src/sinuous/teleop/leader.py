"""The device in the operator's hand (27)."""

from dataclasses import dataclass
from math import inf, isnan
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import energy_kernels, kernels
from sinuous.teleop.checks import positive

ROUNDING = 1e-15  # of the energy of a tick [J]


class Load(NamedTuple):
    """What a device works against in a tick: F_m = force + damping v.

    Under passivity control a force may yield: of it stays h = 1 - a / (4 spare), zero or more, when
    the device moves so that it gives out an energy a, see `position_force`.

    Arguments:
        force: that it would feel at rest (A,) [N]
        damping: with which the port answers its velocity at once (A,) [N s/m]
        spare: energy that a force that yields may give out [J]; infinite for one that does not
        scale: of the velocity that this energy is counted with (A,); only for a force that yields
    """

    force: Array
    damping: Array
    spare: float = inf
    scale: Array = np.ones(0)


@dataclass(frozen=True, kw_only=True)
class LeaderDevice:
    """A particle between the operator's force and the one fed back: F_h - F_m = M x'' (27).

    The velocity v of a tick takes x as far as x + dt v, and F_m is of the same v. So what the
    device gives to the port, F_m . dt v, is what the port takes, whatever M and the damping are. An
    F_m of the velocity before would make energy in every tick: standard waves, which have no loss
    to pay for it, then diverge.

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

    def step(self, x: Array, v: Array, F_h: Array, load: Load, dt: float) -> tuple[Array, Array]:
        """Position after a tick of dt [s], and velocity during it (A,) [m], [m/s].

        Arguments:
            x: position before (A,) [m]
            v: velocity of the tick before (A,) [m/s]
            F_h: the operator's force (A,) [N]
            load: what it works against
        """
        place, speed = np.empty(x.size), np.empty(x.size)
        kernels.move_device(
            self.mass, dt, self.limit, x, v, F_h, load.force, load.damping, place, speed
        )
        return place, speed

    def give_way(
        self, x: Array, v: Array, F_h: Array, load: Load, dt: float
    ) -> tuple[float, Array, Array]:
        """The share h that stays of a force that yields, and then as `step`.

        Where a stop of the workspace holds one axis up, the others may move so that h is too much.
        A smaller one is not: the less a force, the less way it moves anyone.
        """
        force, damping, spare, scale = load
        h = energy_kernels.kept(self.mass, dt, v, F_h, force, damping, spare, scale)
        place, speed = self.step(x, v, F_h, Load(h * force, damping), dt)
        given = -h * dt * kernels.work(force, scale * speed)
        if given > spare + ROUNDING:
            h *= spare / given
            place, speed = self.step(x, v, F_h, Load(h * force, damping), dt)
        return h, place, speed

    def force_for(self, speed: Array, v: Array, load: Load, dt: float) -> Array:
        """The operator's force (A,) [N] that takes the device from velocity v to speed [m/s]."""
        F_h, force = np.empty(v.size), load.force
        if load.spare < inf:
            force = energy_kernels.left(force, load.scale * speed, load.spare, dt) * force
        kernels.drive(self.mass, dt, speed, v, force, load.damping, F_h)
        return F_h
