"""Distance from a point to one triangle, with the feature (face, edge, vertex) that is nearest.

The kernels take coordinates one by one: views of arrays inside the loop would cost more than the
arithmetic.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner, kernel

FACE = 0
EDGE = 1  # EDGE + k: the edge from corner k to corner k + 1
VERTEX = 4  # VERTEX + k: corner k


@inner
def _on_edge(
    px: float, py: float, pz: float, rx: float, ry: float, rz: float, k: int, j: int
) -> tuple[float, float, float, float, int]:
    """Nearest point of edge k, between corners k and j, as `closest` returns it.

    The point is given relative to both corners, and so is the offset from the foot to it: that is
    exact however far from the origin all of it happens.
    """
    ux, uy, uz = px - rx, py - ry, pz - rz
    along = ux * px + uy * py + uz * pz
    length2 = ux * ux + uy * uy + uz * uz
    if along <= 0.0:
        dx, dy, dz, feature = px, py, pz, VERTEX + k
    elif along >= length2:
        dx, dy, dz, feature = rx, ry, rz, VERTEX + j
    else:
        # From the nearer end, so that a point near the other is not spoilt by a long edge.
        t = along / length2
        feature = EDGE + k
        if t <= 0.5:
            dx, dy, dz = px - t * ux, py - t * uy, pz - t * uz
        else:
            t = 1.0 - t
            dx, dy, dz = rx + t * ux, ry + t * uy, rz + t * uz
    return dx * dx + dy * dy + dz * dz, dx, dy, dz, feature


@inner
def closest(
    corners: Array, normals: Array, s: int, x: float, y: float, z: float
) -> tuple[float, float, float, float, int]:
    """Nearest point (the foot) of triangle s to (x, y, z).

    The foot inside the face is taken along the unit normal rather than from barycentric
    coordinates, which keeps thin triangles as exact as fat ones; a triangle without area (zero
    normal) is the union of its edges.

    Arguments:
        corners: triangles [m] (L, 3, 3)
        normals: their unit normals by the right-hand rule (L, 3), zero without area
        s: which triangle
        x, y, z: the point [m]

    Returns:
        squared distance [m^2], the point's offset from the foot [m], and FACE, EDGE + k or
        VERTEX + k
    """
    nx, ny, nz = normals[s, 0], normals[s, 1], normals[s, 2]
    ax, ay, az = x - corners[s, 0, 0], y - corners[s, 0, 1], z - corners[s, 0, 2]
    bx, by, bz = x - corners[s, 1, 0], y - corners[s, 1, 1], z - corners[s, 1, 2]
    cx, cy, cz = x - corners[s, 2, 0], y - corners[s, 2, 1], z - corners[s, 2, 2]
    # (a - p) x (b - p) . n is positive where p is on the inner side of the edge from a to b.
    first = nx * (ay * bz - az * by) + ny * (az * bx - ax * bz) + nz * (ax * by - ay * bx)
    second = nx * (by * cz - bz * cy) + ny * (bz * cx - bx * cz) + nz * (bx * cy - by * cx)
    third = nx * (cy * az - cz * ay) + ny * (cz * ax - cx * az) + nz * (cx * ay - cy * ax)
    if first > 0.0 and second > 0.0 and third > 0.0:
        h = nx * ax + ny * ay + nz * az
        return h * h, h * nx, h * ny, h * nz, FACE
    # Only an edge that the point is on the outer side of can be nearest.
    best = (np.inf, 0.0, 0.0, 0.0, FACE)
    if first <= 0.0:
        best = _on_edge(ax, ay, az, bx, by, bz, 0, 1)
    if second <= 0.0:
        other = _on_edge(bx, by, bz, cx, cy, cz, 1, 2)
        if other[0] < best[0]:
            best = other
    if third <= 0.0:
        other = _on_edge(cx, cy, cz, ax, ay, az, 2, 0)
        if other[0] < best[0]:
            best = other
    return best


@kernel
def distances(corners: Array, normals: Array, p: Array) -> Array:
    """Distance [m] (F,) from p (3,) to each of the triangles (F, 3, 3) with unit normals (F, 3)."""
    away = np.empty(corners.shape[0])
    for s in range(corners.shape[0]):
        away[s] = np.sqrt(closest(corners, normals, s, p[0], p[1], p[2])[0])
    return away
