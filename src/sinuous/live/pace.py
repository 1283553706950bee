"""When the next tick is due, and what happens if it cannot be kept."""

from sinuous.live.clock import Clock

SLACK = 0.01
"""Ticks that are late by no more than that are caught up with [s]; what is lost beyond is lost."""


class Pace:
    """Spaces the ticks of simulated time on a clock.

    A tick that is late is made up for by the next ones, which follow at once, as long as it is late
    by `SLACK` at most. Beyond that the schedule moves: simulated time is slower than the clock, and
    `slipped` says by how much. So a short hiccup costs nothing, and overload is neither hidden nor
    answered by a burst of ticks.

    Arguments:
        clock: to pace by
        dt: time of a tick [s]
        slack: see above [s]
    """

    def __init__(self, clock: Clock, dt: float, *, slack: float = SLACK) -> None:
        self._clock, self._dt, self._slack = clock, dt, slack
        self.began = self.due = clock.now()
        self.slipped = 0.0

    def start(self, time: float) -> None:
        """The first tick is due at a time [s]."""
        self.began = self.due = time
        self.slipped = 0.0

    def wait(self) -> tuple[float, float]:
        """Wait for the next tick: when it was due [s], and how late it is [s]."""
        self._clock.sleep_until(self.due)
        due = self.due
        late = self._clock.now() - due
        self.due += self._dt
        if late > self._slack:
            self.due += late
            self.slipped += late
        return due, late

    def stand(self) -> None:
        """The tick that was waited for does not happen: simulated time stands."""
        self.slipped += self._dt
