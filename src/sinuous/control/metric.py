"""Distances between configurations, in actuator metres."""

from functools import lru_cache

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.robot import Robot


@lru_cache(maxsize=32)
def actuator_metric(robot: Robot) -> Array:
    """M (n, n) with |M v| = |change of the actuator lengths|: coordinates in actuator metres."""
    A = robot.lengths_jacobian(robot.home)
    return np.ascontiguousarray(np.linalg.cholesky(A.T @ A).T, dtype=np.float64)


@lru_cache(maxsize=32)
def actuator_inverse(robot: Robot) -> Array:
    """M^-1 (n, n): coordinates by actuator metres."""
    return np.ascontiguousarray(np.linalg.inv(actuator_metric(robot)), dtype=np.float64)
