"""The processes of a session: started, watched, and ended whatever happens."""

import os
from collections.abc import Callable, Sequence
from multiprocessing import get_context
from multiprocessing.connection import Connection, wait
from multiprocessing.context import SpawnProcess
from typing import Any

from sinuous.live.board import Board
from sinuous.live.clock import Clock
from sinuous.live.layout import Sizes
from sinuous.live.orders import HandOrder
from sinuous.live.processes import (
    LeaderMaker,
    Seat,
    run_hand,
    run_idle,
    run_robot,
    run_together,
)
from sinuous.live.scenario import Recipe, ticks_per_step
from sinuous.scenario import Scenario

PATIENCE = 3.0  # for a process to end by itself [s]
HEAD_START = 0.05  # from when all are ready to the first tick [s]


class Crew:
    """Both loops at work on one board.

    Arguments:
        scenario: what they do, as it runs live
        recipe: by which they make their own
        leader: makes the device
        baseline: whether a loop that does nothing runs beside them
    """

    def __init__(
        self, scenario: Scenario, recipe: Recipe, leader: LeaderMaker, *, baseline: bool
    ) -> None:
        assert scenario.teleop is not None
        together = ticks_per_step(scenario) == 1  # refused before there is anything to give back
        sizes = Sizes.of(scenario)
        self.board = Board.create(sizes)
        self._processes = list[SpawnProcess]()
        self._asked = 0
        seat = Seat(
            recipe=recipe,
            leader=leader,
            sizes=sizes,
            board=self.board.name,
            parent=os.getpid(),
        )
        # A fresh interpreter has no thread and no lock of this one.
        context = get_context("spawn")
        orders, self._orders = context.Pipe(duplex=False)
        if together:
            self._start("both loops", run_together, (seat, orders))
        else:
            heard, kick = context.Pipe(duplex=False)
            self._start("the operator's side", run_hand, (seat, kick, orders))
            self._start("the robot's side", run_robot, (seat, heard))
            # Whoever loses the other end shall notice: only the two may hold them open.
            heard.close()
            kick.close()
        orders.close()
        if baseline:
            self._start("the idle loop", run_idle, (seat, scenario.teleop.dt))

    def _start(self, name: str, work: Callable[..., None], arguments: tuple[Any, ...]) -> None:
        process = get_context("spawn").Process(target=work, args=arguments, name=name, daemon=True)
        process.start()
        self._processes.append(process)

    def go(self, clock: Clock) -> None:
        """All are ready: the first tick is due in a moment."""
        self.board.put("go", clock.now() + HEAD_START)

    @property
    def pids(self) -> tuple[int, ...]:
        """Of the processes."""
        return tuple(one.pid for one in self._processes if one.pid is not None)

    def order(self, order: HandOrder) -> None:
        """Ask something of the operator's side."""
        try:
            self._orders.send(order)
        except OSError:
            return  # it is gone, which `fault` says
        self._asked += 1
        self.board.put("orders", self._asked)

    def wait(self, others: "Sequence[Connection[Any, Any]]", timeout: float) -> None:
        """Come back when a process ends, when there is something to read, or after a time [s]."""
        wait([*(one.sentinel for one in self._processes if one.is_alive()), *others], timeout)

    @property
    def fault(self) -> str:
        """Why it cannot go on; empty if all is well."""
        told = self.board.fault
        if told:
            return told
        gone = [one for one in self._processes if not one.is_alive()]
        return "; ".join(f"{one.name} ended with code {one.exitcode}" for one in gone)

    def end(self) -> None:
        """End all processes and give the memory back."""
        self.board.put("stop", 1)
        for process in self._processes:
            process.join(PATIENCE)
            if process.is_alive():
                process.kill()
                process.join()
            process.close()
        self._processes.clear()
        self._orders.close()
        self.board.close()
        self.board.unlink()
