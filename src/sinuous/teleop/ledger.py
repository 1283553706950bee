"""Who takes energy in, and whether anyone gives out more: observers outside the ports.

All energies are of the wave side, force times displacement over the tick, and positive where the
part takes energy in. A passive part that starts at rest never goes below zero.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.bilateral import Signals
from sinuous.teleop.kernels import work


class Energies(NamedTuple):
    """Energy taken in since the start [J].

    Arguments:
        channel: by ports and links, F_m . V_m dt - F_s . V_sd dt
        operator: by the operator's hand, - F_h . V_m dt
        follower: by the follower with its virtual walls, F_s . V_sd dt
    """

    channel: float
    operator: float
    follower: float


class Ledger:
    """Watches every tick and adds up.

    Arguments:
        dt: time of a tick [s]
    """

    def __init__(self, dt: float) -> None:
        self._dt = dt
        # Plain numbers, which the collector of garbage passes over.
        self._times, self._history = list[float](), list[float]()
        self.energies = Energies(0.0, 0.0, 0.0)

    def observe(self, signals: Signals) -> Energies:
        """Energies [J] with this tick."""
        time, at_leader, at_follower = signals
        channel, operator, follower = self.energies
        out = self._dt * work(at_follower.F_s, at_follower.V_sd)
        now = Energies(
            channel + self._dt * work(at_leader.F_m, at_leader.V) - out,
            operator - self._dt * work(at_leader.F_h, at_leader.V),
            follower + out,
        )
        self.energies = now
        self._times.append(time + self._dt)
        self._history.extend(now)
        return now

    @property
    def least(self) -> Energies:
        """The smallest that each has been, zero at the start [J]."""
        return Energies(*np.min(self.history, axis=0, initial=0.0).tolist())

    @property
    def times(self) -> Array:
        """Ends of the ticks (K,) [s]."""
        return np.array(self._times)

    @property
    def history(self) -> Array:
        """Energies (K, 3) [J] at these times, in the order of `Energies`."""
        return np.array(self._history).reshape(-1, len(Energies._fields))
