"""From a robot to its physical body."""

from sinuous.errors import InputError
from sinuous.plants.physics.body import PhysicalBody
from sinuous.plants.physics.jointed_model import JointedBody
from sinuous.plants.physics.rod_model import RodBody
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot import Robot


def physical_body(robot: Robot) -> PhysicalBody:
    """The model of a robot, by its kind.

    Raises:
        InputError: if there is none for its kind
    """
    match robot:
        case JointedRobot():
            return JointedBody(robot=robot)
        case PccRobot():
            return RodBody(robot=robot)
        case _:
            raise InputError(
                file=robot.name,
                expected="a robot of modules or of segments",
                found=f"a {type(robot).__name__}",
                remedy="Physics knows no other kind.",
            )
