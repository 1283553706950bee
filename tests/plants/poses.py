"""Where to send a robot."""

from collections.abc import Iterator

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.pcc import PccRobot

LARGEST_BEND = 1.6  # [rad] of a segment


def poses(robot: PccRobot, rng: np.random.Generator, count: int) -> Iterator[Array]:
    """Configurations (n,): every segment bent anyhow within its limits, and of any length."""
    limits = robot.bend_limits
    theta, slope, offset = limits.column, limits.slope, limits.offset
    for _ in range(count):
        c = robot.home.copy()
        for name, column in zip(robot.coordinate_names, range(len(c)), strict=True):
            if name.endswith("length"):
                segment = robot.segments[int(name.split()[1]) - 1]
                c[column] = rng.uniform(*segment.length)
        for column in np.unique(theta):
            limit = float(np.min((slope @ c + offset)[theta == column]))
            bend = min(limit, LARGEST_BEND) * np.sqrt(rng.uniform())
            angle = rng.uniform(-np.pi, np.pi)
            c[column : column + 2] = bend * np.cos(angle), bend * np.sin(angle)
        yield c
