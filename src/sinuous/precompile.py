"""Compile the inner loops ahead of the first run: `python -m sinuous.precompile`."""

import numpy as np

from sinuous.control.cable_loop import CableLoop
from sinuous.control.geometric_ik import GeometricIK
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.fibre import ShapeSensing
from sinuous.plants.kinematic import KinematicPlant
from sinuous.robots.elastic import ElasticModel
from sinuous.robots.robot_file import load_jointed, load_robot
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.boundary import BoxForce, ZoneForce
from sinuous.teleop.delays import Steady
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.force import ErrorForce, ErrorForceAlong, Together
from sinuous.teleop.held import HeldForce
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.limits import Limits
from sinuous.teleop.losses import RandomLoss
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import ImpedanceOperator, Prescribed
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.position_force import PositionForce
from sinuous.teleop.receivers import Hold
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

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
    _statics()
    _by_hand()


def _statics() -> None:
    """An elastic segment, at rest and moved."""
    angles = np.deg2rad([0.0, 120.0, 240.0])
    model = ElasticModel(
        lengths=np.full(1, LENGTH),
        segment=np.zeros(3, dtype=np.int64),
        holes=RADIUS * np.stack([np.cos(angles), np.sin(angles)], axis=1),
        twist=np.zeros(1),
        stiffness=np.full(3, 1e6),
        slack=np.zeros(3),
        rest=np.zeros((1, 2)),
        friction=np.zeros(1),
    )
    model.trace(np.zeros((2, 3)))
    model.at_rest(np.zeros(3))


def _by_hand() -> None:
    """A tick of every scheme, hand and force, and one of the robot of rigid modules."""
    robot, zone = load_jointed("qin2020"), _tube()
    ik = GeometricIK(robot)
    loop, plant = CableLoop(ik, zone), KinematicPlant(robot, seed=0, encoder_step=1e-6)
    tip, state, still = robot.tip(robot.home), loop.init(robot.home), (np.zeros(2), np.zeros(3))
    plane, space = Mapping.plane(1.0, float(tip[1])), Mapping.space(1.0, tip)
    box = BoxForce(low=[-1.0, -1.0], high=[1.0, 1.0])
    walls = ZoneForce(zone=zone, mapping=space, distance=2.0 * RADIUS)
    held = HeldForce(mapping=space)
    bad = ImpairedLink(effects=(Steady(0.0), RandomLoss(0.5)))
    for scheme in (StandardWaves(), ModifiedWaves.c2(), PositionForce()):
        for mapping, rest, force in (
            (plane, still[0], Together((ErrorForce(), box))),
            (space, still[1], Together((ErrorForceAlong(), walls, held))),
        ):
            for operator in (
                Prescribed(lambda _, rest=rest: rest),
                ImpedanceOperator(lambda _, rest=rest: rest),
                MoveAndWait(stops=rest[None]),
            ):
                hand = Bilateral.connect(
                    operator=operator,
                    mapping=mapping,
                    force=force,
                    scheme=scheme,
                    link=bad,
                    receiver=Hold(longest=0.01),
                    control=PassivityControl(),
                    felt=Limits(size=1.0, slew=10.0),
                    speed=Limits(size=1.0, slew=10.0),
                    correction=DriftCorrection(),
                )
                far, signals = hand.step(hand.init(tip), tip)
                for _ in range(8):
                    far, signals = hand.step(far, tip)
                state, command = loop.step(state, signals.follower.target_w)
                plant.step(command.rates, loop.dt)
    ik.solve(tip[None])
    robot.points_jacobian(robot.home)
    robot.lengths_jacobian(robot.home)
    mpc = ShapeConstrainedMPC(robot, SafeZone.unbounded(), horizon=2)
    mpc.step(mpc.init(robot.home), tip)


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
