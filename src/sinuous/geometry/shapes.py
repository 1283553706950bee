"""Makers of closed meshes in metres, wound outward: tubes, capsules, boxes, spheres, spikes."""

import numpy as np
import trimesh

from sinuous.arrays import Array, ArrayLike, IntArray


def _skin(rings: Array, ends: tuple[Array, Array] | None) -> trimesh.Trimesh:
    """Join rings (K, M, 3), each anticlockwise seen from ahead, and close both ends by fans.

    Arguments:
        ends: the middle of the first and of the last fan (3,), None leaves the ends open
    """
    count, around = rings.shape[:2]
    k, m = np.meshgrid(np.arange(count - 1), np.arange(around), indexing="ij")
    a, b = (k * around + m).ravel(), (k * around + (m + 1) % around).ravel()
    faces = [np.stack([a, b, b + around], 1), np.stack([a, b + around, a + around], 1)]
    vertices = [rings.reshape(-1, 3)]
    if ends is not None:
        here = np.arange(around)
        ahead = (here + 1) % around
        last, middle = (count - 1) * around, np.full(around, count * around)
        faces += [np.stack([ahead, here, middle], 1)]
        faces += [np.stack([last + here, last + ahead, middle + 1], 1)]
        vertices += [np.stack(ends)]
    return trimesh.Trimesh(np.concatenate(vertices), np.concatenate(faces), process=False)


def _across(tangent: Array) -> Array:
    """Some unit vector (3,) perpendicular to a unit vector (3,)."""
    helper = np.eye(3)[int(np.argmin(np.abs(tangent)))]
    side = helper - (helper @ tangent) * tangent
    return side / np.linalg.norm(side)


def path_frames(path: Array) -> tuple[Array, Array]:
    """Tangents and rotation-minimising sides of a path.

    Arguments:
        path: stations [m] (K, 3)

    Returns:
        unit tangents (K, 3) and unit vectors (K, 3) across them that do not twist

    Raises:
        ValueError: if the path has fewer than two stations, repeats one, or turns back on itself

    Source: Wang et al., Computation of rotation minimizing frames, ACM TOG 27 (2008), double
    reflection.
    """
    steps = np.diff(path, axis=0)
    length = np.linalg.norm(steps, axis=1, keepdims=True)
    if len(path) < 2 or not np.isfinite(path).all() or np.any(length == 0.0):
        raise ValueError("a path needs two or more different, finite stations in a row")
    steps = steps / length
    tangent = np.concatenate([steps[:1], steps[:-1] + steps[1:], steps[-1:]])
    size = np.linalg.norm(tangent, axis=1, keepdims=True)
    if np.any(size < 1e-9):
        raise ValueError("the path turns back on itself")
    tangent = tangent / size
    side = np.empty_like(tangent)
    side[0] = _across(tangent[0])
    for i in range(len(path) - 1):
        v = path[i + 1] - path[i]
        r = side[i] - 2.0 * (v @ side[i]) / (v @ v) * v
        t = tangent[i] - 2.0 * (v @ tangent[i]) / (v @ v) * v
        w = tangent[i + 1] - t
        # Without a bend both reflections are the same and cancel.
        side[i + 1] = r - 2.0 * (w @ r) / (w @ w) * w if w @ w > 0.0 else r
    return tangent, side


def _rings(path: Array, radius: Array, tangent: Array, side: Array) -> Array:
    """Circles (K, M, 3) across a path, radius (K, M)."""
    angle = 2.0 * np.pi * np.arange(radius.shape[1]) / radius.shape[1]
    other = np.cross(tangent, side)
    spoke = (
        np.cos(angle)[None, :, None] * side[:, None] + np.sin(angle)[None, :, None] * other[:, None]
    )
    return path[:, None] + radius[:, :, None] * spoke


