"""A robot's model as a file for MuJoCo's own viewer."""

import numpy as np

from sinuous.plants.physics.assembly import assembled, compiled
from sinuous.plants.physics.body import PhysicalBody
from sinuous.robots.robot import Robot

TRAVEL = 0.1  # of a cable's slider to either side, as a share of the cable's length


def mjcf(body: PhysicalBody, robot: Robot) -> str:
    """The model as XML, at home, with gravity and without walls.

    Its inputs are changes of cable lengths from home [m], so that it opens straight and taut.
    Insertion and backbones, which are no joints, stay where they are at home. MuJoCo writes six
    digits.

    Raises:
        InputError: if MuJoCo cannot hold the robot
    """
    spec, cable = assembled(body), body.mechanics
    home = body.cable_lengths(robot.lengths(robot.home))
    for name, length in zip(body.tendons, home.tolist(), strict=True):
        actuator = spec.actuator(name)
        bias = np.array(actuator.biasprm)
        bias[0] = cable.stiffness * (length - cable.pretension)
        actuator.biasprm = bias
        actuator.ctrllimited, actuator.ctrlrange = True, (-TRAVEL * length, TRAVEL * length)
    compiled(spec)
    return str(spec.to_xml())
