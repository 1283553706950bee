"""From what a controller reports to the walls that an operator may feel."""

from sinuous.arrays import Array
from sinuous.control.report import Report
from sinuous.control.wall_force import closeness
from sinuous.scenario import Scenario
from sinuous.teleop.motion import NO_WALLS, Plane, Walls


class Lookout:
    """Looks as far as the scenario's virtual force asks for it, for that takes time.

    Arguments:
        scenario: what is done
    """

    def __init__(self, scenario: Scenario) -> None:
        force = None if scenario.teleop is None else scenario.teleop.table.force
        self._constraints = force is not None and force.constraints
        self._reach = 0.0 if force is None else force.nearness
        self._distance = scenario.robot.required_distance(scenario.mpc.margin)
        self._held = NO_WALLS.held
        self._has_walls = len(scenario.zone.surfaces) > 0

    def walls(self, c: Array, target: Array, report: Report) -> Walls:
        """What is known after a step; one that has found no plan has nothing new to say.

        Arguments:
            c: configuration of the model (n,)
            target: of the tip (3,) [m]
            report: of the step
        """
        near = NO_WALLS.near
        if self._constraints and report.walls is not None and report.workload.qps > 0:
            way = report.walls.way
            self._held = Plane(target + way, way)
        if self._reach > 0.0 and self._has_walls:
            way = closeness(report.robot, report.zone, c, self._distance, self._reach)
            near = Plane(report.points[-1] + way, way)
        return Walls(self._held, near)
