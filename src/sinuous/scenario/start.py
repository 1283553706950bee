"""Whether a scenario may start where its robot stands."""

import numpy as np

from sinuous.control.stage import Stage
from sinuous.errors import InputError
from sinuous.scenario.scenario import Scenario

MM_PER_M = 1e3  # messages speak of millimetres


def check_start(scenario: Scenario) -> None:
    """Refuse a start that is too close to a wall, unless the scenario says to recover.

    Raises:
        InputError: naming the wall, how far beyond the margin the body is, and the remedy
    """
    stage = scenario.mpc.stage(scenario.first_configuration)
    _check_bend(scenario, stage)
    walls = scenario.mpc.walls
    slack = np.where(walls.movable, stage.walls.clearance - walls.required, np.inf)
    worst = int(np.argmin(slack))
    if slack[worst] >= 0.0 or scenario.recover:
        return
    clearance = stage.walls.clearance[worst] - scenario.robot.radii[worst]
    where = scenario.robot.point_name(worst)
    wall = scenario.zone.describe_triangle(int(stage.walls.triangle[worst]))
    if clearance < 0.0:
        found = f"{where} {-clearance * MM_PER_M:.3g} mm beyond {wall}"
    else:
        found = f"{where} only {clearance * MM_PER_M:.3g} mm from {wall}"
    margin = scenario.mpc.margin * MM_PER_M
    raise InputError(
        file=scenario.file,
        field="robot.base_position",
        expected=f"a start with the whole body at least the margin of {margin:g} mm inside",
        found=f"{found}, {-slack[worst] * MM_PER_M:.3g} mm too close",
        remedy="Move the base or the start, open the mesh with zone.entrance, reduce "
        "mpc.margin, or set recover = true.",
    )


def _check_bend(scenario: Scenario, stage: Stage) -> None:
    """Lengths are checked with the file; the bend follows from all of them together."""
    slack = np.min(stage.bend_slack, initial=np.inf)
    if slack < 0.0:
        name = scenario.robot.bend_names[int(np.argmin(stage.bend_slack))]
        raise InputError(
            file=scenario.file,
            field="robot.start_lengths",
            expected="a start within the robot's bend limits",
            found=f"{name} beyond its limit by {-slack * MM_PER_M:.3g} mm of cable travel",
            remedy="Start with cable lengths that differ less.",
        )
