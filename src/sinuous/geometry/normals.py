"""Angle-weighted pseudonormals of a closed triangle surface."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.geometry.topology import edges_of


class Normals(NamedTuple):
    """Outward normals, one row per triangle.

    Arguments:
        face: unit normals (F, 3), zero for triangles without area
        edge: of the edge from corner k to k + 1, not normalised (F, 3, 3)
        vertex: of corner k, not normalised (F, 3, 3)
    """

    face: Array
    edge: Array
    vertex: Array


def unit(vectors: Array) -> Array:
    """Vectors (..., 3) scaled to length one; zero stays zero."""
    length = np.linalg.norm(vectors, axis=-1, keepdims=True)
    return np.divide(vectors, length, out=np.zeros_like(vectors), where=length > 0.0)


def corner_angles(corners: Array) -> Array:
    """Interior angles [rad] (F, 3) of triangles (F, 3, 3)."""
    ahead = unit(np.roll(corners, -1, axis=1) - corners)
    behind = unit(np.roll(corners, 1, axis=1) - corners)
    # atan2 of both keeps thin triangles exact where arccos loses half the digits.
    sine = np.linalg.norm(np.cross(ahead, behind), axis=-1)
    return np.arctan2(sine, np.sum(ahead * behind, axis=-1))


def face_normals(corners: Array) -> Array:
    """Unit normals (F, 3) of triangles (F, 3, 3) by the right-hand rule, zero without area."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return unit(np.cross(unit(b - a), unit(c - a)))


def _sum_at(index: IntArray, vectors: Array, size: int) -> Array:
    sums = [np.bincount(index, vectors[:, d], size) for d in range(3)]
    return np.stack(sums, axis=1).astype(np.float64)


def pseudonormals(vertices: Array, faces: IntArray, is_open: BoolArray) -> Normals:
    """Angle-weighted pseudonormals of a closed, outward-oriented surface.

    At the rim of an open facet only the facet's own normal counts. The guide that ends there is
    perpendicular to the facet, so a point whose nearest wall point is on the rim is beyond the
    facet's plane, hence outside; the usual mean would let a 45 degree cone count as inside.

    Arguments:
        vertices: [m] (V, 3)
        faces: (F, 3)
        is_open: triangles that close the surface but are no walls (F,)
    """
    corners = vertices[faces]
    face = face_normals(corners)
    rim = np.zeros(len(vertices), dtype=np.bool_)
    rim[faces[is_open]] = True
    counts = is_open[:, None] | ~rim[faces]
    weight = corner_angles(corners) * counts
    weighted = (weight[:, :, None] * face[:, None, :]).reshape(-1, 3)
    vertex = _sum_at(faces.ravel(), weighted, len(vertices))
    edges, _ = edges_of(faces)
    touches_open = np.bincount(edges.ravel(), np.repeat(is_open, 3), edges.max() + 1) > 0
    use = (is_open[:, None] | ~touches_open[edges]).ravel()
    per_edge = _sum_at(edges.ravel(), np.repeat(face, 3, axis=0) * use[:, None], edges.max() + 1)
    return Normals(face, per_edge[edges], vertex[faces])
