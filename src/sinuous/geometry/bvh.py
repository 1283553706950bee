"""Exact signed distance to closed triangle surfaces: a tree of boxes, compiled.

Normals in the arrays point to the free side, so zone walls and keep-outs are treated alike: the
sign of (p - foot) . normal says on which side p is. With angle-weighted pseudonormals at edges and
vertices this sign is exact for closed surfaces.

Source: Baerentzen and Aanaes, Signed distance computation using the angle weighted pseudonormal,
IEEE TVCG 11 (2005).
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner, kernel
from sinuous.geometry.triangle import EDGE, FACE, VERTEX, closest

STACK = 64  # median splits: depth is log2(triangles), so 64 is never reached
# What is this little beyond the best is still looked at, so that rounding never prunes a tie: ties
# are settled by number, whatever the order of the points.
TIE = 1.0 + 1e-9
NEAR = 1e-12  # share of the scene's size below which p - foot says nothing about a direction


class ZoneArrays(NamedTuple):
    """All surfaces of a zone as flat arrays for compiled code; slots are in leaf order.

    Arguments:
        lower, upper, child, leaf: boxes as in `tree.Tree`, one surface after another (B, 3), (B,)
        roots: root box of every surface (K,)
        corners: corners of the constraining triangles [m] (L, 3, 3)
        winding_normal: unit normal by the right-hand rule (L, 3)
        face_normal: unit normal to the free side (L, 3)
        edge_normal: pseudonormal of the edge from corner k to k + 1, to the free side (L, 3, 3)
        vertex_normal: pseudonormal of corner k, to the free side (L, 3, 3)
        triangle: number of the triangle in the zone (L,)
        slot: where a triangle is stored, -1 if it is open and does not constrain (T,)
        scale: largest coordinate [m]
    """

    lower: Array
    upper: Array
    child: IntArray
    leaf: IntArray
    roots: IntArray
    corners: Array
    winding_normal: Array
    face_normal: Array
    edge_normal: Array
    vertex_normal: Array
    triangle: IntArray
    slot: IntArray
    scale: float


@inner
def _box(lower: Array, upper: Array, node: int, x: float, y: float, z: float) -> float:
    """Squared distance from a point to a box, zero inside."""
    dx = max(lower[node, 0] - x, x - upper[node, 0], 0.0)
    dy = max(lower[node, 1] - y, y - upper[node, 1], 0.0)
    dz = max(lower[node, 2] - z, z - upper[node, 2], 0.0)
    return dx * dx + dy * dy + dz * dz


@inner
def search(
    zone: ZoneArrays,
    root: int,
    x: float,
    y: float,
    z: float,
    bound: float,
    stack: IntArray,
    keys: Array,
) -> int:
    """Slot of the triangle of one surface nearest to a point; the lowest slot wins a tie.

    `bound` [m^2] is a squared distance that some triangle is known to be within.
    """
    lower, upper, child, leaf = zone.lower, zone.upper, zone.child, zone.leaf
    corners, normals = zone.corners, zone.winding_normal
    slack = (NEAR * zone.scale) ** 2
    best, found = bound * TIE + slack, -1
    stack[0], keys[0] = root, _box(lower, upper, root, x, y, z)
    top = 1
    while top > 0:
        top -= 1
        if keys[top] > best * TIE + slack:
            continue
        node = stack[top]
        first = int(child[node])
        if leaf[node] > 0:
            for s in range(first, first + leaf[node]):
                # The plane of a triangle is no farther than the triangle, and mostly settles it.
                h = (
                    normals[s, 0] * (x - corners[s, 0, 0])
                    + normals[s, 1] * (y - corners[s, 0, 1])
                    + normals[s, 2] * (z - corners[s, 0, 2])
                )
                if h * h > best * TIE + slack:
                    continue
                d2 = closest(corners, normals, s, x, y, z)[0]
                if d2 < best or (d2 == best and (found < 0 or s < found)):
                    best, found = d2, s
        else:
            left = _box(lower, upper, first, x, y, z)
            right = _box(lower, upper, first + 1, x, y, z)
            near = first if left <= right else first + 1
            far = 2 * first + 1 - near
            stack[top], keys[top] = far, max(left, right)
            stack[top + 1], keys[top + 1] = near, min(left, right)
            top += 2
    return found


@inner
def signed(
    zone: ZoneArrays, slot: int, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """Signed distance to the surface whose nearest triangle is `slot`, and its gradient."""
    d2, dx, dy, dz, feature = closest(zone.corners, zone.winding_normal, slot, x, y, z)
    if feature == FACE:
        n = zone.face_normal[slot]
    elif feature >= VERTEX:
        n = zone.vertex_normal[slot, feature - VERTEX]
    else:
        n = zone.edge_normal[slot, feature - EDGE]
    side = 1.0 if dx * n[0] + dy * n[1] + dz * n[2] >= 0.0 else -1.0
    distance = np.sqrt(d2)
    if feature == FACE:
        return side * distance, n[0], n[1], n[2]
    if distance <= NEAR * zone.scale:
        size = np.sqrt(n[0] * n[0] + n[1] * n[1] + n[2] * n[2])
        return side * distance, n[0] / size, n[1] / size, n[2] / size
    f = side / distance
    return side * distance, f * dx, f * dy, f * dz


@kernel
def nearest(
    zone: ZoneArrays, points: Array, clearance: Array, gradient: Array, triangle: IntArray
) -> None:
    """Signed distance of every point to the nearest wall, positive on the free side.

    With several surfaces the clearance is the least of their signed distances. Points along a body
    should come in order: each starts from its predecessor's triangle. The result does not depend
    on the order.

    Arguments:
        zone: the surfaces; none of them means no wall anywhere
        points: [m] (M, 3)
        clearance: filled with the signed distance [m] (M,), inf without walls, nan for points that
            are not finite
        gradient: filled with its unit gradient (M, 3), zero without walls
        triangle: filled with the number of the nearest triangle (M,), -1 without walls
    """
    stack, keys = np.empty(STACK, np.int64), np.empty(STACK)
    clearance[:] = np.inf
    gradient[:] = 0.0
    triangle[:] = -1
    for k in range(zone.roots.shape[0]):
        last = -1
        for i in range(points.shape[0]):
            x, y, z = points[i, 0], points[i, 1], points[i, 2]
            if not np.isfinite(x + y + z):
                clearance[i] = np.nan
                continue
            bound = np.inf
            if last >= 0:
                bound = closest(zone.corners, zone.winding_normal, last, x, y, z)[0]
            slot = search(zone, zone.roots[k], x, y, z, bound, stack, keys)
            last = slot
            d, gx, gy, gz = signed(zone, slot, x, y, z)
            if d < clearance[i]:
                clearance[i] = d
                gradient[i, 0], gradient[i, 1], gradient[i, 2] = gx, gy, gz
                triangle[i] = zone.triangle[slot]


@kernel
def plane(
    zone: ZoneArrays, slot: int, x: float, y: float, z: float
) -> tuple[float, float, float, float]:
    """Distance from a point on the free side to one triangle, and its unit gradient.

    The distance to a triangle is convex, so the plane d + n . (x - p) bounds the distance of
    every x from below: keeping it positive is safe, however far x is from p.

    Arguments:
        zone: the surfaces
        slot: where the triangle is stored
        x, y, z: the point p [m]

    Returns:
        d [m] and n; where p is almost on the triangle, n is the normal of its free side and d
        the height above it
    """
    d2, dx, dy, dz, feature = closest(zone.corners, zone.winding_normal, slot, x, y, z)
    distance = np.sqrt(d2)
    n = zone.face_normal[slot]
    height = dx * n[0] + dy * n[1] + dz * n[2]
    if distance <= NEAR * zone.scale:
        return height, n[0], n[1], n[2]
    if feature == FACE:
        s = 1.0 if height >= 0.0 else -1.0
        return distance, s * n[0], s * n[1], s * n[2]
    f = 1.0 / distance
    return distance, f * dx, f * dy, f * dz
