"""A live session: what starts the loops, watches them, passes orders on and tells how it went."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Event
from typing import Any

from sinuous.live.act import Act
from sinuous.live.clock import Clock, WallClock
from sinuous.live.orders import Order, Record, Reset, Stop
from sinuous.live.processes import LeaderMaker
from sinuous.live.scenario import Recipe
from sinuous.live.snapshot import Snapshot
from sinuous.scenario import Scenario
from sinuous.session.runner import interruptible


class LiveEnd(Enum):
    """How a live session ended."""

    FINISHED = "finished: its time is over"
    STOPPED = "stopped, as asked"
    INTERRUPTED = "interrupted"
    FAILED = "failed: the robot holds still"


@dataclass(frozen=True, kw_only=True, eq=False)
class LiveResult:
    """A live session that is over.

    Arguments:
        numbers: what `report` says about it, ready for JSON
        end: how it ended
        fault: why it failed; empty if it did not
    """

    numbers: dict[str, Any]
    end: LiveEnd
    fault: str = ""


def _nothing(*_: object) -> None:
    pass


class LiveSession:
    """Runs a scenario in real time.

    Arguments:
        recipe: of the scenario
        leader: makes the device in the process that reads it; must be picklable
        baseline: whether a loop that does nothing is measured beside the others
        patient: whether a fault waits for an order to reset instead of ending the session
        started: called with the scenario before the first tick, and after a reset
        observe: called with a snapshot 30 times a second; it holds up judging and recording only
        failed: called with what went wrong
        clock: of the machine
    """

    def __init__(
        self,
        recipe: Recipe,
        leader: LeaderMaker,
        *,
        baseline: bool = False,
        patient: bool = False,
        started: Callable[[Scenario], None] = _nothing,
        observe: Callable[[Snapshot], None] = _nothing,
        failed: Callable[[str], None] = _nothing,
        clock: Clock | None = None,
    ) -> None:
        self._recipe, self._leader, self._baseline = recipe, leader, baseline
        self._patient = patient
        self._started, self._observe, self._failed = started, observe, failed
        self._clock = clock or WallClock()
        self._asked = SimpleQueue[Order]()
        self._senders = list["Connection[Any, Any]"]()
        self._folder: str | None = None

    def order(self, order: Order) -> None:
        """Ask for something, from any thread."""
        self._asked.put(order)

    def listen(self, sender: "Connection[Any, Any]") -> None:
        """Take orders from another process, such as a view's, as long as it lives."""
        self._senders.append(sender)

    def run(self, duration: float | None = None, *, record: str | None = None) -> LiveResult:
        """Run until a time [s] of the clock is over, someone asks to stop, or Ctrl-C.

        Arguments:
            duration: None for no end
            record: folder for a recording from the start; None for none

        Raises:
            InputError: if scenario or folder cannot be used
        """
        self._folder = record
        while True:
            then = self._act(duration)
            if isinstance(then, LiveResult):
                return then
            file, changed = then.scenario, (*self._recipe.set, *then.set)
            # Fields of one scenario mean nothing to another one.
            self._recipe = (
                Recipe(self._recipe.file, changed) if file is None else Recipe(file, then.set)
            )

    def _act(self, duration: float | None) -> LiveResult | Reset:
        """From the first tick until the end, or until everything is to begin again."""
        act = Act(
            self._recipe, self._leader, self._clock, baseline=self._baseline, observe=self._observe
        )
        try:
            act.record(self._folder)
            fault = act.get_ready()
            if not fault:
                self._started(act.scenario)
            with interruptible() as interrupted:
                return self._play(act, duration, fault, interrupted)
        except KeyboardInterrupt:
            return LiveResult(numbers=act.numbers(), end=LiveEnd.INTERRUPTED)
        finally:
            act.close()

    def _play(
        self, act: Act, duration: float | None, fault: str, interrupted: Event
    ) -> LiveResult | Reset:
        told = False
        while True:
            if interrupted.is_set():
                return LiveResult(numbers=act.numbers(), end=LiveEnd.INTERRUPTED)
            fault = fault or act.crew.fault
            if fault and not told:
                self._failed(fault)
                told = True
            if fault and not self._patient:
                return LiveResult(numbers=act.numbers(), end=LiveEnd.FAILED, fault=fault)
            if duration is not None and act.time >= duration:
                end = LiveEnd.FAILED if fault else LiveEnd.FINISHED
                return LiveResult(numbers=act.numbers(), end=end, fault=fault)
            act.crew.wait(self._senders, act.leisure)
            for order in self._orders():
                match order:
                    case Stop():
                        return LiveResult(numbers=act.numbers(), end=LiveEnd.STOPPED)
                    case Reset():
                        return order
                    case Record(folder):
                        self._folder = folder
                        act.record(folder)
                    case _:
                        act.crew.order(order)
            if not fault:
                act.turn()

    def _orders(self) -> list[Order]:
        """What was asked since the last time."""
        orders = list[Order]()
        with suppress(Empty):
            while True:
                orders.append(self._asked.get_nowait())
        for sender in tuple(self._senders):
            try:
                while sender.poll():
                    orders.append(sender.recv())
            except (EOFError, OSError):  # the view is gone; another one may come
                self._senders.remove(sender)
        return orders
