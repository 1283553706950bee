"""Where the tip shall go, leg by leg."""

from bisect import bisect
from collections.abc import Callable
from dataclasses import dataclass
from math import ceil, isfinite

import numpy as np

from sinuous.arrays import Array, ArrayLike

MAX_STEPS = 300


@dataclass(frozen=True, kw_only=True, eq=False)
class Leg:
    """A target that moves for a while and is then held until the robot rests.

    Arguments:
        target: position [m] (3,) of the tip by the time since the leg began [s]
        moving: how long the target moves [s]; zero for a way-point
        max_steps: the longest that it is held after that, in control steps

    Raises:
        ValueError: if the leg would have no step, or no end
    """

    target: Callable[[float], ArrayLike]
    moving: float = 0.0
    max_steps: int = MAX_STEPS

    def __post_init__(self) -> None:
        if not (isfinite(self.moving) and self.moving >= 0.0 and self.max_steps >= 0):
            raise ValueError("a leg lasts a finite time and zero or more steps")
        if self.moving == 0.0 and self.max_steps == 0:
            raise ValueError("a leg needs some time or steps")

    def at(self, time: float) -> Array:
        """The target [m] (3,) at a time since the leg began [s]."""
        return np.array(self.target(min(time, self.moving)), dtype=np.float64)

    def steps(self, dt: float) -> int:
        """The most steps of dt [s] that the leg takes."""
        # A time that is a whole number of steps but for rounding needs no step more.
        return ceil(self.moving / dt - 1e-9) + self.max_steps


def waypoints(points: ArrayLike, *, max_steps: int = MAX_STEPS) -> tuple[Leg, ...]:
    """Points [m] (K, 3), each held until the robot rests, or for max_steps."""
    places = np.asarray(points, dtype=np.float64).reshape(-1, 3)
    return tuple(Leg(target=_fixed(place), max_steps=max_steps) for place in places)


def timed_path(times: ArrayLike, points: ArrayLike, *, max_steps: int = MAX_STEPS) -> tuple[Leg]:
    """A path followed in time, linear between its points, whose end is then held.

    Arguments:
        times: [s] (K,), increasing; before the first the target is the first point
        points: [m] (K, 3)
        max_steps: the longest that the end is held, in control steps
    """
    t, p = np.asarray(times, dtype=np.float64), np.asarray(points, dtype=np.float64)
    began, slopes = t.tolist(), np.diff(p, axis=0) / np.diff(t)[:, None]

    def target(time: float) -> Array:
        k = bisect(began, time) - 1  # a fast controller asks a thousand times a second
        if k < 0 or k == len(slopes):
            return p[max(k, 0)]
        return p[k] + (time - began[k]) * slopes[k]

    return (Leg(target=target, moving=max(float(t[-1]), 0.0), max_steps=max_steps),)


def follow(
    target: Callable[[float], ArrayLike], *, duration: float, max_steps: int = MAX_STEPS
) -> tuple[Leg]:
    """A target that is a function of time, up to a duration [s], whose end is then held.

    Arguments:
        target: position [m] (3,) by time [s]
        duration: [s]
        max_steps: the longest that the end is held, in control steps
    """
    return (Leg(target=target, moving=duration, max_steps=max_steps),)


def _fixed(place: Array) -> Callable[[float], Array]:
    return lambda _: place
