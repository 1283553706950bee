"""The walls of a safe zone as geometry that a physical robot collides with.

A mesh as a whole would collide as its convex hull, so every triangle becomes a plate of its own.
"""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from sinuous.arrays import Array, BoolArray
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.physics.body import WALL_AFFINITY, WALL_TYPE
from sinuous.plants.physics.engine import require_mujoco

COLOUR = (0.8, 0.7, 0.6, 0.15)
THICKNESS = 0.004  # of a plate, where there is room for it [m]
# By how much a plate's far side is wider than its near side, all around, as a multiple of its
# thickness; and how much of its thickness it has. The first that fits is taken.
FITS = ((1.0, 1.0), (0.0, 1.0), (0.0, 0.5), (0.0, 0.25), (0.0, 0.125))
SHARPEST = 2.0  # farthest that a corner of the far side moves for that, as a multiple, too
# A triangle no higher than this leaves a gap that nothing fits through [m].
SLIVER = 1e-5
# How far a plate may stick out of the far side of what it bounds: behind sharp edges it must [m].
STICKS_OUT = 5e-5
# Hard contact that takes back a penetration within two ticks; no friction.
SOLREF = (0.002, 1.0)
SOLIMP = (0.95, 0.99, 0.001, 0.5, 2.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Walls:
    """A plate for every triangle of a zone that is not open, on the side where no room is.

    Plates become wider with depth, where that fits: the engine pushes a body out of a plate the
    shortest way, and the way out through an upright side, over the edge to the next plate, would
    be a force along the wall.

    Arguments:
        zone: whose walls they are
        thickness: of a plate [m]; thinner where the far side of what it bounds is nearer

    Raises:
        ValueError: if the thickness is not positive and finite
    """

    zone: SafeZone
    thickness: float = THICKNESS

    def __post_init__(self) -> None:
        if not 0.0 < self.thickness < np.inf:
            raise ValueError(f"walls have a positive thickness, not {self.thickness}")

    @cached_property
    def plates(self) -> Array:
        """Corners (T, 6, 3) [m] of the plates: of the triangle, then of its far side."""
        inner = self._triangles
        outer = self._outer(inner, *FITS[-1])
        sought = np.arange(len(inner))
        for fit in FITS[:-1]:
            tried = self._outer(inner[sought], *fit)
            fits = ~self._sticks_out(inner[sought], tried)
            outer[sought[fits]] = tried[fits]
            sought = sought[~fits]
        return np.concatenate([inner, outer], axis=1)

    @cached_property
    def _triangles(self) -> Array:
        """Corners (T, 3, 3) [m] of what constrains, wound about the way out of the room."""
        zone = self.zone
        turned = zone.is_keep_out[:, None, None]
        corners = np.where(turned, zone.triangles[:, ::-1], zone.triangles)[~zone.is_open]
        sides = np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)
        heights = np.linalg.norm(_across(corners), axis=1) / np.max(sides, axis=1)
        return corners[heights > SLIVER]

    def _outer(self, inner: Array, spread: float, share: float) -> Array:
        """Far sides (T, 3, 3) [m] of plates, see `FITS`."""
        out = _unit(_across(inner))[:, None]
        # Away from the edge that starts at a corner, and from the one that ends there.
        after = np.cross(_unit(np.roll(inner, -1, axis=1) - inner), out)
        before = np.roll(after, 1, axis=1)
        away = (after + before) / (1.0 + np.sum(after * before, axis=2, keepdims=True))
        far = np.linalg.norm(away, axis=2, keepdims=True)
        away *= np.minimum(1.0, SHARPEST / far)
        return inner + share * self.thickness * (out + spread * away)

    def _sticks_out(self, inner: Array, outer: Array) -> BoolArray:
        """Which plates (T,) reach into the room."""
        found = np.zeros(len(inner), dtype=np.bool_)
        for part in (0.25, 0.5, 0.75, 1.0):
            corners = inner + part * (outer - inner)
            centre = corners.mean(axis=1, keepdims=True)
            edges = 0.5 * (corners + np.roll(corners, 1, axis=1))
            looks = np.concatenate([corners, edges, centre], axis=1)
            found |= np.max(self.zone.clearance(looks), axis=1) > STICKS_OUT
        return found

    def add_to(self, spec: Any) -> None:
        """Add the plates to a model (MjSpec)."""
        mujoco = require_mujoco()
        for number, plate in enumerate(self.plates):
            name, centre = f"wall {number}", plate.mean(axis=0)
            # Without faces, the engine takes the hull.
            spec.add_mesh(name=name, uservert=(plate - centre).ravel())
            spec.worldbody.add_geom(
                name=name,
                type=mujoco.mjtGeom.mjGEOM_MESH,
                meshname=name,
                pos=centre,
                mass=0.0,
                contype=WALL_TYPE,
                conaffinity=WALL_AFFINITY,
                priority=1,  # of its contact over the robot's
                condim=1,
                solref=SOLREF,
                solimp=SOLIMP,
                rgba=COLOUR,
            )


def _across(corners: Array) -> Array:
    """Normals (T, 3) of triangles (T, 3, 3), twice as long as their areas."""
    return np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])


def _unit(v: Array) -> Array:
    """Vectors (..., 3) at length one."""
    return v / np.linalg.norm(v, axis=-1, keepdims=True)
