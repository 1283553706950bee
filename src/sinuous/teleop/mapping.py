"""From the leader's workspace to the follower's (22)."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop import kernels
from sinuous.teleop.checks import vector

ORTHONORMAL = 1e-9  # what rounding may leave of the products of axes


@dataclass(frozen=True, kw_only=True, eq=False)
class Mapping:
    """The follower's point p_w = origin + axes (scale x) of a leader at x, per axis (22).

    The leader's motion is scaled before it becomes a wave: what is called the wave side is in
    metres of the follower, scale x. Forces are not scaled, so that both ends feel the same; power
    on the leader's side is that of the wave side by the scale. With one scale for all axes that
    leaves every part passive that is; scales that differ weigh the axes differently, and a
    follower whose force on one axis depends on another then has to be passive so weighed.

    Arguments:
        scale: metres of the follower by metre of the leader (A,)
        axes: directions of the wave side's axes in the world, columns (3, A)
        origin: the follower's point when the leader is at zero (3,) [m]

    Raises:
        ValueError: if a scale is not positive, or the axes are not orthonormal
    """

    scale: Array
    axes: Array
    origin: Array

    def __post_init__(self) -> None:
        scale, origin = vector("scale", self.scale), vector("origin", self.origin)
        axes = np.array(self.axes, dtype=np.float64, order="C")
        if np.any(scale <= 0.0):
            raise ValueError(f"scale must be positive, not {scale.tolist()}")
        if origin.shape != (3,) or axes.shape != (3, len(scale)):
            raise ValueError(f"axes must be (3, {len(scale)}), the origin (3,)")
        if not np.allclose(axes.T @ axes, np.eye(len(scale)), rtol=0.0, atol=ORTHONORMAL):
            raise ValueError("axes must be orthogonal unit vectors, in columns")
        for name, value in (("scale", scale), ("axes", axes), ("origin", origin)):
            object.__setattr__(self, name, value)

    @classmethod
    def plane(cls, scale: ArrayLike, y0: float) -> Self:
        """The leader's X and Y drive the follower's X and Z in the plane PTY at y0 [m] (22)."""
        two = np.broadcast_to(np.asarray(scale, dtype=np.float64), 2)
        axes = np.array([[1.0, 0.0], [0.0, 0.0], [0.0, 1.0]])
        return cls(scale=two, axes=axes, origin=np.array([0.0, y0, 0.0]))

    @classmethod
    def space(cls, scale: ArrayLike, origin: ArrayLike, rotation: ArrayLike | None = None) -> Self:
        """Three axes.

        Arguments:
            scale: one for all, or one per axis (3,)
            origin: the follower's point when the leader is at zero (3,) [m]
            rotation: of the leader's frame in the world (3, 3), by default none
        """
        three = np.broadcast_to(np.asarray(scale, dtype=np.float64), 3)
        axes = np.eye(3) if rotation is None else np.asarray(rotation, dtype=np.float64)
        return cls(scale=three, axes=axes, origin=np.asarray(origin, dtype=np.float64))

    def place(self, x: Array) -> Array:
        """The point p_w (3,) [m] of wave-side coordinates x (A,) [m]."""
        out = np.empty(3)
        kernels.place(self.axes, self.origin, x, out)
        return out

    def project(self, p_w: ArrayLike) -> Array:
        """Wave-side coordinates (A,) [m] of a point (3,) [m]; what is off the axes is dropped.

        Raises:
            ValueError: if the point is not three numbers
        """
        out = np.empty(self.scale.size)
        kernels.project(self.axes, self.origin, _three(p_w), out)
        return out

    def watch(self, p_w: ArrayLike, before: Array | None, dt: float) -> tuple[Array, Array]:
        """The same and its velocity (A,) [m/s] since it was there a tick before; zero for None.

        Raises:
            ValueError: if the point is not three numbers
        """
        X, V = np.empty(self.scale.size), np.empty(self.scale.size)
        seen = X if before is None else before
        kernels.see(self.axes, self.origin, _three(p_w), seen, dt, X, V)
        return X, V


def _three(p_w: ArrayLike) -> Array:
    p = np.array(p_w, dtype=np.float64)
    if p.shape != (3,):
        raise ValueError(f"a point must be three numbers, not {p.shape}")
    return p
