"""A target that is dragged on a page, a dozen times a second."""

from threading import Lock
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.leaders.freshness import Freshness
from sinuous.leaders.leader import About, ForceKind, Hand, Leader, point
from sinuous.leaders.motion import Follower, Smoothing


class Aim(NamedTuple):
    """Where a page wants the hand to be.

    Arguments:
        number: of all that arrived
        stamp: when it was sent, by the sender's clock or count
        target: (3,) [m]
        connected: whether there is a page
    """

    number: int
    stamp: float
    target: Array
    connected: bool


class Gizmo(Leader):
    """Follows the newest target smoothly, see `Smoothing`.

    `aim` and `lost` may be called from any thread, or on behalf of another process. Targets are
    relative to where the hand was when the session began. A page that sends every 70 ms adds half
    of that to the delay of the filter.

    Arguments:
        smoothing: from targets to motion
    """

    about = About(
        name="gizmo",
        axes="dragged on the page",
        force=ForceKind.NONE,
        run_on_hardware=None,
    )

    def __init__(self, smoothing: Smoothing | None = None) -> None:
        self._smoothing = smoothing or Smoothing()
        self._writing = Lock()
        self.open()

    def open(self) -> None:
        """At zero, at rest."""
        zero = np.zeros(3)
        self._aim = Aim(0, -np.inf, zero, connected=True)
        self._state, self._time = Follower(zero, zero), None
        self._freshness = Freshness()

    _time: float | None

    def aim(self, target: ArrayLike, stamp: float) -> None:
        """Go to a target (3,) [m], unless one with a later stamp has been there before.

        Raises:
            ValueError: if the target is not three finite numbers
        """
        place = point("target", target)
        with self._writing:
            if stamp > self._aim.stamp:
                self._aim = Aim(self._aim.number + 1, stamp, place, connected=True)

    def lost(self) -> None:
        """The page is gone: hold still until a target comes again."""
        with self._writing:
            self._aim = self._aim._replace(connected=False)

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        aim = self._aim
        dt = 0.0 if self._time is None else time - self._time
        self._time = time
        if aim.connected:
            self._state = self._smoothing.step(self._state, aim.target, dt)
        else:
            self._state = Follower(self._state.second, self._state.second)
        age = self._freshness.age(aim.number, time)
        return Hand(self._state.second, aim.connected, aim.connected, age)
