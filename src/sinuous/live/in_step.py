"""Both loops in one process, tick by tick: on a stepped clock, every run is the same."""

from collections.abc import Iterator

from sinuous.leaders.leader import Leader
from sinuous.live.board import Board
from sinuous.live.clock import Clock
from sinuous.live.hand import HandSide
from sinuous.live.layout import Sizes
from sinuous.live.loops import HandLoop, Inbox, RobotLoop
from sinuous.live.robot import RobotSide
from sinuous.live.scenario import ticks_per_step
from sinuous.scenario import Scenario


class InStep:
    """A session without processes of its own.

    Arguments:
        scenario: what to do, as it runs live
        leader: the device
        clock: to pace by
        orders: what is asked; None for nothing
    """

    def __init__(
        self, scenario: Scenario, leader: Leader, clock: Clock, *, orders: Inbox | None = None
    ) -> None:
        assert scenario.teleop is not None
        dt, per_step = scenario.teleop.dt, ticks_per_step(scenario)
        tip = scenario.robot.tip(scenario.first_configuration)
        self.board = Board.alone(Sizes.of(scenario))
        self.hand = HandLoop(
            HandSide(scenario.teleop, tip, leader),
            self.board,
            clock,
            dt=dt,
            per_step=per_step,
            orders=orders,
        )
        self.robot = RobotLoop(
            RobotSide(scenario, self.board),
            self.board,
            clock,
            dt=scenario.controller.dt,
            per_step=per_step,
        )
        self.hand.pace.start(clock.now())

    def ticks(self) -> Iterator[int]:
        """One tick after the other, without end: how many have been done."""
        while True:
            if self.hand.turn():
                self.robot.turn()
            yield self.board.ticks.written
