"""Targets moved into the safe zone before a controller sees them.

Paper B (III-E, V) argues against this: where the zone is not convex, the nearest place inside
jumps although the target does not. It is here so that the argument can be tested.
"""

from dataclasses import dataclass
from typing import TypeVar

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.around import Around
from sinuous.control.controller import ControllerState
from sinuous.control.report import Command
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement

S = TypeVar("S", bound=ControllerState)

# How often a place is moved inward; in a corner each wall in turn moves it.
ROUNDS = 40

# What a place may lack of the distance asked for [m]; it is moved that much further.
ENOUGH = 1e-7


def projected(zone: SafeZone, p: Array, distance: float) -> Array:
    """A place (3,) [m] near p (3,) [m] that has a distance [m] from every wall.

    It goes inward from p, or from the nearest point of the wall if p is outside, until the
    distance is enough, once for each wall that is too close. Beside a single smooth wall this
    is the nearest such place. In corners it is one of the places near the nearest one, and where
    the zone is too narrow for the distance it is about the roomiest place.
    """
    near, share = zone.nearest(p), 1.0
    for _ in range(ROUNDS):
        missing = distance - float(near.clearance)
        if missing <= 0.0:
            break
        further = p + share * (missing + ENOUGH) * near.gradient
        there = zone.nearest(further)
        # Between two walls that are too near each other the whole way leads to the other one.
        share = 1.0 if there.clearance > near.clearance else 0.5 * share
        if there.clearance > near.clearance - ENOUGH:
            p, near = further, there
    return p


@dataclass(frozen=True, eq=False)
class ProjectedTarget(Around[S]):
    """Hands a controller the target's projection on where the tip keeps its margin.

    A target that has enough clearance passes unchanged. Only the tip's clearance is looked at:
    whether the body can follow it there is for the controller to find out. The projection of a
    target that moves is not continuous where two walls are equally near.

    Arguments:
        controller: any controller
    """

    def project(self, target: Array) -> Array:
        """The place (3,) [m] that the tip is sent to instead of target (3,) [m]."""
        return projected(self.zone, target, float(self.robot.required_distance(self.margin)[-1]))

    def init(self, c: ArrayLike) -> S:
        """The state to start from, at rest at configuration c (n,)."""
        return self.controller.init(c)

    def step(
        self, state: S, target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[S, Command]:
        """One step towards the projection of target (3,) [m].

        What is no place in space is left to the controller, which holds still.
        """
        goal = np.array(target, dtype=float)
        if goal.shape == (3,) and np.all(np.isfinite(goal)):
            goal = self.project(goal)
        return self.controller.step(state, goal, measured)
