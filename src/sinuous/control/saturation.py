"""What actuators can do of what a controller without constraints asks for."""

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.bending import bends
from sinuous.robots.robot import Robot

ROUNDING = 1e-12  # [rad] by which a bend may exceed its limit

# Clipping lengths and going back to a robot's shape disturb each other a little: repeat.
ROUNDS = 3


def attainable(robot: Robot, lengths: Array, rates: Array, dt: float) -> Array:
    """Rates (P,) [m/s] near those asked for that keep all limits for one step.

    Lengths and bends stop at their limits, each segment for itself, as stops in the robot would
    do; speeds are scaled together, which keeps the direction.  What comes out moves between two
    configurations, so it keeps the coupling rules (19).

    Arguments:
        lengths: of the actuators now (P,) [m]; within limits, or as far beyond as they are
        rates: asked for (P,) [m/s]
        dt: of the step [s]
    """
    now = robot.configuration(lengths)
    c = robot.configuration(lengths + dt * rates)
    low, high = robot.length_limits.T
    low, high = np.minimum(low, lengths), np.maximum(high, lengths)
    for _ in range(ROUNDS):
        asked = robot.lengths(c)
        if np.all((asked >= low) & (asked <= high)) and np.all(robot.bend_slack(c) >= 0.0):
            break
        c = unbent(robot, robot.configuration(np.clip(asked, low, high)), now)
    change = (robot.lengths(c) - robot.lengths(now)) / dt
    return change * speed_share(robot, change)


def speed_share(robot: Robot, rates: Array, base: Array | float = 0.0) -> float:
    """Largest share of rates (P,), 0 to 1, that speed limits allow on top of base rates (P,)."""
    slowest, fastest = robot.rate_limits.T
    room = np.where(rates > 0.0, fastest - base, slowest - base)
    moving = rates != 0.0
    shares = room[moving] / rates[moving]
    return float(np.clip(np.min(shares, initial=1.0), 0.0, 1.0))


def unbent(robot: Robot, c: Array, now: Array) -> Array:
    """The configuration with no segment bent beyond its limit, or farther beyond than it is now."""
    limits = robot.bend_limits
    excess = np.maximum(-robot.bend_slack(now) / limits.pitch, 0.0)
    c = c.copy()
    for j, column in enumerate(limits.column):
        limit = max(float(limits.slope[j] @ c + limits.offset[j]), 0.0) + excess[j]
        # The bend of a joint is not linear in the share of its angles: a few rounds settle it.
        while (bent := float(bends(limits, c)[j])) > limit + ROUNDING:
            c[column : column + 2] *= limit / bent
    return c
