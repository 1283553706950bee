"""From what a device says to smooth motion. Time is passed in: nothing here knows a clock."""

from dataclasses import dataclass
from math import exp
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.leaders.leader import positive


class Follower(NamedTuple):
    """Where a `Smoothing` is.

    Arguments:
        first: low-pass of the target (3,) [m]
        second: low-pass of the first, what goes out (3,) [m]
    """

    first: Array
    second: Array


@dataclass(frozen=True)
class Smoothing:
    """A target that jumps becomes a motion without jumps in place or speed.

    Two equal low-passes in a row, a filter of second order with critical damping, each of which
    goes a share of the way to its goal and no further than the speed allows:

        p1 += min(1 - exp(-dt/tau), speed dt / |g - p1|) (g - p1),
        p2 += min(1 - exp(-dt/tau), speed dt / |p1 - p2|) (p1 - p2),     tau = delay / 2.

    A share of the way to a point is a mean of where one is and that point. So what goes out is a
    mean of all targets so far, with weights that sum to one: it reaches a target that stays, and
    never leaves the convex hull of the targets, however they jump. A target that moves steadily,
    more slowly than the speed, is followed a delay later.

    Arguments:
        delay: that it adds [s]
        speed: that it never exceeds [m/s]

    Raises:
        ValueError: if one is not positive
    """

    delay: float = 0.04
    speed: float = 0.25

    def __post_init__(self) -> None:
        positive("delay", self.delay)
        positive("speed", self.speed)

    def step(self, state: Follower, target: Array, dt: float) -> Follower:
        """Where it is dt [s] later, for a target (3,) [m]."""
        share, reach = 1.0 - exp(-2.0 * dt / self.delay), self.speed * dt
        first = _towards(state.first, target, share, reach)
        return Follower(first, _towards(state.second, first, share, reach))


def _towards(place: Array, goal: Array, share: float, reach: float) -> Array:
    """A share of the way from a place to a goal, no longer than a reach [m]."""
    way = goal - place
    length = float(np.sqrt(way @ way))
    if share * length <= reach:
        return place + share * way
    return place + (reach / length) * way


class Motion(NamedTuple):
    """What has been integrated of a rate device.

    Arguments:
        place: (3,) [m]
        velocity: (3,) [m/s]
    """

    place: Array
    velocity: Array


REST = Motion(np.zeros(3), np.zeros(3))


@dataclass(frozen=True)
class Rates:
    """A deflection becomes a velocity that starts and stops by ramps, and that a place.

    The velocity goes straight to speed times deflection, by at most acceleration dt in a tick of
    dt; the place takes the mean of the velocities before and after. The deflection is cut to a
    length of one, so a diagonal is no faster than an axis.

    Arguments:
        speed: at full deflection [m/s]
        acceleration: of the ramps [m/s^2]

    Raises:
        ValueError: if one is not positive
    """

    speed: float = 0.03
    acceleration: float = 0.3

    def __post_init__(self) -> None:
        positive("speed", self.speed)
        positive("acceleration", self.acceleration)

    def step(self, state: Motion, deflection: Array, dt: float) -> Motion:
        """Place and velocity dt [s] later, for a deflection (3,) of at most 1."""
        length = float(np.sqrt(deflection @ deflection))
        wanted = (self.speed / max(length, 1.0)) * deflection
        velocity = _towards(state.velocity, wanted, 1.0, self.acceleration * dt)
        return Motion(state.place + (0.5 * dt) * (state.velocity + velocity), velocity)


def beyond_dead_zone(deflection: Array, zone: float) -> Array:
    """A deflection (A,) whose dead zone is cut out: 0 up to the zone, from there to 1 at 1."""
    length = float(np.sqrt(deflection @ deflection))
    if length <= zone:
        return np.zeros(deflection.size)
    return deflection * ((min(length, 1.0) - zone) / ((1.0 - zone) * length))
