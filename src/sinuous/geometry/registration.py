"""Where a robot stands in a mesh, from points that are known in the frames of both."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array, ArrayLike

LEAST_SPREAD = 1e-3
"""Of points off a common line, over that along it: below it their rotation about the line is
guessed rather than measured."""

LARGE = 2e-3  # a root mean square residual that people should hear about [m]


@dataclass(frozen=True, kw_only=True, eq=False)
class Registration:
    """A rigid motion p_mesh = R p_robot + t.

    Arguments:
        rotation: R (3, 3)
        translation: t (3,) [m]
        residuals: distances that are left between the points of each pair (K,) [m]
    """

    rotation: Array
    translation: Array
    residuals: Array

    @property
    def rms(self) -> float:
        """Root mean square of the residuals, the fiducial registration error [m]."""
        return float(np.sqrt(np.mean(self.residuals**2)))

    @property
    def warning(self) -> str:
        """What to hear about before it is used; empty if all is well."""
        if self.rms <= LARGE:
            return ""
        worst = int(np.argmax(self.residuals))
        return (
            f"the points are {1e3 * self.rms:.1f} mm off, more than {1e3 * LARGE:g} mm; "
            f"the worst is point {worst + 1} with {1e3 * self.residuals[worst]:.1f} mm"
        )

    def apply(self, points: ArrayLike) -> Array:
        """Points of the robot's frame (..., 3) [m] in that of the mesh."""
        return np.asarray(points, dtype=np.float64) @ self.rotation.T + self.translation


def register(points_robot: ArrayLike, points_mesh: ArrayLike) -> Registration:
    """The rigid motion that takes points of the robot's frame closest to those of the mesh.

    The least sum of squares |R p_k + t - q_k|^2, by a singular value decomposition of the points
    about their centroids (Arun, Huang and Blostein 1987; Kabsch 1976).

    Arguments:
        points_robot: p (K, 3) [m], three or more
        points_mesh: q (K, 3) [m], in the same order

    Raises:
        ValueError: if there are fewer than three pairs, they are not finite, lie on a line or in
            one place, or the points of one frame are mirror images of those of the other
    """
    p, q = _points("points of the robot", points_robot), _points("points of the mesh", points_mesh)
    if len(p) != len(q):
        raise ValueError(f"a registration needs pairs, not {len(p)} points and {len(q)}")
    a, b = p - p.mean(axis=0), q - q.mean(axis=0)
    _refuse_mirrored(a, b)
    rotation = Rotation.align_vectors(b, a)[0].as_matrix()
    translation = q.mean(axis=0) - rotation @ p.mean(axis=0)
    residuals = np.linalg.norm(p @ rotation.T + translation - q, axis=1)
    return Registration(rotation=rotation, translation=translation, residuals=residuals)


def _points(name: str, value: ArrayLike) -> Array:
    points = np.array(value, dtype=np.float64)
    if points.ndim != 2 or points.shape[1] != 3 or len(points) < 3:
        raise ValueError(f"{name} must be three or more places (K, 3), not {points.shape}")
    if not np.all(np.isfinite(points)):
        raise ValueError(f"{name} must be finite")
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    rounding = 1e-9 * max(float(np.max(np.abs(points))), 1e-6)
    if spread[0] <= rounding:
        raise ValueError(f"{name} must be in different places, not all in one")
    if spread[1] <= LEAST_SPREAD * spread[0]:
        raise ValueError(
            f"{name} must not lie on one line: a turn about it would be anybody's guess"
        )
    return points


def _refuse_mirrored(a: Array, b: Array) -> None:
    """Refuse points that a reflection would explain far better than any rotation.

    Points in a plane are their own mirror images, so only more than three, off a plane, can tell.
    """
    u, s, vt = np.linalg.svd(b.T @ a)
    flat = s[2] <= LEAST_SPREAD**2 * s[0]
    if not flat and np.linalg.det(u @ vt) < 0.0:
        reflected = float(np.sum((a @ (u @ vt).T - b) ** 2))
        rotated = float(np.sum((a @ (u @ np.diag([1.0, 1.0, -1.0]) @ vt).T - b) ** 2))
        if rotated > 4.0 * reflected:
            raise ValueError(
                "points of one frame must not be mirrored in the other: check the signs of the "
                "coordinates and that both frames are right-handed"
            )
