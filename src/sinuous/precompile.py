"""Compile the inner loops ahead of the first run: `python -m sinuous.precompile`."""

import numpy as np

from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.fibre import ShapeSensing
from sinuous.plants.kinematic import KinematicPlant
from sinuous.robots.robot_file import load_robot

LENGTH, RADIUS = 0.4, 0.02  # of a tube that keeps a robot in reach of its wall [m]
DT = 1.0 / 30.0  # [s]


def precompile() -> None:
    """Take a step in free space and one in a tube, so that every kernel is in the cache."""
    robot = load_robot("hachen2025")
    for zone in (SafeZone.unbounded(), _tube()):
        mpc = ShapeConstrainedMPC(robot, zone, margin=0.003, dt=DT, horizon=2)
        state = mpc.init(robot.home)
        into_the_wall = robot.tip(robot.home) + np.array([2.0 * RADIUS, 0.0, 0.0])
        _, command = mpc.step(state, target=into_the_wall)
        plant = ShapeSensing(robot=robot).on(KinematicPlant(robot, seed=0), 0)
        plant.step(command.rates, DT)


def _tube() -> SafeZone:
    """A tube with all that needs care: open ends, an obstacle, a keep-out, an entrance."""
    path = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, LENGTH]])
    tube = shapes.tube(path, RADIUS, caps=False)
    obstacle = shapes.sphere(0.05 * RADIUS, centre=(0.7 * RADIUS, 0.0, 0.9 * LENGTH))
    keep_out = shapes.sphere(0.05 * RADIUS, centre=(0.0, 0.7 * RADIUS, 0.9 * LENGTH))
    zone = SafeZone.from_mesh(tube + obstacle, cap=True, entrance=path[0])
    return zone.minus(keep_out, name="keep-out")


if __name__ == "__main__":
    precompile()
    print("The inner loops of sinuous are compiled.")
