"""Polygons with their colours: bodies as shaded tubes with disks, walls as if of glass."""

from dataclasses import dataclass

import numpy as np
from matplotlib.colors import to_rgb

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray

AROUND = 20  # corners of a cross-section
CORE = 0.5  # radius of the backbone that is drawn between disks, as a share of the disks'
THICKNESS = 0.28  # of a disk, as a share of the distance from one disk to the next
SAME = 1e-9  # [m] between two points that are one
LIGHT = np.array([-0.35, -0.5, 0.79])  # where it comes from
SHADE = 0.66  # brightness of what the light does not reach
FINEST = 64  # splits of a triangle; more would show nothing new
NO_TUBES: IntArray = np.zeros((0, 2), dtype=np.int64)


@dataclass(frozen=True, kw_only=True, eq=False)
class Solid:
    """Polygons (M, 4, 3) [m], wound outward, and their colours (M, 4) before any light."""

    polygons: Array
    colors: Array

    @property
    def normals(self) -> Array:
        """Outward unit normals (M, 3)."""
        return normals_of(self.polygons)

    def lit(self) -> Array:
        """Colours (M, 4) under the light."""
        bright = SHADE + (1.0 - SHADE) * np.clip(self.normals @ LIGHT, 0.0, 1.0)
        return np.column_stack([self.colors[:, :3] * bright[:, None], self.colors[:, 3]])

    def facing(self, towards: Array) -> "Solid":
        """Only the polygons that a viewer in that direction sees."""
        seen = self.normals @ towards > 0.0
        return Solid(polygons=self.polygons[seen], colors=self.colors[seen])


def together(solids: list[Solid]) -> Solid:
    """Several solids as one, so that what is nearer hides what is behind."""
    return Solid(
        polygons=np.concatenate([np.empty((0, 4, 3)), *(s.polygons for s in solids)]),
        colors=np.concatenate([np.empty((0, 4)), *(s.colors for s in solids)]),
    )


def normals_of(polygons: Array) -> Array:
    """Unit normals (M, 3) of triangles or quadrangles (M, 3 or 4, 3)."""
    across = np.cross(polygons[:, 2] - polygons[:, 0], polygons[:, -1] - polygons[:, 1])
    return across / np.maximum(np.linalg.norm(across, axis=1, keepdims=True), 1e-300)


def wire(points: Array, radius: float, color: ArrayLike) -> Solid:
    """A line (S, 3) of visible thickness."""
    path = _distinct(points)
    return _painted(_tube(points[path], np.full(len(path), radius), 6), color)


def body(
    points: Array, radii: Array, disks: IntArray, color: ArrayLike, tubes: IntArray = NO_TUBES
) -> Solid:
    """A robot: a backbone with disks, solid before the first and behind the last of them.

    Arguments:
        points: (S, 3) [m]
        radii: (S,) [m]
        disks: which of the points are centres of disks (D,); without any all is solid
        color: of disks and tubes
        tubes: first and last point of every stretch that is solid (T, 2); its ends are no disks
    """
    path = _distinct(points)
    slim = np.ones(len(points))
    if len(disks) > 1:
        before = 2 * disks[0] - disks[1]  # where the first disk's distance begins
        slim[before + 1 if before > 0 else 0 : disks[-1]] = CORE
    dark = np.asarray(to_rgb(tuple(np.asarray(color)[:3]))) * 0.8
    solids = [_painted(_tube(points[path], (radii * slim)[path], AROUND), dark)]
    if len(disks) > 1:
        along = np.gradient(points, axis=0)
        along /= np.maximum(np.linalg.norm(along, axis=1, keepdims=True), SAME)
        gaps = np.linalg.norm(np.diff(points[disks], axis=0), axis=1)
        half = 0.5 * THICKNESS * float(np.mean(gaps))
        inside = np.any((tubes[:, :1] <= disks) & (disks <= tubes[:, 1:]), axis=0)
        for i in disks[~inside]:
            ends = points[i] + half * np.outer((-1.0, 1.0), along[i])
            solids.append(_painted(_tube(ends, radii[[i, i]], AROUND), color))
    for first, last in tubes:
        own = first + _distinct(points[first : last + 1])
        solids.append(_painted(_tube(points[own], radii[own], AROUND), color))
    return together(solids)


