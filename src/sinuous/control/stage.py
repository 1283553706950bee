"""One configuration and all that the terms of a controller may ask about it."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Self

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import Nearest, SafeZone
from sinuous.robots.robot import Robot


@dataclass(frozen=True, kw_only=True, eq=False)
class Stage:
    """Kinematics and clearance at c (n,), each computed when first asked for and only once."""

    robot: Robot
    zone: SafeZone
    c: Array

    def moved_to(self, c: Array) -> Self:
        """The same robot in the same zone at another configuration."""
        return replace(self, c=c)

    @cached_property
    def points(self) -> Array:
        """Body points (S, 3) [m]."""
        return self.robot.points(self.c)

    @cached_property
    def jacobian(self) -> Array:
        """Their derivative (S, 3, n)."""
        return self.robot.points_jacobian(self.c)

    @cached_property
    def walls(self) -> Nearest:
        """Clearance of the body points, its gradient and the nearest triangles."""
        return self.zone.nearest(self.points)

    @cached_property
    def lengths(self) -> Array:
        """Actuator lengths (P,) [m]."""
        return self.robot.lengths(self.c)

    @cached_property
    def bend_slack(self) -> Array:
        """Cable travel left until the bend limits (J,) [m]."""
        return self.robot.bend_slack(self.c)

    @property
    def tip(self) -> Array:
        """Tip position (3,) [m]: the last of the body points."""
        return self.points[-1]
