"""Bounds of what comes from afar, so that no packet can kick."""

from dataclasses import dataclass
from math import inf

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import energy_kernels
from sinuous.teleop.checks import not_negative


@dataclass(frozen=True, kw_only=True)
class Limits:
    """The largest signal from afar, and its fastest change.

    At the leader's end the signal is the force on a hand at rest [N], at the follower's the
    desired velocity without a force on it [m/s]. Both are a wave times a number: the wave itself is
    bounded before the port uses it. So all that is known of the channel's energy holds for what
    was used, and a hand that cannot hold more than the largest force is pushed back by the same
    channel until nobody pushes harder. A smaller wave takes less energy: the size is kept to
    whatever comes. A wave that falls more slowly than it was received takes more: under passivity
    control the fall is as slow as the energy left allows; without, it makes energy. What the port
    answers the hand's own motion with, `damping` times v, opposes it and comes on top.

    Arguments:
        size: [N] or [m/s]
        slew: [N/s] or [m/s^2]

    Raises:
        ValueError: if one is negative
    """

    size: float = inf
    slew: float = inf

    def __post_init__(self) -> None:
        not_negative("size", self.size)
        not_negative("slew", self.slew)

    def wave(self, wanted: Array, before: Array, gain: float, dt: float) -> Array:
        """The wave within the limits that is nearest to what is wanted (A,).

        Arguments:
            before: the wave used in the tick before (A,)
            gain: the signal by the wave
            dt: time of the tick [s]
        """
        out = np.empty(wanted.size)
        energy_kernels.limit_signal(self.size / gain, self.slew * dt / gain, wanted, before, out)
        return out
