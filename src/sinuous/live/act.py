"""One life of both loops, from their start to their end or to a reset."""

from collections.abc import Callable
from contextlib import suppress
from os import getpid
from typing import Any

from sinuous.errors import InputError
from sinuous.live.clock import Clock
from sinuous.live.crew import Crew
from sinuous.live.machine import load_average
from sinuous.live.memory import Memory
from sinuous.live.processes import LeaderMaker
from sinuous.live.report import loop_numbers, watch_numbers
from sinuous.live.scenario import Recipe, ticks_per_step
from sinuous.live.snapshot import Looker, Snapshot
from sinuous.live.times import Times
from sinuous.live.watch import Watch
from sinuous.recording import Recorder
from sinuous.scenario import Scenario
from sinuous.scenario.start import check_start
from sinuous.session.folder import RECORDING, RunFolder
from sinuous.session.header import make_header

FRAME = 1.0 / 30.0  # between two snapshots [s]
SECOND = 1.0  # between two looks at the memory [s]
TURN = 0.005  # longest wait for anything to happen [s]
MOMENT = 0.05  # the same before the first tick [s]


def checked(recipe: Recipe) -> Scenario:
    """The scenario of a recipe, if it can run live from where its robot stands.

    Raises:
        InputError: if it cannot be used, or the robot may not start where it stands
    """
    scenario = recipe.make()
    check_start(scenario)
    ticks_per_step(scenario)
    return scenario


class Act:
    """Loops at work, and what is done beside them in this process.

    Arguments:
        recipe: of the scenario
        leader: makes the device
        clock: of the machine
        baseline: whether a loop that does nothing runs beside them
        observe: called with a snapshot 30 times a second

    Raises:
        InputError: if the scenario cannot be used, or the robot may not start where it stands
    """

    def __init__(
        self,
        recipe: Recipe,
        leader: LeaderMaker,
        clock: Clock,
        *,
        baseline: bool,
        observe: Callable[[Snapshot], None],
    ) -> None:
        self.scenario = checked(recipe)
        self._clock, self._observe = clock, observe
        self.crew = Crew(self.scenario, recipe, leader, baseline=baseline)
        self._board = self.crew.board
        self._watch = Watch(self.scenario, self._board)
        self._looker = Looker(self.scenario, self._board)
        self._memory = Memory((*self.crew.pids, getpid()))
        self._frames = Times.new()
        self._frame_due = self._second = 0.0

    def get_ready(self) -> str:
        """Wait for both loops and let them begin; why they cannot, empty if all is well."""
        while not self._board.all_ready:
            fault = self.crew.fault
            if fault:
                return fault
            self.crew.wait((), MOMENT)
        self.crew.go(self._clock)
        self._frame_due = self._second = self._board.get("go")
        return ""

    @property
    def time(self) -> float:
        """Since the first tick was due, by the clock [s]; zero before."""
        go = self._board.get("go")
        return max(self._clock.now() - go, 0.0) if go else 0.0

    def turn(self) -> None:
        """Judge and record a sample, if there is one; show how things are, if it is time.

        Raises:
            InputError: if the recording cannot be written
        """
        self._watch.catch_up(1)
        now = self._clock.now()
        if now >= self._frame_due:
            self._frames.add(now - self._frame_due)
            snapshot = self._looker.look(now)
            if snapshot is not None:
                self._observe(snapshot)
            self._frame_due = max(self._frame_due + FRAME, now)
        if now >= self._second:
            self._memory.look(self.time)
            self._second = max(self._second + SECOND, now)

    @property
    def leisure(self) -> float:
        """How long there is nothing to do, at most [s]."""
        if self._watch.is_behind:
            return 0.0
        return min(max(self._frame_due - self._clock.now(), 0.0), TURN)

    def record(self, folder: str | None) -> None:
        """Record into a folder from now on, or no longer.

        Raises:
            InputError: if it cannot be written
        """
        recorder, self._watch.recorder = self._watch.recorder, None
        if recorder is not None:
            recorder.close()
        if folder is not None:
            path = RunFolder.prepare(folder).path / RECORDING
            self._watch.recorder = Recorder(path, make_header(self.scenario))

    def stop_recording(self) -> None:
        """Record no longer, whether or not the end can still be written."""
        with suppress(InputError):
            self.record(None)

    def numbers(self) -> dict[str, Any]:
        """How it went so far."""
        return {
            **loop_numbers(self.scenario, self._board, self.time),
            "frame_lateness_s": self._frames.quantiles._asdict(),
            **watch_numbers(self._watch),
            "memory_growth_bytes": self._memory.growth,
            "load_average": load_average(),
        }

    def close(self) -> None:
        """End everything."""
        try:
            self.crew.end()
        finally:
            self.stop_recording()
