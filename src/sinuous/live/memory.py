"""Whether the memory of some processes grows."""

from sinuous.live.machine import own_memory

SETTLED = 5.0  # time after the first tick at which everything has been done once [s]


class Memory:
    """Notes what processes need, once they have settled.

    Arguments:
        pids: of the processes
    """

    def __init__(self, pids: tuple[int, ...]) -> None:
        self._pids = pids
        self._first: int | None = None
        self.growth: int | None = None

    def look(self, time: float) -> None:
        """Note it, at a time since the first tick [s]."""
        each = [own_memory(pid) for pid in self._pids]
        if time < SETTLED or None in each:
            return
        now = sum(size for size in each if size is not None)
        if self._first is None:
            self._first = now
        self.growth = now - self._first
