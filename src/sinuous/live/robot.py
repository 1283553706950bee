"""The robot's side: the controller, and the plant that stands in for the robot."""

from collections.abc import Callable

import numpy as np

from sinuous.arrays import Array
from sinuous.control.controller import ControllerState
from sinuous.control.report import Command, Status
from sinuous.live.board import Board, encoded
from sinuous.live.scenario import ticks_per_step
from sinuous.measurement import Measurement
from sinuous.plants.plant import NO_CONTACT, PlantFault
from sinuous.scenario import Scenario
from sinuous.session.lookout import Lookout
from sinuous.session.loop import is_finite, slack_cables, steps_per_sample
from sinuous.teleop.motion import NO_WALLS

PLANT_TICK = 0.005
"""A plant that is more than the robot's kinematics is stepped by no less than that [s], as far as
the controller's steps allow: physics that stops every millisecond takes twice as long or more."""

STATUSES = tuple(Status)


class RobotSide:
    """Controller and plant, one control step at a time, as `session.loop` has them.

    Arguments:
        scenario: what to do
        board: where samples and tips go
    """

    def __init__(self, scenario: Scenario, board: Board) -> None:
        self._scenario, self._board = scenario, board
        self._controller, self._plant = scenario.controller, scenario.new_plant()
        start = scenario.first_configuration
        self._state: ControllerState = self._controller.init(start)
        self._measured: Measurement | None = None
        assert scenario.teleop is not None
        self._tick, self._ticks = scenario.teleop.dt, ticks_per_step(scenario)
        wanted = 1 if scenario.plant is None else max(round(PLANT_TICK / self._tick), 1)
        self._held = max(n for n in range(1, wanted + 1) if self._ticks % n == 0)
        self._stride = steps_per_sample(self._controller.dt)
        self._steps = 0
        self._begin_sample()
        self._tip = scenario.robot.tip(start)
        board.tell_tips(self._tip[None], NO_WALLS)
        self._lookout = Lookout(scenario)

    def _begin_sample(self) -> None:
        self._before, self._contacts = self._state.c, NO_CONTACT
        self._clipped = self._longest = 0.0

    def step(self, target: Array, commanded: Callable[[], None]) -> Command:
        """One control step towards a target (3,) [m], and the plant's ticks until the next.

        Arguments:
            target: for the tip
            commanded: called when the command is there

        Raises:
            PlantFault: if the plant fails, or measures something that is not a finite number
        """
        self._state, command = self._controller.step(self._state, target, self._measured)
        commanded()
        walls = self._lookout.walls(self._state.c, target, command.report)
        held = self._held
        for _ in range(self._ticks // held):
            self._measured = measured = self._plant.step(command.rates, held * self._tick)
            # Until the plant has got there, the tip is where it was seen last.
            tips = np.tile(self._tip, (held, 1))
            tips[-1] = self._tip = measured.tip
            self._board.tell_tips(tips, walls)
        assert self._measured is not None
        self._contacts = self._contacts.worst(self._plant.truth.contacts)
        self._clipped = max(self._clipped, command.clipped)
        self._longest = max(self._longest, command.report.solve_time)
        self._steps += 1
        if not is_finite(self._measured, self._plant.truth):
            raise PlantFault("it measured something that is not a finite number")
        if self._steps % self._stride == 0:
            self._sample(target, command, self._measured)
            self._begin_sample()
        return command

    def _sample(self, target: Array, command: Command, measured: Measurement) -> None:
        robot, report, truth = self._scenario.robot, command.report, self._plant.truth
        known = command.tensions if len(command.tensions) else measured.tensions
        active = (*(one.name for one in report.active), *slack_cables(robot, known))
        ticks, walls = self._stride * self._ticks, report.walls
        self._board.samples.write(
            first_tick=(self._steps - self._stride) * self._ticks,
            ticks=ticks,
            time=self._steps * self._controller.dt,
            target=target,
            before=self._before,
            c=self._state.c,
            rates=command.rates,
            local=command.local if len(command.local) else 0.0,
            clipped=self._clipped,
            offset=command.offset,
            nominal=report.points,
            seen=len(measured.points),
            measured=measured.points if measured.has_shape else 0.0,
            measured_tip=measured.tip,
            measured_lengths=measured.lengths,
            actual=truth.points,
            actual_tip=truth.T_w_t[:3, 3],
            known=len(truth.tensions),
            tensions=np.resize(truth.tensions, len(command.rates)) if len(truth.tensions) else 0.0,
            contacts=np.array(self._contacts),
            pushed=0 if walls is None else walls.pushed,
            push=0.0 if walls is None else walls.body,
            status=STATUSES.index(report.status),
            solve_time=self._longest,
            iterations=report.iterations,
            planes=report.planes,
            step_fraction=report.step_fraction,
            active=encoded("\n".join(active)),
            reason=encoded(report.reason),
        )
