"""One configuration and all that the terms of a controller may ask about it."""

from dataclasses import dataclass, replace
from functools import cached_property, lru_cache
from typing import Self

import numpy as np

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import Nearest, SafeZone
from sinuous.robots.robot import Robot

# Damping of the tip's null space [m^2 of tip per m^2 of actuator]: far below the smallest
# squared gain at which a direction of the tip is still worth steering (1 %).
NULL_SPACE_DAMPING = 1e-5


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
    def tip_null_space(self) -> Array:
        """P M (n, n): from coordinates to actuator metres, less what moves the tip."""
        metric = actuator_metric(self.robot)
        J = np.linalg.solve(metric.T, self.jacobian[-1].T)  # (n, 3), by actuator metres
        gain = J.T @ J + NULL_SPACE_DAMPING * np.eye(3)
        return metric - J @ np.linalg.solve(gain, J.T @ metric)

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


@lru_cache(maxsize=32)
def actuator_metric(robot: Robot) -> Array:
    """M (n, n) with |M v| = |change of the actuator lengths|: coordinates in actuator metres."""
    A = robot.lengths_jacobian(robot.home)
    return np.asarray(np.linalg.cholesky(A.T @ A).T, dtype=np.float64)
