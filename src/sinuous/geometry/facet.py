"""Planar facets: connected triangles in one plane."""

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import kernel
from sinuous.geometry.normals import face_normals
from sinuous.geometry.surface import Part, Surface
from sinuous.geometry.topology import paired

PLANE = 1e-6  # share of the mesh's size by which a facet's vertices may leave its plane
ANGLE = 0.01  # between the normals of a facet's triangles [rad]


def flatness(surface: Surface) -> float:
    """How far the vertices of a facet may leave its plane [m]."""
    return PLANE * float(np.ptp(surface.vertices, axis=0).max())


def largest_facet(surface: Surface, seeds: BoolArray) -> BoolArray:
    """Triangles (F,) of the largest of the planar facets that the seeds (F,) belong to.

    The caps that touch one another are one facet; elsewhere it is the connected coplanar triangles.
    """
    corners = np.ascontiguousarray(surface.vertices[surface.faces])
    a, b = paired(surface.faces).T
    beside = np.empty(surface.faces.size, dtype=np.int64)
    beside[a], beside[b] = b // 3, a // 3
    facet = np.zeros(len(seeds), dtype=np.bool_)
    facet[
        _largest(
            np.flatnonzero(seeds),
            corners,
            face_normals(corners),
            beside.reshape(-1, 3),
            surface.part == Part.CAP,
            flatness(surface),
        )
    ] = True
    return facet


@kernel
def _largest(
    seeds: IntArray,
    corners: Array,
    normals: Array,
    beside: IntArray,
    is_cap: BoolArray,
    tolerance: float,
) -> IntArray:
    """Triangles of the facet with the largest area; of several, that of the first seed."""
    n = corners.shape[0]
    done, met = np.zeros(n, np.bool_), np.full(n, -1, np.int64)
    found, best, best_area = np.empty(n, np.int64), np.empty(0, np.int64), -1.0
    for seed in seeds:
        if done[seed]:
            continue
        size = _grow(seed, corners, normals, beside, is_cap, tolerance, met, found)
        area = 0.0
        for t in found[:size]:
            done[t] = True
            c = corners[t]
            x, y, z = np.cross(c[1] - c[0], c[2] - c[0])
            area += np.sqrt(x * x + y * y + z * z) / 2.0
        if area > best_area:
            best, best_area = found[:size].copy(), area
    return best


@kernel
def _grow(
    seed: int,
    corners: Array,
    normals: Array,
    beside: IntArray,
    is_cap: BoolArray,
    tolerance: float,
    met: IntArray,
    found: IntArray,
) -> int:
    """Fill `found` with the triangles of the facet around `seed`; returns how many they are.

    Arguments:
        beside: the triangles beyond the edges of every triangle (F, 3)
        met: the last seed from which a triangle was reached (F,), kept between calls
    """
    found[0], met[seed] = seed, seed
    size, at = 1, 0
    while at < size:
        for t in beside[found[at]]:
            if met[t] == seed:
                continue
            met[t] = seed
            flat = is_cap[t] if is_cap[seed] else _coplanar(seed, t, corners, normals, tolerance)
            if flat:
                found[size] = t
                size += 1
        at += 1
    return size


@kernel
def _coplanar(seed: int, t: int, corners: Array, normals: Array, tolerance: float) -> bool:
    """Whether triangle t lies in the plane of triangle `seed`."""
    n = normals[seed]
    cosine = n[0] * normals[t, 0] + n[1] * normals[t, 1] + n[2] * normals[t, 2]
    if cosine < np.cos(ANGLE):
        return False
    for k in range(3):
        away = corners[t, k] - corners[seed, 0]
        if abs(away[0] * n[0] + away[1] * n[1] + away[2] * n[2]) > tolerance:
            return False
    return True
