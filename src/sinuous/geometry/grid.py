"""A grid of clearances that says, in a few operations, how much room a point has at least.

The clearance changes no faster than the point moves, so what is known at the centre of a cell
bounds it from below in the whole cell.  The bound is never optimistic; where it does not settle
a question the exact query does, and starts from the triangle that is nearest to the centre.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner, kernel
from sinuous.geometry.bvh import STACK, ZoneArrays, search, signed
from sinuous.geometry.triangle import closest

CELLS = 2**17  # about so many in all: a few megabytes, built in a fraction of a second
FINEST = 2e-4  # smallest edge of a cell, as a share of the zone's largest coordinate
AFAR = 4.0  # edges: how far the second bound looks
ROUNDING = 1e-12  # share of the zone's largest coordinate by which every bound is lowered


class Grid(NamedTuple):
    """Cells around the walls of a zone.

    Arguments:
        origin: lowest corner [m] (3,)
        edge: of a cell [m]; zero for a zone without walls
        shape: cells along every axis (3,)
        bound: clearance at the centre [m], less rounding; -inf where a cell is cut by an open
            facet, across which the clearance jumps (C,)
        slot: of the triangle of every surface nearest to the centre (K, C)
    """

    origin: Array
    edge: float
    shape: IntArray
    bound: Array
    slot: IntArray


def make_grid(zone: ZoneArrays, open_corners: Array) -> Grid:
    """Lay a grid around the walls of a zone.

    Arguments:
        zone: the walls
        open_corners: triangles that are open [m] (F, 3, 3)
    """
    surfaces = len(zone.roots)
    if not surfaces:
        nothing = np.zeros(3)
        return Grid(nothing, 0.0, nothing.astype(np.int64), np.zeros(0), _slots(0, 0))
    low, high = zone.lower[zone.roots].min(axis=0), zone.upper[zone.roots].max(axis=0)
    edge = max(float(np.cbrt(np.prod(high - low) / CELLS)), FINEST * zone.scale)
    shape = np.ceil((high - low) / edge).astype(np.int64) + 1
    origin = 0.5 * (low + high - edge * shape)
    cells = int(np.prod(shape))
    grid = Grid(origin, edge, shape, np.empty(cells), _slots(surfaces, cells))
    normals = np.cross(
        open_corners[:, 1] - open_corners[:, 0], open_corners[:, 2] - open_corners[:, 0]
    )
    size = np.linalg.norm(normals, axis=1, keepdims=True)
    normals = np.divide(normals, size, out=np.zeros_like(normals), where=size > 0.0)
    fill(zone, grid, np.ascontiguousarray(open_corners), normals)
    return grid


def _slots(surfaces: int, cells: int) -> IntArray:
    return np.zeros((surfaces, cells), dtype=np.int64)


@kernel
def fill(zone: ZoneArrays, grid: Grid, open_corners: Array, open_normals: Array) -> None:
    """Query every centre; cells that an open facet may cut know nothing."""
    stack, keys = np.empty(STACK, np.int64), np.empty(STACK)
    reach = 0.5 * np.sqrt(3.0) * grid.edge
    for k in range(zone.roots.size):
        last = -1
        for cell in range(grid.bound.size):
            x, y, z = centre(grid, cell)
            limit = np.inf
            if last >= 0:
                limit = closest(zone.corners, zone.winding_normal, last, x, y, z)[0]
            last = search(zone, zone.roots[k], x, y, z, limit, stack, keys)
            grid.slot[k, cell] = last
            d = signed(zone, last, x, y, z)[0] - ROUNDING * zone.scale
            grid.bound[cell] = d if k == 0 else min(d, grid.bound[cell])
    for f in range(open_corners.shape[0]):
        first, last = np.empty(3, np.int64), np.empty(3, np.int64)
        for d in range(3):
            corner = open_corners[f, :, d]
            low, high = corner.min() - reach, corner.max() + reach
            first[d] = max(0, int((low - grid.origin[d]) / grid.edge))
            last[d] = min(grid.shape[d] - 1, int((high - grid.origin[d]) / grid.edge))
        for i in range(first[0], last[0] + 1):
            for j in range(first[1], last[1] + 1):
                for m in range(first[2], last[2] + 1):
                    cell = (i * grid.shape[1] + j) * grid.shape[2] + m
                    x, y, z = centre(grid, cell)
                    d2 = closest(open_corners, open_normals, f, x, y, z)[0]
                    if d2 <= reach * reach * (1.0 + 1e-9):
                        grid.bound[cell] = -np.inf


@inner
def centre(grid: Grid, cell: int) -> tuple[float, float, float]:
    """Centre of a cell [m]."""
    across = grid.shape[1] * grid.shape[2]
    i, rest = cell // across, cell % across
    j, m = rest // grid.shape[2], rest % grid.shape[2]
    return (
        grid.origin[0] + (i + 0.5) * grid.edge,
        grid.origin[1] + (j + 0.5) * grid.edge,
        grid.origin[2] + (m + 0.5) * grid.edge,
    )


@inner
def cell_of(grid: Grid, x: float, y: float, z: float) -> int:
    """The cell of a point, -1 outside the grid and for coordinates that are not numbers."""
    i = (x - grid.origin[0]) / grid.edge
    j = (y - grid.origin[1]) / grid.edge
    m = (z - grid.origin[2]) / grid.edge
    if not (0.0 <= i < grid.shape[0] and 0.0 <= j < grid.shape[1] and 0.0 <= m < grid.shape[2]):
        return -1
    return int((int(i) * grid.shape[1] + int(j)) * grid.shape[2] + int(m))


@inner
def at_least(grid: Grid, cell: int, x: float, y: float, z: float) -> float:
    """A lower bound of the clearance [m] of a point in a cell; -inf where nothing is known."""
    if cell < 0:
        return -np.inf
    cx, cy, cz = centre(grid, cell)
    dx, dy, dz = x - cx, y - cy, z - cz
    return float(grid.bound[cell]) - np.sqrt(dx * dx + dy * dy + dz * dz)


@inner
def at_least_from_afar(grid: Grid, cell: int, x: float, y: float, z: float) -> float:
    """A second, mostly better bound for a point that is known to be on the free side.

    The wall seen from a few cells farther away is nearly behind the point, so little is lost.
    What is known there bounds the distance of the point to all walls, which on the free side is
    its clearance.
    """
    if cell < 0:
        return -np.inf
    across, row = grid.shape[1] * grid.shape[2], grid.shape[2]
    i, j, m = cell // across, (cell % across) // row, cell % row
    if not (0 < i < grid.shape[0] - 1 and 0 < j < grid.shape[1] - 1 and 0 < m < row - 1):
        return -np.inf
    bound = grid.bound
    gx = bound[cell + across] - bound[cell - across]
    gy = bound[cell + row] - bound[cell - row]
    gz = bound[cell + 1] - bound[cell - 1]
    size = np.sqrt(gx * gx + gy * gy + gz * gz)
    if not 0.0 < size < np.inf:
        return -np.inf
    f = AFAR * grid.edge / size
    return at_least(grid, cell_of(grid, x + f * gx, y + f * gy, z + f * gz), x, y, z)


@inner
def exact(
    zone: ZoneArrays,
    grid: Grid,
    cell: int,
    x: float,
    y: float,
    z: float,
    stack: IntArray,
    keys: Array,
) -> tuple[float, float, float, float, int]:
    """Exact clearance of one point [m], its gradient and the slot of the nearest triangle.

    The result is that of `bvh.nearest` and does not depend on the grid; inf, no gradient and -1
    without walls.
    """
    best = (np.inf, 0.0, 0.0, 0.0, -1)
    for k in range(zone.roots.size):
        limit = np.inf
        if cell >= 0:
            start = grid.slot[k, cell]
            limit = closest(zone.corners, zone.winding_normal, start, x, y, z)[0]
        slot = search(zone, zone.roots[k], x, y, z, limit, stack, keys)
        d, gx, gy, gz = signed(zone, slot, x, y, z)
        if d < best[0]:
            best = (d, gx, gy, gz, slot)
    return best
