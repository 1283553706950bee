"""A live session: what starts the loops, watches them, passes orders on and tells how it went."""

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from enum import Enum
from multiprocessing.connection import Connection
from queue import Empty, SimpleQueue
from threading import Event
from typing import Any

from sinuous.errors import InputError
from sinuous.live.act import Act, checked
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


def following(folder: str | None) -> str | None:
    """Where a recording goes on after a reset, so that what there is stays: "run", "run-2" ..."""
    if folder is None:
        return None
    stem, dash, number = folder.rpartition("-")
    if dash and number.isdecimal() and len(number) < 4:  # a longer one is a date or time
        return f"{stem}-{int(number) + 1}"
    return f"{folder}-2"


class LiveSession:
    """Runs a scenario in real time.

    Arguments:
        recipe: of the scenario
        leader: makes the device in the process that reads it; must be picklable
        baseline: whether a loop that does nothing is measured beside the others
        patient: whether a fault waits for an order to reset instead of ending the session
        started: called with the scenario and its recipe before the first tick, and after a reset
        observe: called with a snapshot 30 times a second; it holds up judging and recording only
        failed: called with what went wrong
        recording: called with the folder of a recording that begins, None when one is over
        refused: called with why an order is not followed, or recording has ended; None if a
            recording that fails shall end the session
        clock: of the machine
    """

    def __init__(
        self,
        recipe: Recipe,
        leader: LeaderMaker,
        *,
        baseline: bool = False,
        patient: bool = False,
        started: Callable[[Scenario, Recipe], None] = _nothing,
        observe: Callable[[Snapshot], None] = _nothing,
        failed: Callable[[str], None] = _nothing,
        recording: Callable[[str | None], None] = _nothing,
        refused: Callable[[str], None] | None = None,
        clock: Clock | None = None,
    ) -> None:
        self._recipe, self._leader, self._baseline = recipe, leader, baseline
        self._patient = patient
        self._started, self._observe, self._failed = started, observe, failed
        self._recording, self._refused = recording, refused
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
            record: folder for a recording from the start; None for none. After a reset, it goes on
                in another one, see `following`

        Raises:
            InputError: if scenario or folder cannot be used
        """
        self._folder = record
        while True:
            then = self._act(duration)
            if isinstance(then, LiveResult):
                return then
            self._recipe, self._folder = self._changed(then), following(self._folder)
            self._leader = then.leader or self._leader

    def _act(self, duration: float | None) -> LiveResult | Reset:
        """From the first tick until the end, or until everything is to begin again."""
        act = Act(
            self._recipe, self._leader, self._clock, baseline=self._baseline, observe=self._observe
        )
        try:
            self._record(act, self._folder)
            fault = act.get_ready()
            if not fault:
                self._started(act.scenario, self._recipe)
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
                        if self._is_possible(order):
                            return order
                    case Record(folder):
                        self._record(act, folder)
                    case _:
                        act.crew.order(order)
            if not fault:
                self._turn(act)

    def _changed(self, order: Reset) -> Recipe:
        """The recipe after a reset; fields of one scenario mean nothing to another one."""
        if order.scenario is not None:
            return Recipe(order.scenario, order.set)
        return Recipe(self._recipe.file, (*self._recipe.set, *order.set))

    def _is_possible(self, order: Reset) -> bool:
        """Whether what a reset asks for can be used; if not, that is told, and nothing changes."""
        if self._refused is None:
            return True
        try:
            checked(self._changed(order))
        except InputError as error:
            self._refused(str(error))
            return False
        return True

    def _record(self, act: Act, folder: str | None) -> None:
        try:
            self._folder = folder
            act.record(folder)
        except InputError as error:
            self._give_up_recording(act, error)
        else:
            self._recording(folder)

    def _turn(self, act: Act) -> None:
        try:
            act.turn()
        except InputError as error:
            self._give_up_recording(act, error)

    def _give_up_recording(self, act: Act, error: InputError) -> None:
        """A recording that cannot be written, say on a full disk, ends; the robot need not."""
        if self._refused is None:
            raise error
        self._folder = None
        act.stop_recording()
        self._recording(None)
        self._refused(f"recording has ended: {error}")

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
