"""Meshes and points that several geometry tests share."""

import numpy as np
import trimesh

from sinuous.arrays import Array
from sinuous.geometry import shapes


def l_shape() -> trimesh.Trimesh:
    """A right-angled bend: a non-convex prism with sharp edges and a reflex one, 0.2 m long."""
    outline = np.array([(0, 0), (2, 0), (2, 1), (1, 1), (1, 3), (0, 3)]) * 0.066
    low = np.column_stack([outline, np.zeros(6)])
    high = low + np.array([0.0, 0.0, 0.07])
    lid = np.array([(0, 1, 2), (0, 2, 3), (0, 3, 5), (3, 4, 5)])
    i = np.arange(6)
    j = (i + 1) % 6
    walls = np.concatenate([np.stack([i, j, j + 6], 1), np.stack([i, j + 6, i + 6], 1)])
    return trimesh.Trimesh(
        np.concatenate([low, high]),
        np.concatenate([lid[:, ::-1], lid + 6, walls]),
        process=False,
    )


def stress_tube(*, caps: bool = True) -> trimesh.Trimesh:
    """The scene of the measurements: radius 25 mm, bend radius 80 mm, 696 triangles if closed."""
    return shapes.tube(shapes.arc_path(0.08, 2.0, stations=29), 0.025, sections=12, caps=caps)


def bumpy(seed: int = 3) -> trimesh.Trimesh:
    """A random tube with a rough wall."""
    return shapes.bumpy_tube(np.random.default_rng(seed), roughness=0.3)


# trimesh compares squared distances with absolute tolerances of 1e-8: in metres that is an error of
# 0.03 mm. A power of two scales without rounding, and leaves 1e-10 m of it.
FINE = 2.0**20


def distance_by_trimesh(mesh: trimesh.Trimesh, points: Array) -> Array:
    """Unsigned distance [m] of points (N, 3) to a mesh, by trimesh."""
    large = mesh.copy()
    large.apply_scale(FINE)
    _, distance, _ = trimesh.proximity.closest_point(large, FINE * points)
    return np.asarray(distance) / FINE


def foot_by_trimesh(triangles: Array, points: Array) -> Array:
    """Nearest points [m] (N, 3), of one triangle (N, 3, 3) for each point, by trimesh."""
    return trimesh.triangles.closest_point(FINE * triangles, FINE * points) / FINE


SCENES = {
    "l_shape": l_shape,
    "bumpy_tube": bumpy,
    "capsule": lambda: shapes.capsule((0.01, 0.02, 0.03), (0.05, -0.04, 0.12), 0.02),
    "stress_tube": stress_tube,
}


def points_around(mesh: trimesh.Trimesh, rng: np.random.Generator, count: int = 10_000) -> Array:
    """Points in and around a mesh: half of them 1e-9 to 1e-2 m from its edges and vertices."""
    quarter = count // 4
    low, high = mesh.bounds
    room = 0.3 * (high - low)
    free = rng.uniform(low - room, high + room, (count - 2 * quarter, 3))
    corners = mesh.vertices[rng.integers(len(mesh.vertices), size=quarter)]
    ends = mesh.vertices[mesh.edges_unique[rng.integers(len(mesh.edges_unique), size=quarter)]]
    share = rng.uniform(size=(quarter, 1))
    along = share * ends[:, 0] + (1.0 - share) * ends[:, 1]
    near = np.concatenate([corners, along])
    direction = rng.normal(size=near.shape)
    direction /= np.linalg.norm(direction, axis=1, keepdims=True)
    offset = 10.0 ** rng.uniform(-9.0, -2.0, (len(near), 1))
    return np.concatenate([free, near + offset * direction])
