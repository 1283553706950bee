"""Which of a robot's actuators are cables, and how they pull together without bending it."""

from functools import lru_cache

import numpy as np
from scipy.optimize import nnls

from sinuous.arrays import Array, IntArray
from sinuous.robots.chain_kernels import ARC
from sinuous.robots.robot import Robot

EXACT = 1e5  # weight of what must hold beside what is to be least


@lru_cache(maxsize=32)
def bend_columns(robot: Robot) -> IntArray:
    """Coordinates that bend the robot."""
    chain = robot.chain
    first, arcs = (
        chain.theta_column[chain.theta_column >= 0],
        chain.theta_column[chain.turns == ARC],
    )
    return np.union1d(first, arcs + 1)


@lru_cache(maxsize=32)
def cable_rows(robot: Robot) -> IntArray:
    """Actuators (C,) that bend the robot: its cables."""
    slope = robot.lengths_jacobian(robot.home)[:, bend_columns(robot)]
    return np.flatnonzero(np.any(slope != 0.0, axis=1))


@lru_cache(maxsize=32)
def co_contractions(robot: Robot) -> Array:
    """How cables pull together: shares (G, C), at most one, of tension that bends nothing at home.

    For each cable the least of all pulls, in root mean square, that contain it and have no moment
    at any joint or segment: of a segment with cables at equal distances that is all of them
    together. Cables that have the same are one row.
    """
    cables = cable_rows(robot)
    lever = robot.lengths_jacobian(robot.home)[np.ix_(cables, bend_columns(robot))].T
    lever = lever / np.max(np.abs(lever))
    found, count = list[Array](), len(cables)
    for k in range(count):
        one = np.eye(count)[k]
        A = np.vstack([np.eye(count), EXACT * lever, EXACT * one])
        b = np.concatenate([np.zeros(count + len(lever)), [EXACT]])
        pull, _ = nnls(A, b)
        found.append(np.where(pull > 1.0 / EXACT, pull, 0.0) / np.max(pull))
    return np.unique(np.round(found, 6), axis=0)
