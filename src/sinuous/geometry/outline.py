"""Closed outlines in space: their middle, plane and size."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel

PLANAR = 1e-4  # deviation from a plane, as a share of the outline's size, that is measuring noise


class Outlines(NamedTuple):
    """What is known of several outlines.

    Arguments:
        centre: mean of the corners [m] (N, 3)
        normal: unit normal of the mean plane, for which an outline runs anticlockwise (N, 3)
        off: largest distance of a corner from that plane [m] (N,)
        size: diameter of the ball around the centre that holds all corners [m] (N,)
    """

    centre: Array
    normal: Array
    off: Array
    size: Array


def outlines_of(vertices: Array, loops: list[IntArray]) -> Outlines:
    """Measure outlines.

    Arguments:
        vertices: [m] (V, 3)
        loops: vertices along every outline
    """
    start = np.cumsum([0, *(len(loop) for loop in loops)], dtype=np.int64)
    along = np.concatenate([np.empty(0, dtype=np.int64), *loops])
    return Outlines(*_measure(np.ascontiguousarray(vertices[along]), start))


@kernel
def _measure(points: Array, start: IntArray) -> tuple[Array, Array, Array, Array]:
    n = start.shape[0] - 1
    centre, normal, off, size = np.zeros((n, 3)), np.zeros((n, 3)), np.zeros(n), np.zeros(n)
    for i in range(n):
        outline = points[start[i] : start[i + 1]]
        for p in outline:
            centre[i] += p
        centre[i] /= len(outline)
        arm = outline - centre[i]
        for k in range(len(arm)):
            normal[i] += np.cross(arm[k], arm[(k + 1) % len(arm)])
        x, y, z = normal[i]
        normal[i] /= max(np.sqrt(x * x + y * y + z * z), np.finfo(np.float64).tiny)
        for k in range(len(arm)):
            x, y, z = arm[k]
            off[i] = max(off[i], abs(x * normal[i, 0] + y * normal[i, 1] + z * normal[i, 2]))
            size[i] = max(size[i], 2.0 * np.sqrt(x * x + y * y + z * z))
    return centre, normal, off, size


@kernel
def nested(outlines: Outlines) -> int:
    """First outline that faces and overlaps an earlier one in its plane, -1 if none does."""
    centre, normal, _, size = outlines
    for i in range(len(size)):
        for j in range(i):
            x, y, z = centre[j] - centre[i]
            wide = max(size[i], size[j])
            if np.sqrt(x * x + y * y + z * z) < wide / 2.0:
                apart = abs(x * normal[i, 0] + y * normal[i, 1] + z * normal[i, 2])
                if apart <= PLANAR * wide and np.sum(normal[i] * normal[j]) < 0.0:
                    return i
    return -1