def tube(
    path: ArrayLike, radius: ArrayLike, *, sections: int = 24, caps: bool = True
) -> trimesh.Trimesh:
    """Make a tube along a path.

    Arguments:
        path: stations on its axis [m] (K, 3)
        radius: [m], one for all, one per station (K,), or one per vertex (K, sections)
        sections: vertices around
        caps: close the ends by flat fans

    Raises:
        ValueError: if a radius is not positive, or if the tube bends so sharply that neighbouring
            rings cut each other (a bend radius below the tube's)
    """
    stations = np.asarray(path, dtype=np.float64).reshape(-1, 3)
    tangent, side = path_frames(stations)
    wide = np.asarray(radius, dtype=np.float64)
    wide = np.broadcast_to(wide[:, None] if wide.ndim == 1 else wide, (len(stations), sections))
    if sections < 3 or not np.all((wide > 0.0) & np.isfinite(wide)):
        raise ValueError("a tube needs three or more sections and positive radii")
    rings = _rings(stations, wide, tangent, side)
    ahead = np.einsum("kmd,kd->km", rings[1:] - stations[:-1, None], tangent[:-1])
    behind = np.einsum("kmd,kd->km", rings[:-1] - stations[1:, None], tangent[1:])
    crossing = np.flatnonzero((ahead.min(axis=1) <= 0.0) | (behind.max(axis=1) >= 0.0))
    if len(crossing):
        k = int(crossing[0])
        raise ValueError(
            f"the tube cuts itself between stations {k} and {k + 1}: it bends more sharply than "
            f"its radius of {wide[k : k + 2].max():.3g} m allows"
        )
    return _skin(rings, (stations[0], stations[-1]) if caps else None)


