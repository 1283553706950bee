"""Angle-weighted pseudonormals of a closed triangle surface."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel
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


def face_normals(corners: Array) -> Array:
    """Unit normals (F, 3) of triangles (F, 3, 3) by the right-hand rule, zero without area."""
    return _face_normals(np.ascontiguousarray(corners))


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
    corners = np.ascontiguousarray(vertices[faces])
    face = _face_normals(corners)
    edges, count = edges_of(faces)
    per_edge = _edge_normals(face, edges, is_open, len(count))
    per_vertex = _vertex_normals(corners, face, faces, is_open, len(vertices))
    return Normals(face, per_edge[edges], per_vertex[faces])


@kernel
def _between(a: Array, b: Array) -> tuple[float, float, float]:
    """Unit vector from a to b (3,), zero if they are the same."""
    x, y, z = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    length = np.sqrt(x * x + y * y + z * z)
    return (x / length, y / length, z / length) if length > 0.0 else (0.0, 0.0, 0.0)


@kernel
def _across(
    u: tuple[float, float, float], v: tuple[float, float, float]
) -> tuple[float, float, float]:
    """Cross product."""
    return u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]


@kernel
def _face_normals(corners: Array) -> Array:
    normal = np.zeros((corners.shape[0], 3))
    for s in range(corners.shape[0]):
        a, b, c = corners[s, 0], corners[s, 1], corners[s, 2]
        x, y, z = _across(_between(a, b), _between(a, c))
        length = np.sqrt(x * x + y * y + z * z)
        if length > 0.0:
            normal[s, 0], normal[s, 1], normal[s, 2] = x / length, y / length, z / length
    return normal


@kernel
def _edge_normals(face: Array, edges: IntArray, is_open: BoolArray, count: int) -> Array:
    """Sum (count, 3) of the normals at every edge, of open triangles only where there is one."""
    touches_open = np.zeros(count, np.bool_)
    for s in np.flatnonzero(is_open):
        touches_open[edges[s]] = True
    total = np.zeros((count, 3))
    for s in range(face.shape[0]):
        for k in range(3):
            if is_open[s] or not touches_open[edges[s, k]]:
                total[edges[s, k]] += face[s]
    return total


@kernel
def _vertex_normals(
    corners: Array, face: Array, faces: IntArray, is_open: BoolArray, count: int
) -> Array:
    """Sum (count, 3) of the normals at every vertex, weighted by the angles there."""
    rim = np.zeros(count, np.bool_)
    for s in np.flatnonzero(is_open):
        rim[faces[s]] = True
    total = np.zeros((count, 3))
    for s in range(face.shape[0]):
        for k in range(3):
            if is_open[s] or not rim[faces[s, k]]:
                here = corners[s, k]
                u = _between(here, corners[s, (k + 1) % 3])
                v = _between(here, corners[s, (k + 2) % 3])
                x, y, z = _across(u, v)
                # atan2 of both keeps thin triangles exact where arccos loses half the digits.
                cosine = u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
                angle = np.arctan2(np.sqrt(x * x + y * y + z * z), cosine)
                total[faces[s, k]] += angle * face[s]
    return total
