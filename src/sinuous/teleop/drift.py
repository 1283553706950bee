"""Bringing the follower's desired point back to the leader's, without making energy."""

from dataclasses import dataclass
from math import sqrt

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import positive, zero_or_more


@dataclass(frozen=True, kw_only=True)
class DriftCorrection:
    """A velocity v_c towards the leader's position, as last received, on top of the wave's.

    Velocity waves carry no position: what loss, a change of delay or a clamped target takes away
    stays away (notes A12). Adding v_c to the desired velocity takes F_s . v_c from the channel.
    By the identity of notes A11 the channel's power contains, for every axis,

        (F_s - g_r)^2 / 2b >= 0,

    which the follower's port dissipates and, knowing F_s and g_r, can measure; all other terms
    are of stored energy, or are zero or more for K >= 1/2 by themselves. A tank takes what is
    dissipated in, tick by tick, and pays for v_c: where F_s . v_c is positive it is shortened to
    what the tank holds, where it is zero or less it is free. So the sum of what v_c took is never
    above the sum of what was dissipated, and the channel with the correction is as passive as
    without: its energy never falls below zero. The tank is bounded, so that what was dissipated
    long ago is not let loose at once; what does not fit is lost, which is on the safe side.

    Under passivity control energy that was heard of and not used, which is what loss leaves behind,
    pays for what the tank cannot: it counts as used then. With c the sums of the prices and l of
    what was dissipated, (2) of `passivity` becomes

        sum of - F_s . v_sd dt = sent - used_by_waves + l - c >= sent - used

    as before, for c is at most l and what was used for the correction. So it is for standard waves,
    and for velocity and force without waves, which dissipate nothing.

    Arguments:
        rate: of the decay of an offset [1/s]
        speed: largest v_c [m/s]
        capacity: of the tank [J]; zero: v_c has only what is dissipated in the same tick

    Raises:
        ValueError: if rate or speed is not positive, or the capacity negative
    """

    rate: float = 1.0
    speed: float = 0.02
    capacity: float = 0.01

    def __post_init__(self) -> None:
        positive("rate", self.rate)
        positive("speed", self.speed)
        zero_or_more("capacity", self.capacity)

    def step(
        self,
        tank: float,
        lost: float,
        force: Array,
        offset: Array,
        dt: float,
        *,
        spare: float = 0.0,
    ) -> tuple[float, float, Array]:
        """What is in the tank after a tick [J], what was spent beyond [J], and v_c (A,) [m/s].

        Arguments:
            tank: energy in it [J]
            lost: power that the follower's port dissipates in this tick [W]
            force: F_s (A,) [N]
            offset: from the desired point to the leader's (A,) [m]
            dt: time of the tick [s]
            spare: energy that was heard of and not used [J]
        """
        wanted = self.rate * offset
        fastest = sqrt(kernels.work(wanted, wanted))
        if fastest > self.speed:
            wanted *= self.speed / fastest
        tank, price = filled(tank, lost * dt), cost(force, wanted, dt)
        if price > tank + spare:
            wanted *= (tank + spare) / price
            price = tank + spare
        from_tank = min(price, tank)
        return min(tank - from_tank, self.capacity), price - from_tank, wanted


def filled(tank: float, energy: float) -> float:
    """What is in the tank with what was dissipated [J]."""
    return tank + energy


def cost(force: Array, v_c: Array, dt: float) -> float:
    """Energy that v_c takes from the channel; zero if it takes none [J]."""
    return max(kernels.work(force, v_c) * dt, 0.0)
