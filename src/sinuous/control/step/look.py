"""Where the body is at a configuration, and how much room it has: exact only where it matters."""

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import inner, kernel
from sinuous.control.step.data import Bends, Body, Scratch, Shape
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.grid import Grid, at_least, at_least_from_afar, cell_of, exact
from sinuous.robots import chain_kernels
from sinuous.robots.bending import bend


@kernel
def look(
    body: Body,
    shape: Shape,
    b: int,
    extra: float,
    seen: Array,
    room: Array,
    scratch: Scratch,
) -> None:
    """Fill row b of the shape from its configuration.

    Points that may have less than `extra` beyond what is required are queried exactly, all
    others keep a lower bound.

    Arguments:
        extra: [m]
        seen, room: places of the body's points nearby (S, 3), and their clearance or a lower
            bound of it (S,) [m]; empty if nothing is known
    """
    chain, zone, grid, R, p = body.chain, body.zone, body.grid, scratch.R, scratch.p
    c, points, clearance = shape.c[b], shape.points[b], shape.clearance[b]
    exactly, gradient, slot = shape.exact[b], shape.gradient[b], shape.slot[b]
    chain_kernels.frames(chain, body.T_w_b, c, R, p)
    chain_kernels.points_of(chain, c, R, p, points)
    _measure(
        zone, grid, body.required, body.movable, extra, seen, room, points, clearance, exactly,
        gradient, slot, scratch.stack, scratch.keys,
    )  # fmt: skip


@inner
def _measure(
    zone: ZoneArrays,
    grid: Grid,
    required: Array,
    movable: BoolArray,
    extra: float,
    seen: Array,
    room: Array,
    points: Array,
    clearance: Array,
    exactly: BoolArray,
    gradient: Array,
    slot: IntArray,
    stack: IntArray,
    keys: Array,
) -> None:
    """Clearances of one shape, see `look`."""
    for s in range(required.size):
        exactly[s] = False
        if not movable[s]:
            clearance[s] = np.inf  # no motion can change it
            continue
        x, y, z = points[s, 0], points[s, 1], points[s, 2]
        cell = cell_of(grid, x, y, z)
        bound, enough = at_least(grid, cell, x, y, z), required[s] + extra
        if 0.0 <= bound < enough:
            # On the free side; so the distance to the walls, which changes no faster than the
            # point moves, is the clearance.
            bound = max(bound, at_least_from_afar(grid, cell, x, y, z))
            if bound < enough and room.size > 0:
                dx, dy, dz = x - seen[s, 0], y - seen[s, 1], z - seen[s, 2]
                bound = max(bound, room[s] - np.sqrt(dx * dx + dy * dy + dz * dz))
        clearance[s] = bound
        if bound < enough:
            d, gx, gy, gz, nearest = exact(zone, grid, cell, x, y, z, stack, keys)
            clearance[s], exactly[s], slot[s] = d, True, nearest
            gradient[s, 0], gradient[s, 1], gradient[s, 2] = gx, gy, gz


@kernel
def copy(source: Shape, shape: Shape, b: int) -> None:
    """Take over row b of another shape, its configuration and what is known about it."""
    for j in range(shape.c.shape[1]):
        shape.c[b, j] = source.c[b, j]
    points, clearance, exactly = shape.points, shape.clearance, shape.exact
    slot, gradient = shape.slot, shape.gradient
    for s in range(clearance.shape[1]):
        clearance[b, s], exactly[b, s] = source.clearance[b, s], source.exact[b, s]
        slot[b, s] = source.slot[b, s]
        for d in range(3):
            points[b, s, d] = source.points[b, s, d]
            gradient[b, s, d] = source.gradient[b, s, d]


@kernel
def least_slack(body: Body, shape: Shape, b: int) -> float:
    """Least clearance beyond what is required [m], or a lower bound of it."""
    least = np.inf
    for s in range(body.required.size):
        least = min(least, shape.clearance[b, s] - body.required[s])
    return least


@kernel
def bend_slack(bends: Bends, j: int, c: Array) -> float:
    """Cable travel left until bend limit j [m]."""
    limit = bends.offset[j]
    for k in range(c.size):
        limit += bends.slope[j, k] * c[k]
    x, y = float(c[bends.column[j]]), float(c[bends.column[j] + 1])
    return float(bends.pitch[j]) * (limit - bend(bends.is_joint[j], x, y))


@kernel
def least_bend_slack(bends: Bends, c: Array) -> float:
    """Least of all bend limits [m]."""
    least = np.inf
    for j in range(bends.column.size):
        least = min(least, bend_slack(bends, j, c))
    return least
