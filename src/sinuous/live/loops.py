"""The two loops of a session, turn by turn; who calls them, and where, is another matter."""

from collections.abc import Callable
from typing import NamedTuple, Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.control.report import Status
from sinuous.live.board import Board
from sinuous.live.clock import Clock
from sinuous.live.hand import HandSide
from sinuous.live.layout import Timed
from sinuous.live.orders import HandOrder
from sinuous.live.pace import Pace
from sinuous.live.robot import RobotSide

LATE_STEPS = 5
"""Steps of the controller by which the operator's side may be ahead of the robot's: then simulated
time stands until the robot's side has come closer."""


class Inbox(Protocol):
    """Where orders come from."""

    def poll(self) -> bool:
        """Whether there is one."""
        ...

    def recv(self) -> HandOrder:
        """The next one."""
        ...


class HandLoop:
    """The fast loop: in every tick it reads the hand, and nothing may hold it up.

    Arguments:
        side: what it does
        board: where it tells
        clock: to pace by
        dt: time of a tick [s]
        per_step: ticks in a step of the controller
        orders: what is asked, which is looked at when the board says that there is something
    """

    def __init__(
        self,
        side: HandSide,
        board: Board,
        clock: Clock,
        *,
        dt: float,
        per_step: int,
        orders: Inbox | None = None,
    ) -> None:
        self._side, self._board, self._clock, self._orders = side, board, clock, orders
        self._dt, self._per_step = dt, per_step
        self.pace = Pace(clock, dt)
        self._late, self._work = board.times[Timed.TICK], board.times[Timed.WORK]
        self._tips, self._asked = board.cell("tips"), board.cell("orders")
        self._obeyed = 0

    def turn(self) -> bool:
        """Wait for the next tick and do it; whether the controller shall begin a step."""
        due, late = self.pace.wait()
        self._late.add(late)
        if self._obeyed < self._asked[0]:
            self._obey()
        board, ticks, tips = self._board, self._board.ticks.written, int(self._tips[0]) - 1
        if ticks - tips > LATE_STEPS * self._per_step:
            self.pace.stand()
            self._side.rest()
            board.put("late", 1)
            board.put("slipped", self.pace.slipped)
            return False
        began = self._clock.now()
        self._tick(min(ticks, tips), due, began)
        self._work.add(self._clock.now() - began)
        return ticks % self._per_step == 0

    def _tick(self, tips: int, due: float, began: float) -> None:
        side, board = self._side, self._board
        tick = side.tick(board.tip(tips), board.walls(tips))
        board.ticks.write(
            due=due,
            began=began,
            target=tick.target,
            hand=tick.hand.position,
            felt=tick.felt,
            stiffness=tick.stiffness,
            share=tick.share,
            held=tick.hand.held,
            connected=tick.hand.connected,
            paused=side.paused,
            signals=tick.signals,
        )
        board.put("late", 0)
        board.put("slipped", self.pace.slipped)
        board.put("least_j", side.least)

    def _obey(self) -> None:
        orders = self._orders
        while orders is not None and orders.poll():
            self._side.obey(orders.recv())
            self._obeyed += 1


class _Message(NamedTuple):
    """The newest tick of the operator's side.

    Arguments:
        target: for the tip (3,) [m]
        due: when the tick was that the step belongs to [s]
        oldest: arrival of the oldest message that no step has known of [s]
    """

    target: Array
    due: float
    oldest: float


class RobotLoop:
    """The controller's loop: a step whenever enough ticks have gone by.

    Arguments:
        side: what it does
        board: where it reads and tells
        clock: to judge lateness by
        dt: time of a step [s]
        per_step: ticks in it
    """

    def __init__(
        self, side: RobotSide, board: Board, clock: Clock, *, dt: float, per_step: int
    ) -> None:
        self._side, self._board, self._clock = side, board, clock
        self._dt, self._per_step = dt, per_step
        self._steps = self._known = 0
        self._began_late = board.times[Timed.STEP]
        self._solve, self._command = board.times[Timed.SOLVE], board.times[Timed.COMMAND]
        self._arrived = board.times[Timed.MESSAGE]

    @property
    def is_due(self) -> bool:
        """Whether a step is to be taken."""
        return self._board.ticks.written > self._steps * self._per_step

    def turn(self) -> None:
        """Take a step towards the newest target.

        Raises:
            PlantFault: if the plant cannot go on
        """
        message = self._newest()
        self._began_late.add(self._clock.now() - message.due)
        command = self._side.step(message.target, self._judged(message))
        self._solve.add(command.report.solve_time)
        self._steps += 1
        board = self._board
        board.put("steps", self._steps)
        if command.report.status is Status.HOLDING:
            board.put("holding", board.get("holding") + 1)

    def _judged(self, message: _Message) -> Callable[[], None]:
        """What to do when the command is there: see how late it is."""

        def commanded() -> None:
            now = self._clock.now()
            self._command.add(now - message.due)
            self._arrived.add(now - message.oldest)
            if now - message.due > self._dt:
                self._board.put("misses", self._board.get("misses") + 1)

        return commanded

    def _newest(self) -> _Message:
        ticks = self._board.ticks
        newest, row = ticks.written - 1, None
        while row is None:  # at once, but for a writer that goes round the ring meanwhile
            newest = ticks.written - 1
            row = ticks.read(newest)
        first = max(self._known, newest + 1 - ticks.capacity // 2)
        began = ticks.block(first, 1, "began")
        due = ticks.block(self._steps * self._per_step, 1, "due")
        self._known = newest + 1
        return _Message(
            target=np.array(row["target"]),
            due=float(row["due"] if due is None else due[0]),
            oldest=float(row["began"] if began is None else began[0]),
        )
