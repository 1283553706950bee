"""Plants of a scenario that are more than the robot's kinematics: how they are made."""

from collections.abc import Callable
from dataclasses import dataclass

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.calibrated import CalibratedPlant
from sinuous.plants.compensated import CompensatedPlant
from sinuous.plants.physics.plant import PhysicsPlant
from sinuous.plants.physics.walls import Walls
from sinuous.plants.plant import Plant
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot import Robot
from sinuous.scenario.plant_tables import CalibratedTable, PhysicsTable, PlantTable


@dataclass(frozen=True, kw_only=True, eq=False)
class Physics:
    """Makes `PhysicsPlant`s.

    Arguments:
        table: what acts on the robot
        robot: with its base where it stands
        zone: whose walls push back, if they do
        start: configuration (n,) to start from
    """

    table: PhysicsTable
    robot: Robot
    zone: SafeZone
    start: Array

    def __call__(self) -> PhysicsPlant:
        """A plant at its start.

        Raises:
            InputError: if physics is not installed, or cannot hold the robot
        """
        table, zone = self.table, self.zone
        return PhysicsPlant(
            self.robot,
            gravity=table.gravity,
            walls=Walls(zone=zone) if table.walls and zone.surfaces else None,
            payload=table.payload,
            tip_force=table.tip_force,
            start=self.start,
            tick=table.tick,
            tension_sensors=table.tension_sensors,
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class Calibrated:
    """Makes `CalibratedPlant`s.

    Arguments:
        table: whether the motors make up for the cables' stretch
        robot: whose file has a `[fitted]` table
        start: configuration (n,) to start from
    """

    table: CalibratedTable
    robot: PccRobot
    start: Array

    def __call__(self) -> Plant:
        """A plant at its start."""
        robot, fitted = self.robot, self.robot.fitted
        if not self.table.compensated or fitted is None:
            return CalibratedPlant(robot, start=robot.lengths(self.start))
        straight = robot.lengths(0.0 * self.start)
        motors = straight - fitted.model.pulls(self.start)
        plant = CalibratedPlant(robot, start=motors)
        return CompensatedPlant(plant, robot=robot, model=fitted.model, start=self.start)


def plant_of(
    table: PlantTable, robot: Robot, zone: SafeZone, start: Array
) -> Callable[[], Plant] | None:
    """What makes the plant of a table, None for one by the robot's own kinematics.

    Raises:
        ValueError: if a calibrated robot is asked for and the robot's file has no `[fitted]`
    """
    if table.physics is not None:
        return Physics(table=table.physics, robot=robot, zone=zone, start=start)
    if table.calibrated is not None:
        if not isinstance(robot, PccRobot) or robot.fitted is None:
            raise ValueError("a robot file with a [fitted] table, as sinuous calibrate writes it")
        return Calibrated(table=table.calibrated, robot=robot, start=start)
    return None
