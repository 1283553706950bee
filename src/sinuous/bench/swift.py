"""A quick judge for very many steps: exact where the margin could be broken, else a bound."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.scene import Scene
from sinuous.compiled import kernel
from sinuous.geometry.bvh import STACK, ZoneArrays
from sinuous.geometry.grid import Grid, at_least, cell_of, exact
from sinuous.robots.pcc import PccRobot
from sinuous.session.surface import SHAPES, SPACING

SHARES = np.arange(1, SHAPES + 1) / SHAPES  # of a step at which the body is judged


@dataclass(frozen=True, kw_only=True, eq=False)
class SwiftJudge:
    """Judges the body's surface, every 0.25 mm, at five shapes of every step."""

    scene: Scene

    @cached_property
    def _dense(self) -> PccRobot:
        return self.scene.robot.sampled(SPACING)

    def room(self, before: Array, after: Array) -> float:
        """Least clearance beyond the margin within a step [m]; exact where it is below zero."""
        way = before + SHARES[:, None] * (after - before)
        points = self._dense.points(way).reshape(-1, 3)
        radii = np.tile(self._dense.radii, len(SHARES)) + self.scene.margin
        zone = self.scene.zone
        return float(least_room(zone.arrays, zone.grid, points, radii))


@kernel
def least_room(zone: ZoneArrays, grid: Grid, points: Array, required: Array) -> float:
    """Least clearance beyond what is required, or a lower bound of it where that is positive."""
    least, stack, keys = np.inf, np.empty(STACK, np.int64), np.empty(STACK)
    for s in range(required.size):
        x, y, z = points[s, 0], points[s, 1], points[s, 2]
        cell = cell_of(grid, x, y, z)
        room = at_least(grid, cell, x, y, z) - required[s]
        if room < 0.0:
            room = exact(zone, grid, cell, x, y, z, stack, keys)[0] - required[s]
        least = min(least, room)
    return least