def capsule(
    start: ArrayLike, end: ArrayLike, radius: float, *, sections: int = 24
) -> trimesh.Trimesh:
    """Make a capsule: all points within `radius` [m] of the line from start to end [m] (3,)."""
    a, b = np.asarray(start, dtype=np.float64), np.asarray(end, dtype=np.float64)
    if not radius > 0.0:
        raise ValueError("a capsule needs a positive radius")
    along = b - a
    axis = along / np.linalg.norm(along) if along @ along > 0.0 else np.array([0.0, 0.0, 1.0])
    quarter = max(sections // 4, 2)
    angle = np.arange(1, quarter + 1) * (np.pi / 2.0) / quarter
    low = a - radius * np.cos(angle)[:, None] * axis
    high = b + radius * np.cos(angle[::-1])[:, None] * axis
    girth = radius * np.sin(np.concatenate([angle, angle[::-1]]))
    stations = np.concatenate([low, high])
    if not along @ along > 0.0:  # a sphere has one equator, not two
        stations, girth = np.delete(stations, quarter, 0), np.delete(girth, quarter)
    n = len(stations)
    tangent, side = np.tile(axis, (n, 1)), np.tile(_across(axis), (n, 1))
    wide = np.broadcast_to(girth[:, None], (n, sections))
    rings = _rings(stations, wide, tangent, side)
    return _skin(rings, (a - radius * axis, b + radius * axis))


def spike(base: ArrayLike, tip: ArrayLike, radius: float, *, sections: int = 12) -> trimesh.Trimesh:
    """Make a cone from a disc of `radius` [m] around base to tip [m] (3,), for obstacles."""
    a, b = np.asarray(base, dtype=np.float64), np.asarray(tip, dtype=np.float64)
    if not (radius > 0.0 and np.linalg.norm(b - a) > 0.0):
        raise ValueError("a spike needs a positive radius and length")
    axis = (b - a) / np.linalg.norm(b - a)
    wide = np.full((1, sections), float(radius))
    return _skin(_rings(a[None], wide, axis[None], _across(axis)[None]), (a, b))


def box(extents: ArrayLike, *, centre: ArrayLike = (0.0, 0.0, 0.0)) -> trimesh.Trimesh:
    """Make a box of the given extents [m] (3,) around a centre [m] (3,)."""
    half = np.asarray(extents, dtype=np.float64) / 2.0
    if not np.all(half > 0.0):
        raise ValueError("a box needs positive extents")
    square = np.array([[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]])
    rings = np.array([[(x, y, z) for x, y in square] for z in (-1.0, 1.0)])
    mesh = _skin(rings * half + np.asarray(centre, dtype=np.float64), None)
    ends: IntArray = np.array([[0, 2, 1], [0, 3, 2], [4, 5, 6], [4, 6, 7]])
    return trimesh.Trimesh(mesh.vertices, np.concatenate([mesh.faces, ends]), process=False)


def sphere(
    radius: float, *, centre: ArrayLike = (0.0, 0.0, 0.0), subdivisions: int = 3
) -> trimesh.Trimesh:
    """Make a sphere of nearly equal triangles; its vertices are at `radius` [m] from the centre."""
    if not radius > 0.0:
        raise ValueError("a sphere needs a positive radius")
    mesh = trimesh.creation.icosphere(subdivisions=subdivisions, radius=radius)
    vertices = np.asarray(mesh.vertices) + np.asarray(centre, dtype=np.float64)
    return trimesh.Trimesh(vertices, mesh.faces, process=False)


def arc_path(bend_radius: float, angle: float, *, stations: int = 29) -> Array:
    """Stations [m] (K, 3) on a circular arc from the origin, first along z, bending towards x.

    Arguments:
        bend_radius: of the arc [m]
        angle: that it covers [rad]
        stations: how many
    """
    a = np.linspace(0.0, angle, stations)
    x = 2.0 * np.sin(a / 2.0) ** 2  # 1 - cos, exact for small angles
    return bend_radius * np.stack([x, np.zeros_like(a), np.sin(a)], axis=1)


def wandering_path(
    rng: np.random.Generator, *, length: float = 0.2, bend: float = 8.0, stations: int = 40
) -> Array:
    """Stations [m] (K, 3) on a random smooth path from the origin that starts along z.

    Arguments:
        rng: source of the randomness
        length: of the path [m]
        bend: largest curvature [1/m]
        stations: how many
    """
    s = np.linspace(0.0, 1.0, 8 * (stations - 1) + 1)
    waves = 2.0 * np.pi * np.array([0.0, 0.5, 1.0, 1.5])
    amplitude, phase = rng.normal(size=(2, 4)), rng.uniform(0.0, 2.0 * np.pi, size=(2, 4))
    curvature = np.sum(
        amplitude[:, :, None] * np.cos(waves[None, :, None] * s + phase[:, :, None]), axis=1
    )
    largest = float(np.linalg.norm(curvature, axis=0).max())
    curvature *= bend * rng.uniform(0.5, 1.0) / largest
    step = length / (len(s) - 1)
    points, axis, side = [np.zeros(3)], np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0])
    for kx, ky in curvature.T[:-1]:
        other = np.cross(axis, side)
        axis = axis + step * (kx * side + ky * other)
        axis = axis / np.linalg.norm(axis)
        side = side - (side @ axis) * axis
        side = side / np.linalg.norm(side)
        points.append(points[-1] + step * axis)
    return np.array(points)[::8]


def bumpy_tube(
    rng: np.random.Generator,
    *,
    path: ArrayLike | None = None,
    radius: float = 0.025,
    roughness: float = 0.1,
    sections: int = 16,
    caps: bool = True,
) -> trimesh.Trimesh:
    """Make a tube with a random, bumpy wall.

    Arguments:
        rng: source of the randomness
        path: stations on its axis [m] (K, 3); by default a `wandering_path`
        radius: mean radius [m]
        roughness: largest deviation of the wall, as a share of the radius, below 1
        sections: vertices around
        caps: close the ends by flat fans

    Raises:
        ValueError: as in `tube`, or if the roughness is not in [0, 1)
    """
    if not 0.0 <= roughness < 1.0:
        raise ValueError("the roughness must be in [0, 1)")
    stations = wandering_path(rng) if path is None else np.asarray(path, dtype=np.float64)
    count = len(stations)
    slow = np.interp(
        np.linspace(0.0, 1.0, count), np.linspace(0.0, 1.0, 6), rng.uniform(-1.0, 1.0, 6)
    )
    fast = rng.uniform(-1.0, 1.0, (count, sections))
    wall = radius * (1.0 + roughness * 0.5 * (slow[:, None] + fast))
    return tube(stations, wall, sections=sections, caps=caps)
