"""What the pictures of a run in space show, whichever way one looks at it."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.recording import Recording, ZonePart
from sinuous.view.curves import way_points
from sinuous.view.solids import Solid, block, body, cropped, together, wire
from sinuous.view.style import SLATE, TIMES, rgb
from sinuous.view.units import MM_PER_M

SHAPES = 14
"""How many shapes are drawn; more overlap."""

WIRE = 0.11
"""Radius of an earlier shape by that of the body: a line where the last shape is a robot."""

MOST_TRIANGLES = 12_000
"""Larger meshes are thinned out for drawing: every triangle costs, few can be told apart."""

FINE = 0.03
"""Size of the triangles of keep-outs by that of the picture."""

SLIMMEST = 0.45
"""Least extent of what is shown by the largest one; flatter boxes leave no room for labels."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Scene:
    """Everything in millimetres.

    Arguments:
        low, high: corners of the picture's box (3,), around passage and robot
        walls: triangles of the passage (T, 3, 3)
        guide: polygons (K, 3) of the guide before an entrance, as far as they are in the box
        keep_outs: the obstacles
        robot: the last shape, in full
        earlier: shapes before it, as lines
        shapes, colors: the same lines (M, S, 3) and their colours (M, 4)
        tip: its path (K, 3)
        targets: way-points (W, 3), or the path of a target that moves
        jumps: whether they are way-points
    """

    low: Array
    high: Array
    walls: Array
    guide: list[Array]
    keep_outs: Solid
    robot: Solid
    earlier: Solid
    shapes: Array
    colors: Array
    tip: Array
    targets: Array
    jumps: bool

    @classmethod
    def of(cls, recording: Recording) -> Self:
        """Prepare a run that has steps."""
        header = recording.header
        part, triangles = header.zone_parts, header.zone_triangles * MM_PER_M
        points = recording.actual_points * MM_PER_M
        stops = way_points(recording)
        jumps = len(stops) > 0
        shown = triangles[part != ZonePart.GUIDE]
        low, high = _box([points, recording.target * MM_PER_M, shown])
        chosen, colors = _chosen(recording)
        radii = header.radii * MM_PER_M
        return cls(
            low=low,
            high=high,
            walls=_thinned(triangles[part == ZonePart.WALL]),
            guide=cropped(_thinned(triangles[part == ZonePart.GUIDE]), low, high),
            keep_outs=block(
                _thinned(triangles[part == ZonePart.KEEP_OUT]),
                FINE * float((high - low).max()),
                rgb(SLATE),
            ),
            robot=body(points[-1], radii, header.disk_indices, colors[-1], header.tubes),
            earlier=together(
                [
                    wire(points[k], WIRE * float(radii.max()), color)
                    for k, color in zip(chosen[:-1], colors[:-1], strict=True)
                ]
            ),
            shapes=points[chosen],
            colors=colors,
            tip=recording.actual_tip * MM_PER_M,
            targets=(stops if jumps else recording.target) * MM_PER_M,
            jumps=jumps,
        )


def _chosen(recording: Recording) -> tuple[IntArray, Array]:
    """Some steps (M,), evenly spaced along the tip's way, the last one too, and their colours."""
    last = len(recording) - 1
    moves = np.linalg.norm(np.diff(recording.nominal_tip, axis=0), axis=1)
    way = np.concatenate(([0.0], np.cumsum(moves)))
    chosen = np.searchsorted(way, np.linspace(0.0, way[-1], SHAPES))
    chosen = np.unique(np.append(chosen[:-1], last))
    return chosen, np.asarray(TIMES(chosen / max(last, 1)), dtype=np.float64)


def _box(parts: list[Array]) -> tuple[Array, Array]:
    """Lower and upper corner of everything in parts, with a little air."""
    points = np.concatenate([part.reshape(-1, 3) for part in parts])
    low, high = points.min(axis=0), points.max(axis=0)
    extent = high - low
    air = np.maximum(0.04 * extent.max(), 0.5 * (SLIMMEST * extent.max() - extent))
    return low - air, high + air


def _thinned(triangles: Array) -> Array:
    """Every n-th triangle, so that there are not too many."""
    return triangles[:: 1 + len(triangles) // MOST_TRIANGLES]
