"""`sinuous export`: a robot as a model for other programs."""

from rich.console import Console

from sinuous.cli.arguments import Export
from sinuous.cli.codes import GOOD
from sinuous.files import write_text
from sinuous.plants.physics.build import physical_body
from sinuous.plants.physics.mjcf import mjcf
from sinuous.robots.robot_file import load_robot


def export(arguments: Export) -> int:
    """Write the robot's model and say how to look at it."""
    robot, file = load_robot(arguments.robot), arguments.mjcf
    body = physical_body(robot)
    write_text(file, mjcf(body, robot))
    console = Console()
    fixed = len(robot.actuator_names) - len(body.cables)
    console.print(f"{file}: {robot.name}, {len(body.tendons)} cables", markup=False, soft_wrap=True)
    if fixed:
        which = (
            "actuator that is no cable stays" if fixed == 1 else "actuators that are no cables stay"
        )
        console.print(f"{fixed} {which} at home.", highlight=False)
    console.print(
        f"To open it: python -m mujoco.viewer --mjcf={file}",
        markup=False, highlight=False, soft_wrap=True,
    )  # fmt: skip
    return GOOD
