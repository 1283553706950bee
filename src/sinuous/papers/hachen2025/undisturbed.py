"""Closed loops of an exact robot: the controller moves its own model, nothing is measured."""

import pickle
from dataclasses import asdict, dataclass
from functools import lru_cache
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.control.controller import Controller
from sinuous.control.dls import DampedLeastSquares
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry.safe_zone import SafeZone
from sinuous.papers.hachen2025.runs import scenario
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc

DT = 1 / 30  # [s]

FREE = "free space"
"""The place without walls; every other one is the name of a scenario."""


@dataclass(frozen=True, kw_only=True)
class Gains:
    """Of the reference controller (30): k_j, c_w and dh/du by dh/dx."""

    gain: float
    damping: float
    penalty: float

    def plain(self) -> dict[str, float]:
        """The same as plain data."""
        return asdict(self)


PRINTED = Gains(gain=0.05, damping=1.0, penalty=DT)
"""III-A, with dh/du = dt dh/dx by (14)."""

STIFF = Gains(gain=0.05, damping=1.0, penalty=1.0)
"""III-A, with dh/du = dh/dx: u is what the actuators move by in a step."""

BEST = Gains(gain=1.0, damping=0.1, penalty=1.0)
"""What the search of `stability` finds."""

MPC = "MPC"
DLS: dict[str, Gains] = {
    "DLS, printed gains": PRINTED,
    "DLS, printed gains, stiff penalty": STIFF,
    "DLS, best gains": BEST,
}


@dataclass(frozen=True, kw_only=True, eq=False)
class Place:
    """A robot that stands somewhere.

    Arguments:
        robot: its base where it stands
        zone: the room it may use
        start: configuration (n,)
        margin: [m]
    """

    robot: PccRobot
    zone: SafeZone
    start: Array
    margin: float

    def controller(self, law: str | Gains) -> Controller[Any]:
        """A controller by its name, or the reference controller with some gains."""
        if law == MPC:
            return ShapeConstrainedMPC(self.robot, self.zone, margin=self.margin, dt=DT)
        gains = law if isinstance(law, Gains) else DLS[law]
        return DampedLeastSquares(
            self.robot,
            self.zone,
            margin=self.margin,
            dt=DT,
            gain=gains.gain,
            damping=gains.damping,
            penalty=gains.penalty,
        )


@lru_cache
def place(name: str) -> Place:
    """A place by its name, the same for every run in a process."""
    if name == FREE:
        robot = load_pcc("hachen2025")
        return Place(robot=robot, zone=SafeZone.unbounded(), start=robot.home, margin=0.0)
    base = scenario(name)
    assert isinstance(base.robot, PccRobot)
    start = base.first_configuration
    return Place(robot=base.robot, zone=base.zone, start=start, margin=base.mpc.margin)


def drive(controller: Controller[Any], c: Array, targets: Array) -> Array:
    """Configurations (K + 1, n) of an exact robot, the start first.

    Once the target is at its last place, a step that leaves the controller's memory exactly as
    it was is followed by nothing but such steps: they need not be taken.

    Arguments:
        c: to start from (n,)
        targets: of every step (K, 3) [m]
    """
    state, way = controller.init(c), np.empty((len(targets) + 1, len(c)))
    way[0] = c
    moving = np.flatnonzero(np.any(targets != targets[-1], axis=1))
    held = int(moving[-1]) + 1 if len(moving) else 0
    for k, target in enumerate(targets):
        before = state
        state, _ = controller.step(state, target)
        way[k + 1] = state.c
        if k >= held and np.array_equal(before.c, state.c) and _same(before, state):
            way[k + 2 :] = state.c
            break
    return way


def held(target: Array, duration: float) -> Array:
    """A target (3,) [m] for every step of a duration [s]."""
    return np.tile(target, (round(duration / DT), 1))


def tips(robot: PccRobot, way: Array) -> Array:
    """Tips (K, 3) [m] of configurations (K, n)."""
    return np.array(robot.points(way)[:, -1])


def _same(before: object, after: object) -> bool:
    return pickle.dumps(before) == pickle.dumps(after)
