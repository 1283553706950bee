"""Robots of `sinuous bench link`, and what they meet."""

from dataclasses import dataclass
from functools import cache

import numpy as np

from sinuous.arrays import Array
from sinuous.bench import scene
from sinuous.bench.link_drive import FAR, Follower
from sinuous.bench.link_grid import Contact
from sinuous.bench.scene import Scene, stress_scene
from sinuous.control.mpc import MPCState, ShapeConstrainedMPC
from sinuous.teleop.boundary import BoxForce, ZoneForce
from sinuous.teleop.force import ErrorForce, ErrorForceAlong, Together, VirtualForce
from sinuous.teleop.mapping import Mapping

LAG = 0.03  # of the simple follower: a step of the controller at 30 Hz [s]
WALL = 0.015  # where the box ends: half the way that the hand goes [m]
LINE = Mapping(scale=np.ones(1), axes=np.eye(3)[:, :1], origin=np.zeros(3))
DISKS, HORIZON = 9, 2


@dataclass(frozen=True, kw_only=True)
class Place:
    """Where a teleoperation takes place.

    Arguments:
        mapping: from the hand to the robot
        force: what the operator shall feel
        follower: new, at rest
        tip_w: where it starts (3,) [m]
    """

    mapping: Mapping
    force: VirtualForce
    follower: Follower
    tip_w: Array


class Lagging:
    """Goes to its target with a first-order lag, on one axis.

    Arguments:
        tip_w: where it starts (3,) [m]
        share: of the way to the target that it goes in a tick
    """

    def __init__(self, tip_w: Array, share: float) -> None:
        self._tip, self._share = tip_w, share

    def step(self, target_w: Array) -> Array:
        """Where the tip is (3,) [m] after a tick."""
        self._tip = self._tip + self._share * (target_w - self._tip)
        return self._tip


class Guided:
    """The robot of the stress scene under the model predictive controller, between its steps, too.

    Arguments:
        mpc: whose steps take many ticks
        state: to start from
        dt: time of a tick [s]
    """

    def __init__(self, mpc: ShapeConstrainedMPC, state: MPCState, dt: float) -> None:
        self._mpc, self._state, self._ticks = mpc, state, round(mpc.dt / dt)
        self._from = self._to = mpc.robot.tip(state.c)
        self._count = 0

    def step(self, target_w: Array) -> Array:
        """Where the tip is (3,) [m] after a tick."""
        gone = self._count % self._ticks
        if gone == 0:
            self._state, _ = self._mpc.step(self._state, target_w)
            self._from, self._to = self._to, self._mpc.robot.tip(self._state.c)
        self._count += 1
        return self._from + (gone + 1) / self._ticks * (self._to - self._from)


def place(contact: Contact, dt: float) -> Place:
    """The surroundings of a cell; dt is the time of a tick [s]."""
    match contact:
        case Contact.FREE:
            return _simple(ErrorForce(), dt)
        case Contact.BOX:
            return _simple(Together((ErrorForce(), BoxForce(low=(-FAR,), high=(WALL,)))), dt)
        case Contact.MESH:
            return _tube(dt)


def _simple(force: VirtualForce, dt: float) -> Place:
    tip = np.zeros(3)
    return Place(mapping=LINE, force=force, follower=Lagging(tip, dt / LAG), tip_w=tip)


def _tube(dt: float) -> Place:
    """The hand's first axis leads away from the middle of the bend, to the wall."""
    made = _scene()
    robot = made.robot
    tip = robot.tip(made.start)
    along = scene.BEND * np.arctan2(tip[2], scene.BEND - tip[0])
    _, outward, across = scene.axis(np.array(along))
    axes = np.stack([outward, across, np.cross(outward, across)], axis=1)
    mapping = Mapping(scale=np.ones(3), axes=axes, origin=tip)
    distance = float(robot.required_distance(made.margin)[-1])
    mpc = ShapeConstrainedMPC(robot, made.zone, margin=made.margin, dt=made.dt, horizon=HORIZON)
    return Place(
        mapping=mapping,
        force=Together(
            (ErrorForceAlong(), ZoneForce(zone=made.zone, mapping=mapping, distance=distance))
        ),
        follower=Guided(mpc, mpc.init(made.start), dt),
        tip_w=tip,
    )


@cache
def _scene() -> Scene:
    return stress_scene(DISKS, 1)
