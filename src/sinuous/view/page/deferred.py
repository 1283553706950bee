"""Sliders send dozens of values while they are dragged: only where they come to rest counts."""

from collections.abc import Callable
from threading import Lock
from time import monotonic

REST = 0.15  # [s]


class Deferred:
    """Does something once nothing has asked for it for a moment.

    Arguments:
        action: what to do
    """

    def __init__(self, action: Callable[[], None]) -> None:
        self._action, self._lock = action, Lock()
        self._asked: float | None = None

    def ask(self, _: object = None) -> None:
        """Do it soon; as a callback it takes the event."""
        with self._lock:
            self._asked = monotonic()

    def forget(self) -> None:
        """Do not, after all."""
        with self._lock:
            self._asked = None

    def settle(self) -> None:
        """Do it now if it was asked for and has come to rest."""
        with self._lock:
            if self._asked is None or monotonic() < self._asked + REST:
                return
            self._asked = None
        self._action()