def block(triangles: Array, size: float, color: ArrayLike) -> Solid:
    """Triangles (T, 3, 3), split up so that no edge is much longer than `size` [m].

    Drawing sorts polygons by the distance of their centres, which is right for small ones only.
    """
    for _ in range(FINEST):
        sides = np.linalg.norm(np.roll(triangles, -1, axis=1) - triangles, axis=2)
        longest = sides.argmax(axis=1)
        large = sides.max(axis=1) > size
        if not large.any():
            break
        order = (np.arange(3)[None, :] + longest[large, None]) % 3
        a, b, c = np.swapaxes(np.take_along_axis(triangles[large], order[:, :, None], axis=1), 0, 1)
        m = (a + b) / 2.0
        halves = [np.stack([a, m, c], axis=1), np.stack([m, b, c], axis=1)]
        triangles = np.concatenate([triangles[~large], *halves])
    return _painted(np.concatenate([triangles, triangles[:, 2:]], axis=1), color)


def glass(triangles: Array, towards: Array, color: str, faint: float, rim: float) -> Array:
    """Colours (T, 4) of triangles as if they were of glass: clear where one looks straight in."""
    grazing = 1.0 - np.abs(normals_of(triangles) @ towards)
    alpha = faint + (rim - faint) * grazing**3
    return np.column_stack([np.tile(to_rgb(color), (len(triangles), 1)), alpha])


def cropped(triangles: Array, low: Array, high: Array) -> list[Array]:
    """Convex polygons (K, 3): what of the triangles (T, 3, 3) lies in a box."""
    kept: list[Array] = []
    for polygon in triangles:
        for axis in range(3):
            polygon = _cut(polygon, polygon[:, axis] - low[axis])
            polygon = _cut(polygon, high[axis] - polygon[:, axis])
        if len(polygon) > 2:
            kept.append(polygon)
    return kept


def _cut(polygon: Array, room: Array) -> Array:
    """The part of a polygon (K, 3) whose corners have room (K,), zero or more, beside a plane."""
    corners: list[Array] = []
    for i in range(len(polygon)):
        j = (i + 1) % len(polygon)
        if room[i] >= 0.0:
            corners.append(polygon[i])
        if room[i] * room[j] < 0.0:
            share = room[i] / (room[i] - room[j])
            corners.append(polygon[i] + share * (polygon[j] - polygon[i]))
    return np.array(corners).reshape(-1, 3)


def _painted(polygons: Array, color: ArrayLike) -> Solid:
    rgba = np.append(np.asarray(color, dtype=np.float64)[:3], 1.0)
    return Solid(polygons=polygons, colors=np.tile(rgba, (len(polygons), 1)))


def _distinct(points: Array) -> IntArray:
    """Indices of the points that are not where the point before them is."""
    moved: BoolArray = np.linalg.norm(np.diff(points, axis=0), axis=1) > SAME
    return np.flatnonzero(np.concatenate([[True], moved]))


def _tube(path: Array, radii: Array, around: int) -> Array:
    """Quadrangles (M, 4, 3) of a closed tube around a path (S, 3)."""
    if len(path) < 2:
        return np.empty((0, 4, 3))
    along = np.gradient(path, axis=0)
    along /= np.linalg.norm(along, axis=1, keepdims=True)
    across = np.empty_like(path)
    last = np.eye(3)[np.argmin(np.abs(along[0]))]
    for k, t in enumerate(along):  # carried along without any twist
        last = last - (last @ t) * t
        last = last / np.linalg.norm(last)
        across[k] = last
    ends = np.concatenate([[0], np.arange(len(path)), [len(path) - 1]])
    reach = np.concatenate([[0.0], radii, [0.0]])[:, None, None]
    angle = 2.0 * np.pi * np.arange(around + 1) / around
    other = np.cross(along, across)
    arm = across[:, None] * np.cos(angle)[:, None] + other[:, None] * np.sin(angle)[:, None]
    rings = path[ends][:, None] + reach * arm[ends]
    corners = (rings[:-1, :-1], rings[:-1, 1:], rings[1:, 1:], rings[1:, :-1])
    return np.stack(corners, axis=2).reshape(-1, 4, 3)
