"""What the processes of a session run; nothing in here is called by anybody else."""

import os
import traceback
from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from multiprocessing.connection import Connection, wait
from typing import Any

from sinuous.errors import InputError
from sinuous.leaders.leader import Leader
from sinuous.live.board import Board
from sinuous.live.clock import WallClock
from sinuous.live.hand import HandSide
from sinuous.live.layout import Part, Sizes, Timed
from sinuous.live.loops import HandLoop, RobotLoop
from sinuous.live.machine import (
    HAND_PRIORITY,
    ROBOT_PRIORITY,
    keep_still,
    leave_ctrl_c_to_the_parent,
    prefer,
)
from sinuous.live.pace import Pace
from sinuous.live.path_hand import PathHand
from sinuous.live.robot import RobotSide
from sinuous.live.scenario import Recipe, ticks_per_step
from sinuous.plants.plant import PlantFault
from sinuous.scenario import Scenario
from sinuous.session.runner import warm_up

LeaderMaker = Callable[[Scenario], Leader]
"""Makes the device, in the process that reads it."""

MOMENT = 0.05  # how long a loop waits before it looks whether it is still wanted [s]
KICK = b"."


@dataclass(frozen=True, kw_only=True)
class Seat:
    """What a process has to know.

    Arguments:
        recipe: of the scenario
        leader: makes the device
        sizes: of what is on the board
        board: its name
        parent: the process that must be alive
    """

    recipe: Recipe
    leader: LeaderMaker
    sizes: Sizes
    board: str
    parent: int

    @property
    def orphaned(self) -> bool:
        """Whether the parent is gone."""
        return os.getppid() != self.parent


def run_hand(seat: Seat, kick: "Connection[Any, Any]", orders: "Connection[Any, Any]") -> None:
    """The fast loop."""
    _guarded(seat, Part.HAND, lambda board: _hand(seat, board, kick, orders))


def run_robot(seat: Seat, kick: "Connection[Any, Any]") -> None:
    """The controller's loop."""
    _guarded(seat, Part.ROBOT, lambda board: _robot(seat, board, kick))


def run_together(seat: Seat, orders: "Connection[Any, Any]") -> None:
    """Both in one, for a controller as fast as the operator's side."""
    _guarded(seat, Part.HAND, lambda board: _together(seat, board, orders))


def run_idle(seat: Seat, dt: float) -> None:
    """A loop beside them that does nothing but being late: what this machine can do just now."""
    leave_ctrl_c_to_the_parent()
    board = Board.attach(seat.sizes, seat.board)
    prefer(HAND_PRIORITY)
    keep_still()
    _wait_for_go(seat, board)
    pace, late = Pace(WallClock(), dt), board.times[Timed.IDLE]
    pace.start(board.get("go"))
    while _wanted(seat, board):
        for _ in range(round(MOMENT / dt)):
            late.add(pace.wait()[1])


def _guarded(seat: Seat, part: Part, work: Callable[[Board], None]) -> None:
    """Do the work of a part; whatever stops it is told on the board."""
    leave_ctrl_c_to_the_parent()
    board = Board.attach(seat.sizes, seat.board)
    try:
        work(board)
    except (InputError, PlantFault) as error:
        board.fail(part, f"{_NAMES[part]}: {error}")
    except BrokenPipeError:
        pass  # the other side is gone, and its process says why
    except Exception as error:
        traceback.print_exc()
        board.fail(part, f"{_NAMES[part]}: {type(error).__name__}: {error}")
    finally:
        board.close()


_NAMES = {Part.HAND: "the operator's side", Part.ROBOT: "the robot's side"}


def _hand(
    seat: Seat, board: Board, kick: "Connection[Any, Any]", orders: "Connection[Any, Any]"
) -> None:
    scenario = seat.recipe.make()
    with seat.leader(scenario) as leader:
        loop = _hand_loop(scenario, leader, board, orders)
        # A full pipe is a robot's side that is late already: it needs no further kick.
        os.set_blocking(kick.fileno(), False)
        _prepare(seat, board, Part.HAND, HAND_PRIORITY)
        loop.pace.start(board.get("go"))
        turns = 0
        while turns % 64 or _wanted(seat, board):
            turns += 1
            if loop.turn():
                with suppress(BlockingIOError):
                    os.write(kick.fileno(), KICK)


def _robot(seat: Seat, board: Board, kick: "Connection[Any, Any]") -> None:
    scenario = seat.recipe.make()
    loop = _robot_loop(scenario, board)
    warm_up(scenario)
    _prepare(seat, board, Part.ROBOT, ROBOT_PRIORITY)
    while _wanted(seat, board):
        if wait([kick], timeout=MOMENT) and not os.read(kick.fileno(), 4096):
            return  # the operator's side is gone
        while loop.is_due and not board.get("stop"):
            loop.turn()


def _together(seat: Seat, board: Board, orders: "Connection[Any, Any]") -> None:
    scenario = seat.recipe.make()
    with seat.leader(scenario) as leader:
        hand, robot = _hand_loop(scenario, leader, board, orders), _robot_loop(scenario, board)
        warm_up(scenario)
        board.ready(Part.ROBOT)
        _prepare(seat, board, Part.HAND, HAND_PRIORITY)
        hand.pace.start(board.get("go"))
        turns = 0
        while turns % 64 or _wanted(seat, board):
            turns += 1
            if hand.turn():
                robot.turn()


def _hand_loop(
    scenario: Scenario, leader: Leader, board: Board, orders: "Connection[Any, Any]"
) -> HandLoop:
    assert scenario.teleop is not None
    tip = scenario.robot.tip(scenario.first_configuration)
    side = HandSide(scenario.teleop, tip, leader)
    HandSide(scenario.teleop, tip, PathHand(scenario)).tick(tip)  # loads what is compiled
    return HandLoop(
        side,
        board,
        WallClock(),
        dt=scenario.teleop.dt,
        per_step=ticks_per_step(scenario),
        orders=orders,
    )


def _robot_loop(scenario: Scenario, board: Board) -> RobotLoop:
    return RobotLoop(
        RobotSide(scenario, board),
        board,
        WallClock(),
        dt=scenario.controller.dt,
        per_step=ticks_per_step(scenario),
    )


def _prepare(seat: Seat, board: Board, part: Part, priority: int) -> None:
    """Be ready, and come back when all are."""
    keep_still()
    board.ready(part)
    _wait_for_go(seat, board)
    prefer(priority)


def _wait_for_go(seat: Seat, board: Board) -> None:
    clock = WallClock()
    while not board.get("go") and _wanted(seat, board):
        clock.sleep_until(clock.now() + 0.002)


def _wanted(seat: Seat, board: Board) -> bool:
    return not board.get("stop") and not seat.orphaned
