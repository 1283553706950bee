"""Whether a scenario may start where its robot stands."""

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.scenario.scenario import Scenario

MM_PER_M = 1e3  # messages speak of millimetres


def check_start(scenario: Scenario) -> None:
    """Refuse a start that is too close to a wall, unless the scenario says to recover.

    Raises:
        InputError: naming the wall, how far beyond the margin the body is, and the remedy
    """
    c, robot = scenario.first_configuration, scenario.robot
    _check_bend(scenario, robot.bend_slack(c))
    slack = scenario.mpc.slack(c)
    worst = int(np.argmin(slack))
    if slack[worst] >= 0.0 or scenario.recover:
        return
    near = scenario.zone.nearest(robot.points(c)[worst])
    clearance = float(near.clearance) - robot.radii[worst]
    where = robot.point_name(worst)
    wall = scenario.zone.describe_triangle(int(near.triangle))
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


def _check_bend(scenario: Scenario, bend_slack: Array) -> None:
    """Lengths are checked with the file; the bend follows from all of them together."""
    slack = np.min(bend_slack, initial=np.inf)
    if slack < 0.0:
        name = scenario.robot.bend_names[int(np.argmin(bend_slack))]
        raise InputError(
            file=scenario.file,
            field="robot.start_lengths",
            expected="a start within the robot's bend limits",
            found=f"{name} beyond its limit by {-slack * MM_PER_M:.3g} mm of cable travel",
            remedy="Start with cable lengths that differ less.",
        )
