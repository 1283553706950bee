"""The plant of a scenario in a physics engine."""

from dataclasses import dataclass

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.physics.build import physical_body
from sinuous.plants.physics.plant import PhysicsPlant
from sinuous.plants.physics.walls import Walls
from sinuous.robots.robot import Robot
from sinuous.scenario.plant_tables import PhysicsTable


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
            physical_body(self.robot),
            self.robot,
            gravity=table.gravity,
            walls=Walls(zone=zone) if table.walls and zone.surfaces else None,
            payload=table.payload,
            tip_force=table.tip_force,
            start=self.start,
            tick=table.tick,
            tension_sensors=table.tension_sensors,
        )
