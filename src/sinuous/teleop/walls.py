"""The nearest place that keeps its distance from every wall, compiled.

The clearance falls off the middle between two walls, and so does the direction to the nearest of
them: a force along it alone trembles there.  The way to the nearest allowed place does not: in a
room without edges that stick out it changes no faster than the point.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.geometry.bvh import ZoneArrays, nearest

WALLS = 6  # most that are looked at: the next is that of the place found so far
ROUNDS = 60  # of Hildreth's method; three walls at right angles take one
ENOUGH = 1e-7  # what a place may lack of the distance [m]


@kernel
def way_back(zone: ZoneArrays, p: Array, distance: float, way: Array) -> None:
    """Write the way (3,) [m] from p (3,) to the nearest place at that distance from all walls.

    Each wall is taken for a plane, as the walls of the controller are: in a room without edges
    that stick out no plane cuts off an allowed place, and the result is the nearest one.
    """
    normals, levels, pushes = np.empty((WALLS, 3)), np.empty(WALLS), np.zeros(WALLS)
    place, gradient = np.empty((1, 3)), np.empty((1, 3))
    clearance, triangle = np.empty(1), np.empty(1, np.int64)
    way[:] = 0.0
    for found in range(WALLS + 1):
        for i in range(3):
            place[0, i] = p[i] + way[i]
        nearest(zone, place, clearance, gradient, triangle)
        missing = distance - clearance[0]
        if not missing > ENOUGH or found == WALLS:
            return
        levels[found] = missing
        for i in range(3):
            normals[found, i] = gradient[0, i]
            levels[found] += gradient[0, i] * way[i]
        _shortest(normals, levels, pushes, found + 1, way)


@kernel
def _shortest(normals: Array, levels: Array, pushes: Array, count: int, way: Array) -> None:
    """The shortest way with normal . way >= level for every plane, by Hildreth's method."""
    for _ in range(ROUNDS):
        moved = 0.0
        for k in range(count):
            lacks = levels[k]
            for i in range(3):
                lacks -= normals[k, i] * way[i]
            step = max(lacks, -pushes[k])
            pushes[k] += step
            for i in range(3):
                way[i] += step * normals[k, i]
            moved = max(moved, abs(step))
        if moved < 0.1 * ENOUGH:
            return
