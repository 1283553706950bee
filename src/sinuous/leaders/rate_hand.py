"""The hand of a device that says how fast, not where: keys, sticks, pucks."""

from math import inf

import numpy as np

from sinuous.arrays import Array
from sinuous.leaders.freshness import Freshness
from sinuous.leaders.leader import Hand
from sinuous.leaders.motion import REST, Motion, Rates

LONGEST_TICK = 0.05
"""How much of the time between two readings counts as motion at most [s]: after a longer gap, such
as a pause, the hand has not moved meanwhile."""


class RateHand:
    """Integrates deflections from one reading to the next.

    Arguments:
        rates: from deflection to motion
        stale: how long a deflection counts that the device has not repeated [s]
    """

    def __init__(self, rates: Rates, *, stale: float = inf) -> None:
        self._rates, self._stale = rates, stale
        self.reset()

    def reset(self) -> None:
        """Begin at zero, at rest."""
        self._motion = REST
        self._time: float | None = None
        self._freshness = Freshness()

    def read(self, time: float, deflection: Array | None, number: int) -> Hand:
        """The hand at a time.

        Arguments:
            time: [s]
            deflection: (3,) of at most 1; None if the device is gone: then the hand stops at once
            number: of what the device has said so far
        """
        dt = 0.0 if self._time is None else min(time - self._time, LONGEST_TICK)
        self._time = time
        age = self._freshness.age(number, time)
        if deflection is None:
            self._motion = Motion(self._motion.place, np.zeros(3))
            return Hand(self._motion.place, held=False, connected=False, age=age)
        wanted = deflection if age <= self._stale else np.zeros(3)
        self._motion = self._rates.step(self._motion, wanted, dt)
        return Hand(self._motion.place, held=True, connected=True, age=age)
