"""What a path of the tip asks of the cables, and how to follow it with what they can do.

Where the first joint k of the geometric solution switches, joint angles begin with the square
root of the way (notes A5): at any speed of the tip the cables' rates there are unbounded, and a
loop with actuator speed limits saturates for a while.
"""

from dataclasses import dataclass
from functools import cached_property
from math import isfinite

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray
from sinuous.compiled import inner, kernel
from sinuous.control.geometric_ik import GeometricIK
from sinuous.robots.robot import Robot
from sinuous.robots.routing import Routing, all_lengths

# Load of the worst actuator, by its limit, from which on a step counts as the longest that there
# is, and how often one is looked for: at 1 kHz lengths are all but linear and one try will do.
FULL, ROUNDS = 0.999, 8


@dataclass(frozen=True, kw_only=True, eq=False)
class PathRates:
    """Rates that follow the geometric solution along a path exactly, for each of its steps.

    Arguments:
        rates: of the actuators (K - 1, P) [m/s]
        load: of the actuator that is worst off, by its limit (K - 1,); above 1 it saturates
        switches: whether k is another after the step (K - 1,)
    """

    rates: Array
    load: Array
    switches: BoolArray

    @property
    def saturated(self) -> BoolArray:
        """Steps in which an actuator would have to be faster than it can (K - 1,)."""
        return self.load > 1.0


def path_rates(ik: GeometricIK, path: ArrayLike, dt: float) -> PathRates:
    """Rates along a path of targets (K, 3) [m] that are dt [s] apart.

    Raises:
        ValueError: if dt is not a positive time or the path not two targets or more
    """
    _check(dt)
    value = np.asarray(path, dtype=np.float64)
    if value.ndim != 2 or len(value) < 2:
        raise ValueError(f"path must be (K, 3) with two targets or more, not {value.shape}")
    found = ik.solve(value)
    rates = np.diff(ik.robot.lengths(found.c), axis=0) / dt
    slowest, fastest = ik.robot.rate_limits.T
    with np.errstate(divide="ignore", invalid="ignore"):  # what may not move, or does not
        load = np.where(rates == 0.0, 0.0, rates / np.where(rates > 0.0, fastest, slowest))
    return PathRates(
        rates=rates,
        load=load.max(axis=1),
        switches=np.diff(found.first_joint) != 0,
    )


@dataclass(frozen=True, kw_only=True)
class RateLimiter:
    """Goes straight to a configuration, as fast as actuator speeds allow.

    All actuators slow down together, so that the lengths stay those of a configuration: the tip
    lags behind, but no cable of a module pulls against the other two. Bends on the way are at most
    those at its ends.

    Arguments:
        robot: any `Robot`
        dt: time between steps [s]

    Raises:
        ValueError: if dt is not a positive time
    """

    robot: Robot
    dt: float

    def __post_init__(self) -> None:
        _check(self.dt)

    @cached_property
    def _limits(self) -> Array:
        return np.array(self.robot.rate_limits, dtype=np.float64, order="C")

    def step(self, c: ArrayLike, goal: ArrayLike) -> tuple[Array, float]:
        """From configuration c (n,) towards the goal (n,).

        Returns:
            the configuration one step later (n,), and the share of the way, 0 to 1, that it is:
            below 1 an actuator saturates
        """
        start, end = (np.array(value, dtype=np.float64, order="C") for value in (c, goal))
        ahead, _, share = self.follow(start, self.robot.lengths(start), end)
        return ahead, share

    def follow(self, c: Array, lengths: Array, goal: Array) -> tuple[Array, Array, float]:
        """The same with the lengths (P,) [m] of c known, for loops at 1 kHz.

        Returns:
            the configuration one step later (n,), its lengths (P,) [m], and the share of the way
        """
        ahead, after = np.empty(len(c)), np.empty(len(lengths))
        share = _go(self.robot.routing, self._limits, c, lengths, goal, self.dt, ahead, after)
        return ahead, after, share


def _check(dt: float) -> None:
    if not (isfinite(dt) and dt > 0.0):
        raise ValueError(f"dt must be a positive time, not {dt}")


@kernel
def _go(
    routing: Routing,
    limits: Array,
    c: Array,
    now: Array,
    goal: Array,
    dt: float,
    ahead: Array,
    after: Array,
) -> float:
    """Write how far it gets (n,) and the lengths there (P,), by false position on the share of the
    way; return the share."""
    ahead[:] = goal
    low, low_load, high, high_load = 0.0, 0.0, 1.0, _load(routing, limits, now, ahead, dt, after)
    if not high_load > 1.0:
        return 1.0
    for _ in range(ROUNDS):
        share = low + (high - low) * (0.5 + 0.5 * FULL - low_load) / (high_load - low_load)
        _between(c, goal, share, ahead)
        load = _load(routing, limits, now, ahead, dt, after)
        if load > 1.0:
            high, high_load = share, load
        else:
            low, low_load = share, load
        if low_load >= FULL:
            break
    _between(c, goal, low, ahead)
    _load(routing, limits, now, ahead, dt, after)
    return low


@inner
def _between(c: Array, goal: Array, share: float, ahead: Array) -> None:
    for i in range(c.size):
        ahead[i] = c[i] + share * (goal[i] - c[i])


@kernel
def _load(routing: Routing, limits: Array, now: Array, c: Array, dt: float, after: Array) -> float:
    """Rate of the actuator that is worst off, by its limit; writes the lengths at c (P,)."""
    all_lengths(routing, c, after)
    load = 0.0
    for k in range(now.size):
        change = after[k] - now[k]
        if change != 0.0:
            load = max(load, change / (dt * (limits[k, 1] if change > 0.0 else limits[k, 0])))
    return load
