"""Clearance of the whole body surface during a step, independent of the controller's points."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot

SPACING = 0.00025  # of the points on the backbone at which the surface is judged [m]
SHAPES = 5  # looked at for each step: four on the way and the last
COARSE = 12  # every so many points are queried first


def least_clearance(zone: SafeZone, robot: Robot, points: Array) -> float:
    """Least clearance [m] of a body that was measured at its points (S, 3) [m].

    The fixed base does not count: no actuator is to blame for where it stands.
    """
    if not zone.surfaces:
        return np.inf
    clearance = zone.clearance(points[robot.movable]) - robot.radii[robot.movable]
    return float(np.min(clearance, initial=np.inf))


@dataclass(frozen=True, kw_only=True, eq=False)
class SurfaceClearance:
    """Judges steps by a body that is sampled far more finely than the controller's.

    Arguments:
        robot: sampled finely
        zone: the room it may use
    """

    robot: Robot
    zone: SafeZone

    @classmethod
    def of(cls, robot: Robot, zone: SafeZone) -> Self:
        """Prepare for a robot."""
        return cls(robot=robot.sampled(SPACING), zone=zone)

    def least(self, before: Array, after: Array) -> float:
        """Least surface clearance [m] on the straight way from one configuration to another.

        Clearance changes no faster than a point moves, so most points need no query: those
        next to them tell that they cannot be the closest ones. The result is exact.
        """
        if not self.zone.surfaces:
            return np.inf
        share = np.arange(1, SHAPES + 1)[:, None] / SHAPES
        points = self.robot.points(before + share * (after - before))[:, self.robot.movable]
        radii = self.robot.radii[self.robot.movable]
        coarse = np.arange(len(radii)) // COARSE * COARSE
        some = self.zone.clearance(points[:, ::COARSE])
        least = float(np.min(some - radii[::COARSE], initial=np.inf))
        near = np.linalg.norm(points - points[:, coarse], axis=2)
        bound = some[:, coarse // COARSE] - near - radii
        shape, point = np.nonzero(bound < least)
        rest = self.zone.clearance(points[shape, point]) - radii[point]
        return float(np.min(rest, initial=least))
