"""A closed surface ready for queries, and the flat arrays of several of them."""

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.normals import pseudonormals
from sinuous.geometry.tree import Tree, build


class Part(IntEnum):
    """What a triangle is for."""

    FILE = 0  # a triangle of the mesh as it came
    CAP = 1  # closes an open end
    GUIDE = 2  # continues the passage before the entrance


@dataclass(frozen=True, kw_only=True, eq=False)
class Surface:
    """A closed, outward-oriented triangle surface in metres.

    Arguments:
        name: of the mesh, for messages
        vertices: [m] (V, 3)
        faces: (F, 3)
        is_open: triangles that close the surface but do not constrain (F,)
        part: a `Part` per triangle (F,)
        source: number of the triangle within its part; in the file for `Part.FILE` (F,)
        keep_out: whether the inside is blocked rather than free
    """

    name: str
    vertices: Array
    faces: IntArray
    is_open: BoolArray
    part: IntArray
    source: IntArray
    keep_out: bool = False


def _arrays_of(surface: Surface, offset: int) -> tuple[Tree, tuple[Array, ...], IntArray]:
    """Tree, (corners, winding, face, edge, vertex normals) in leaf order, and triangle numbers."""
    sign = 1.0 if surface.keep_out else -1.0
    wall = np.flatnonzero(~surface.is_open)
    normals = pseudonormals(surface.vertices, surface.faces, surface.is_open)
    corners = np.ascontiguousarray(surface.vertices[surface.faces[wall]])
    tree = build(corners)
    chosen = wall[tree.order]
    rows = (
        corners[tree.order],
        normals.face[chosen],
        sign * normals.face[chosen],
        sign * normals.edge[chosen],
        sign * normals.vertex[chosen],
    )
    return tree, rows, chosen + offset


def zone_arrays(surfaces: tuple[Surface, ...]) -> ZoneArrays:
    """Concatenate surfaces for compiled queries; none of them makes unbounded space."""
    if not surfaces:
        empty, none = np.zeros((0, 3)), np.zeros(0, dtype=np.int64)
        block = np.zeros((0, 3, 3))
        return ZoneArrays(
            empty, empty, none, none, none, block, empty, empty, block, block, none, none, 0.0
        )
    sizes = [len(s.faces) for s in surfaces]
    parts = [_arrays_of(s, sum(sizes[:k])) for k, s in enumerate(surfaces)]
    trees = [tree for tree, _, _ in parts]
    boxes = np.cumsum([0, *(len(t.child) for t in trees)])
    slots = np.cumsum([0, *(len(t.order) for t in trees)])
    child = [t.child + np.where(t.leaf > 0, slots[k], boxes[k]) for k, t in enumerate(trees)]
    rows = [np.concatenate([part[1][i] for part in parts]) for i in range(5)]
    triangle = np.concatenate([t for _, _, t in parts])
    slot = np.full(sum(sizes), -1, dtype=np.int64)
    slot[triangle] = np.arange(len(triangle))
    return ZoneArrays(
        np.concatenate([t.lower for t in trees]),
        np.concatenate([t.upper for t in trees]),
        np.concatenate(child).astype(np.int64),
        np.concatenate([t.leaf for t in trees]),
        boxes[:-1].astype(np.int64),
        rows[0],
        rows[1],
        rows[2],
        rows[3],
        rows[4],
        triangle.astype(np.int64),
        slot,
        float(max(np.abs(s.vertices).max() for s in surfaces)),
    )
