"""From what a controller reports to the walls that an operator may feel."""

import numpy as np

from sinuous.arrays import Array
from sinuous.control.report import Report
from sinuous.control.wall_force import NOWHERE, closeness
from sinuous.scenario import Scenario
from sinuous.teleop.motion import NO_WALLS, Plane, Walls

SETTLING = 0.05
"""Time in which what is known of walls settles [s]. Where the robot is at a limit of speed, the
multipliers of the walls that it slides along change from step to step."""

NEGLIGIBLE = 1e-6  # a way that is no wall any longer [m]


def settled(before: Plane, way: Array, target: Array, share: float) -> Plane:
    """The plane a step later: the one before, and a share of what it lacks of what is known now.

    A wall that stays where it is is pushed further, and let go of, without any lag: what the plane
    before says of the new target is right already. It never says that there is more of a wall than
    both the controller knows and there was.

    Arguments:
        before: a step ago
        way: what is known now (3,) [m]
        target: of the tip now (3,) [m]
        share: of what the plane before lacks, 0 to 1
    """
    size = float(np.linalg.norm(before.way))
    expected = before.way
    if size > 0.0:
        n = before.way / size
        most = max(size, float(np.linalg.norm(way)))
        expected = min(max(float(n @ (before.place - target)), 0.0), most) * n
    now = expected + share * (way - expected)
    if float(np.linalg.norm(now)) < NEGLIGIBLE:
        return Plane()
    return Plane(np.asarray(target + now), now)


class Lookout:
    """Looks as far as the scenario's virtual force asks for it, for that takes time.

    Arguments:
        scenario: what is done
    """

    def __init__(self, scenario: Scenario) -> None:
        force = None if scenario.teleop is None else scenario.teleop.table.force
        self._constraints = force is not None and force.constraints
        self._reach = 0.0 if force is None else force.nearness
        self._share = scenario.controller.dt / (SETTLING + scenario.controller.dt)
        self._walls = NO_WALLS
        self._distance = scenario.robot.required_distance(scenario.mpc.margin)
        self._has_walls = len(scenario.zone.surfaces) > 0

    def walls(self, c: Array, target: Array, report: Report) -> Walls:
        """What is known after a step.

        Arguments:
            c: configuration of the model (n,)
            target: of the tip (3,) [m]
            report: of the step
        """
        held, near = self._walls
        if self._constraints:
            way = NOWHERE if report.walls is None else report.walls.way
            held = settled(held, way, target, self._share)
        if self._reach > 0.0 and self._has_walls:
            way = closeness(report.robot, report.zone, c, self._distance, self._reach)
            near = settled(near, way, report.points[-1], self._share)
        self._walls = Walls(held, near)
        return self._walls
