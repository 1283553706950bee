"""Quantiles of how long things took, of any number of them in a fixed room."""

from math import log
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray

FIRST, GROWTH, BINS = 1e-6, 1.02, 1000
"""The lower end of the second bin [s], the ratio of one bin to the next, and their number:
quantiles are exact to 2 %, from a microsecond to five minutes."""

_PER_BIN = 1.0 / log(GROWTH)
_FLOOR = FIRST / GROWTH


class Quantiles(NamedTuple):
    """Of times [s]; all zero if there was none."""

    median: float
    p99: float
    max: float


class Times:
    """Counts times by their size.

    Arguments:
        counts: of each bin (BINS,), which may be shared with other processes
        worst: the longest (1,) [s], which may be shared as well
    """

    def __init__(self, counts: IntArray, worst: Array) -> None:
        self._counts, self._worst = counts, worst

    @classmethod
    def new(cls) -> "Times":
        """Without any."""
        return cls(np.zeros(BINS, dtype=np.int64), np.zeros(1))

    def add(self, time: float) -> None:
        """Count one [s]; below zero counts as zero."""
        place = 0 if time < FIRST else min(int(log(time / _FLOOR) * _PER_BIN), BINS - 1)
        self._counts[place] += 1
        if time > self._worst[0]:
            self._worst[0] = time

    @property
    def number(self) -> int:
        """How many there were."""
        return int(np.sum(self._counts))

    @property
    def quantiles(self) -> Quantiles:
        """Upper ends of the bins, the longest as it was."""
        worst = float(self._worst[0])
        return Quantiles(self._quantile(0.5, worst), self._quantile(0.99, worst), worst)

    def beyond(self, time: float) -> int:
        """How many took longer than a time [s], exact to a bin."""
        return int(np.sum(self._counts[int(log(time / _FLOOR) * _PER_BIN) + 1 :]))

    def _quantile(self, share: float, worst: float) -> float:
        below = np.cumsum(self._counts)
        if not below[-1]:
            return 0.0
        place = int(np.searchsorted(below, share * below[-1]))
        return min(_FLOOR * GROWTH ** (place + 1), worst)
