"""What a tip does at the end of a run: it rests, it creeps, or it goes to and fro."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.hachen2025.undisturbed import DT

END = 2.0
"""The last part of a run that is looked at [s]."""

OSCILLATING = 0.5e-3
"""A tip that covers more than this in that time does not rest [m]."""

TURNS_BACK = 2.0
"""A tip whose way is that many times as long as what it covers goes to and fro."""


@dataclass(frozen=True, kw_only=True)
class End:
    """The last seconds of a run.

    Arguments:
        extent: peak to peak, the diagonal of the box around the tip's path [m]: no axis by itself
            covers more
        path: length of the tip's way [m]
    """

    extent: float
    path: float

    @property
    def moving(self) -> bool:
        """Whether the tip does not rest, whatever else it does."""
        return self.extent > OSCILLATING

    @property
    def to_and_fro(self) -> bool:
        """Whether it oscillates and does not only creep towards its target."""
        return self.moving and self.path > TURNS_BACK * self.extent


def end_of(path: Array) -> End:
    """The end of a tip's path (K, 3) [m], one place for every step."""
    last = path[-round(END / DT) - 1 :]
    return End(
        extent=float(np.linalg.norm(np.ptp(last, axis=0))),
        path=float(np.sum(np.linalg.norm(np.diff(last, axis=0), axis=1))),
    )
