"""The only clock of a live session: simulated parts never read one."""

from time import perf_counter, sleep
from typing import Protocol


class Clock(Protocol):
    """Tells the time and waits for it."""

    def now(self) -> float:
        """Time [s], from any beginning, the same in all processes of a machine."""
        ...

    def sleep_until(self, time: float) -> None:
        """Come back at a time [s], or a little later; at once if it is over."""
        ...


class WallClock:
    """That of the machine."""

    def now(self) -> float:
        """Time [s]."""
        return perf_counter()

    def sleep_until(self, time: float) -> None:
        """Come back at a time [s], or a little later."""
        left = time - perf_counter()
        if left > 0.0:
            sleep(left)


class SteppedClock:
    """One that stands until somebody waits: runs on it are the same every time."""

    def __init__(self) -> None:
        self._now = 0.0

    def now(self) -> float:
        """Time [s]."""
        return self._now

    def sleep_until(self, time: float) -> None:
        """Be there at once."""
        self._now = max(self._now, time)

    def work(self, time: float) -> None:
        """Something takes a time [s]."""
        self._now += time
