"""Clearance of the whole body surface during a step, independent of the controller's points."""

from dataclasses import dataclass
from typing import Protocol, Self, cast

import numpy as np

from sinuous.arrays import Array, BoolArray
from sinuous.control.stage import Stage
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot
from sinuous.scenario.start import movable

SPACING = 0.00025  # of the points on the backbone at which the surface is judged [m]
SHAPES = 5  # looked at for each step: four on the way and the last
COARSE = 12  # every so many points are queried first


class Sampled(Robot, Protocol):
    """A robot whose body can be sampled more finely."""

    def sampled(self, spacing: float) -> Self:
        """The same robot with a body point every `spacing` [m] or less."""
        ...


def least_clearance(zone: SafeZone, points: Array, radii: Array, judged: BoolArray) -> float:
    """Least clearance [m] of the body surface at the judged points; infinite without a wall.

    Arguments:
        points: (S, 3) [m]
        radii: of the body (S,) [m]
        judged: which points count (S,)
    """
    return float(np.min(zone.clearance(points[judged]) - radii[judged], initial=np.inf))


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceClearance:
    """Judges steps by a body that is sampled far more finely than the controller's.

    Arguments:
        robot: sampled finely
        zone: the room it may use
        judged: points of the fine body (F,) that can move; the base is not the controller's
        guarded: the same for the points (S,) of the controller's body
    """

    robot: Robot
    zone: SafeZone
    judged: BoolArray
    guarded: BoolArray

    @classmethod
    def of(cls, robot: Robot, zone: SafeZone, c: Array) -> Self:
        """Prepare for a robot that starts at configuration c (n,)."""
        fine = cast(Sampled, robot).sampled(SPACING)
        return cls(
            robot=fine,
            zone=zone,
            judged=movable(Stage(robot=fine, zone=zone, c=c)),
            guarded=movable(Stage(robot=robot, zone=zone, c=c)),
        )

    def least(self, before: Array, after: Array) -> float:
        """Least surface clearance [m] on the straight way from one configuration to another.

        Clearance changes no faster than a point moves, so most points need no query: those
        next to them tell that they cannot be the closest ones. The result is exact.
        """
        share = np.arange(1, SHAPES + 1)[:, None] / SHAPES
        points = self.robot.points(before + share * (after - before))[:, self.judged]
        radii = self.robot.radii[self.judged]
        coarse = np.arange(len(radii)) // COARSE * COARSE
        some = self.zone.clearance(points[:, ::COARSE])
        least = float(np.min(some - radii[::COARSE], initial=np.inf))
        near = np.linalg.norm(points - points[:, coarse], axis=2)
        bound = some[:, coarse // COARSE] - near - radii
        shape, point = np.nonzero(bound < least)
        rest = self.zone.clearance(points[shape, point]) - radii[point]
        return float(np.min(rest, initial=least))
