"""The strategy of operators who know that there is a delay: move, stop, wait."""

from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import positive, zero_or_more
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.operators import Felt


class Waiting(NamedTuple):
    """What the operator remembers.

    Arguments:
        stops: how many have been set out for
        start: where the last move began (A,) [m]
        since: when it did [s]
        calm: since when the force has been as it is [s]
        force: as it was then (A,) [N]
    """

    stops: int
    start: Array
    since: float
    calm: float
    force: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class MoveAndWait:
    """Moves to one place after another and waits at each until the force has come back.

    A move is a source of motion with a smooth start and end, of least jerk. Waiting ends when the
    force has not changed for a while; for that to mean that all of it has come back, the while
    has to be longer than the way there and back.

    Arguments:
        stops: places to go to (J, A) [m], in the leader's coordinates; the last is for good
        moving: how long a move takes [s]
        patience: how long the force has to stay the same [s]
        tolerance: within which it counts as the same, per axis [N]

    Raises:
        ValueError: if there is no stop, or a number makes no sense
    """

    stops: Array
    moving: float = 1.0
    patience: float = 1.0
    tolerance: float = 0.01

    def __post_init__(self) -> None:
        stops = np.array(self.stops, dtype=np.float64)
        if stops.ndim != 2 or not len(stops) or not np.all(np.isfinite(stops)):
            raise ValueError("stops must be finite places (J, A), one or more")
        positive("moving", self.moving)
        positive("patience", self.patience)
        zero_or_more("tolerance", self.tolerance)
        object.__setattr__(self, "stops", stops)

    def init(self, x: Array) -> Waiting:
        """About to set out from x (A,) [m].

        Raises:
            ValueError: if the stops have another number of axes
        """
        if self.stops.shape[1] != x.size:
            raise ValueError(f"stops must have {x.size} axes, not {self.stops.shape[1]}")
        return Waiting(stops=1, start=x, since=0.0, calm=self.moving, force=np.zeros(x.size))

    def step(
        self, state: Waiting, felt: Felt, device: LeaderDevice, dt: float
    ) -> tuple[Waiting, Array]:
        """The force F_h (A,) [N] on the device for one tick of dt [s]."""
        state = self._after(state, felt)
        speed, share = np.empty(felt.x.size), min((felt.time + dt - state.since) / self.moving, 1.0)
        kernels.least_jerk(share, dt, state.start, self.stops[state.stops - 1], felt.x, speed)
        return state, device.force_for(speed, felt.v, felt.load, dt)

    def _after(self, state: Waiting, felt: Felt) -> Waiting:
        """What is to be done now that a force is felt."""
        if felt.time < state.since + self.moving:
            return state
        force = felt.load.force
        if kernels.apart(force, state.force) > self.tolerance:
            return state._replace(calm=felt.time, force=force)
        if felt.time < state.calm + self.patience or state.stops == len(self.stops):
            return state
        return Waiting(
            stops=state.stops + 1,
            start=felt.x,
            since=felt.time,
            calm=felt.time + self.moving,
            force=force,
        )
