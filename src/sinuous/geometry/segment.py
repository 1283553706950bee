"""Whether a short straight way stays clear of all walls: exact, with the same tree of boxes.

Source of the distance between two segments: Ericson, Real-Time Collision Detection (2005), 5.1.9.
"""

from sinuous.arrays import IntArray
from sinuous.compiled import inner
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.triangle import closest


@inner
def is_clear(
    zone: ZoneArrays,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
    distance: float,
    stack: IntArray,
) -> bool:
    """Whether no point from a to b is closer than `distance` [m] to a constraining triangle.

    The distance is without sign: a way that starts on the free side and is clear by a positive
    distance stays on the free side.

    Arguments:
        zone: the surfaces
        ax, ay, az, bx, by, bz: ends of the way [m]
        distance: [m], positive
        stack: room for `bvh.STACK` boxes
    """
    for k in range(zone.roots.size):
        stack[0] = zone.roots[k]
        top = 1
        while top > 0:
            top -= 1
            node = stack[top]
            if _misses_box(zone, node, ax, ay, az, bx, by, bz, distance):
                continue
            first = zone.child[node]
            if zone.leaf[node] == 0:
                stack[top], stack[top + 1] = first + 1, first
                top += 2
                continue
            for s in range(first, first + zone.leaf[node]):
                if _is_near(zone, s, ax, ay, az, bx, by, bz, distance):
                    return False
    return True


@inner
def _misses_box(
    zone: ZoneArrays,
    node: int,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
    distance: float,
) -> bool:
    """Whether the box, grown by the distance, has no common point with the box around the way.

    Ways are short beside boxes that matter, so their own box is as good as the segment.
    """
    low, high = zone.lower, zone.upper
    return (
        max(ax, bx) < low[node, 0] - distance
        or min(ax, bx) > high[node, 0] + distance
        or max(ay, by) < low[node, 1] - distance
        or min(ay, by) > high[node, 1] + distance
        or max(az, bz) < low[node, 2] - distance
        or min(az, bz) > high[node, 2] + distance
    )


@inner
def _is_near(
    zone: ZoneArrays,
    s: int,
    ax: float,
    ay: float,
    az: float,
    bx: float,
    by: float,
    bz: float,
    distance: float,
) -> bool:
    """Whether triangle s is closer than `distance` to the segment from a to b."""
    corners, normals = zone.corners, zone.winding_normal
    nx, ny, nz = normals[s, 0], normals[s, 1], normals[s, 2]
    ox, oy, oz = corners[s, 0, 0], corners[s, 0, 1], corners[s, 0, 2]
    here = nx * (ax - ox) + ny * (ay - oy) + nz * (az - oz)
    there = nx * (bx - ox) + ny * (by - oy) + nz * (bz - oz)
    if here * there > 0.0 and min(abs(here), abs(there)) >= distance:
        return False
    limit = distance * distance
    if closest(corners, normals, s, ax, ay, az)[0] < limit:
        return True
    if closest(corners, normals, s, bx, by, bz)[0] < limit:
        return True
    for k in range(3):
        j = (k + 1) % 3
        d2 = _between(
            ax, ay, az, bx - ax, by - ay, bz - az,
            corners[s, k, 0], corners[s, k, 1], corners[s, k, 2],
            corners[s, j, 0] - corners[s, k, 0],
            corners[s, j, 1] - corners[s, k, 1],
            corners[s, j, 2] - corners[s, k, 2],
        )  # fmt: skip
        if d2 < limit:
            return True
    if here * there < 0.0:
        t = here / (here - there)
        x, y, z = ax + t * (bx - ax), ay + t * (by - ay), az + t * (bz - az)
        return closest(corners, normals, s, x, y, z)[0] < limit
    return False


@inner
def _between(
    px: float,
    py: float,
    pz: float,
    ux: float,
    uy: float,
    uz: float,
    qx: float,
    qy: float,
    qz: float,
    vx: float,
    vy: float,
    vz: float,
) -> float:
    """Squared distance of the segments from p along u and from q along v."""
    rx, ry, rz = px - qx, py - qy, pz - qz
    uu, vv = ux * ux + uy * uy + uz * uz, vx * vx + vy * vy + vz * vz
    ur, vr = ux * rx + uy * ry + uz * rz, vx * rx + vy * ry + vz * rz
    uv = ux * vx + uy * vy + uz * vz
    det = uu * vv - uv * uv
    s = min(max((uv * vr - ur * vv) / det, 0.0), 1.0) if det > 1e-12 * uu * vv else 0.0
    t = (uv * s + vr) / vv if vv > 0.0 else 0.0
    if t < 0.0 or t > 1.0:
        t = min(max(t, 0.0), 1.0)
        s = min(max((uv * t - ur) / uu, 0.0), 1.0) if uu > 0.0 else 0.0
    x, y, z = rx + s * ux - t * vx, ry + s * uy - t * vy, rz + s * uz - t * vz
    return x * x + y * y + z * z
