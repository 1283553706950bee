"""A hand that follows the path of the scenario, all by itself and over and over again."""

from bisect import bisect_right
from itertools import accumulate

import numpy as np

from sinuous.arrays import Array
from sinuous.leaders.leader import About, ForceKind, Hand, Leader
from sinuous.scenario import Scenario


class PathHand(Leader):
    """Goes along the legs of the path, each for as long as it may last; then back to the first.

    Arguments:
        scenario: whose path it is, with an operator
    """

    about = About(
        name="the scenario's path",
        axes="as the path has them",
        force=ForceKind.NONE,
        run_on_hardware=None,
    )

    def __init__(self, scenario: Scenario) -> None:
        assert scenario.teleop is not None
        dt, self._mapping = scenario.controller.dt, scenario.teleop.mapping
        self._legs = scenario.path
        self._ends = list(accumulate(leg.steps(dt) * dt for leg in self._legs))
        self._axes = hand_axes(len(scenario.teleop.axes))
        tip = scenario.robot.tip(scenario.first_configuration)
        self._zero = self._mapping.project(tip) / self._mapping.scale

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        time %= self._ends[-1]
        leg = bisect_right(self._ends, time)
        began = self._ends[leg - 1] if leg else 0.0
        place = self._mapping.project(self._legs[leg].at(time - began)) / self._mapping.scale
        position: Array = np.zeros(3)
        position[self._axes] = place - self._zero
        return Hand(position, held=True, connected=True, age=0.0)


def hand_axes(axes: int) -> list[int]:
    """Which axes of the hand, x, y and z, drive the axes of the wave side: x and z of a plane."""
    return [0, 1, 2] if axes == 3 else [0, 2]
