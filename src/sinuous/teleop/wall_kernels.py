"""Planes in which walls stop the tip, from tick to tick, compiled."""

from math import sqrt

from sinuous.arrays import Array
from sinuous.compiled import inner

NEGLIGIBLE = 1e-6
"""A way that is no wall any longer [m]."""


@inner
def beyond(p: Array, place: Array, way: Array, out: Array) -> float:
    """The way (3,) [m] to a plane for a point p on its far side, zero for others; its length."""
    size, depth = 0.0, 0.0
    for i in range(3):
        size += way[i] * way[i]
        depth += way[i] * (place[i] - p[i])
    size = sqrt(size)
    depth = max(depth / size, 0.0) if size > 0.0 else 0.0
    for i in range(3):
        out[i] = way[i] / size * depth if depth > 0.0 else 0.0
    return depth


@inner
def settle(
    p: Array,
    place: Array,
    way: Array,
    now_place: Array,
    now_way: Array,
    share: float,
    new_place: Array,
    new_way: Array,
) -> None:
    """The plane (new_place, new_way) at p, a tick after (place, way), see `held.Settling`."""
    size, left = 0.0, 0.0
    for i in range(3):
        size += way[i] * way[i]
    now = beyond(p, now_place, now_way, new_place)
    expected = beyond(p, place, way, new_way)
    most = max(sqrt(size), now)
    scale = most / expected if expected > most else 1.0
    for i in range(3):
        new_way[i] = (1.0 - share) * scale * new_way[i] + share * new_place[i]
        left += new_way[i] * new_way[i]
    for i in range(3):
        if left < NEGLIGIBLE * NEGLIGIBLE:
            new_way[i] = 0.0
        new_place[i] = p[i] + new_way[i]
