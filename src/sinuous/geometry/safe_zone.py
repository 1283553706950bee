"""The room a robot may use: clearance, gradient and nearest triangle in metres."""

from dataclasses import dataclass, field
from functools import cached_property
from os import PathLike
from typing import TYPE_CHECKING, NamedTuple, Self

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray
from sinuous.geometry import bvh
from sinuous.geometry.bvh import ZoneArrays
from sinuous.geometry.entrance import open_entrance
from sinuous.geometry.grid import Grid, make_grid
from sinuous.geometry.mesh import load_surface, prepare
from sinuous.geometry.surface import Part, Surface, zone_arrays

if TYPE_CHECKING:
    import trimesh


class Nearest(NamedTuple):
    """What the zone says about points p.

    Arguments:
        clearance: distance to the wall [m] (...), positive on the free side, inf without walls
        gradient: of the clearance (..., 3), a unit vector, zero without walls
        triangle: number of the nearest triangle (...), -1 without walls
        foot: the nearest point of the wall [m] (..., 3), nan without walls
    """

    clearance: Array
    gradient: Array
    triangle: IntArray
    foot: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class SafeZone:
    """The inside of a closed mesh, less the insides of keep-out meshes.

    The clearance of a point is the least signed distance over all surfaces: to the zone's mesh,
    positive inside; to a keep-out, positive outside. Every distance is exact; at a place that is
    blocked by two surfaces at once the deeper one counts.

    An *entrance* is a planar facet that the robot passes through. The passage is continued before
    it by a straight guide of length `approach` with the facet's outline, whose walls constrain like
    the mesh's own; the facet moves to the far end of the guide and is open: it closes the surface
    but is at no distance from anything. Beyond the far end is outside: the clearance jumps there
    from the distance to the guide to minus the distance to its rim, so `approach` has to cover what
    of the robot is outside the mesh.

    Arguments:
        surfaces: the zone's mesh first, then keep-outs; empty for unbounded space
    """

    surfaces: tuple[Surface, ...]
    arrays: ZoneArrays = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "arrays", zone_arrays(self.surfaces))

    @classmethod
    def load(
        cls,
        path: str | PathLike[str],
        *,
        unit: str,
        cap: bool = False,
        entrance: ArrayLike | None = None,
        approach: float = 0.3,
    ) -> Self:
        """Load a closed mesh as the zone.

        Arguments:
            path: STL, OBJ or PLY file
            unit: of the numbers in the file: "m", "cm" or "mm"
            cap: close open ends by planar caps, which then are walls
            entrance: point or points [m] (3,) or (E, 3) in the mesh's frame; the planar facet
                nearest to each is opened
            approach: length of the guide before every entrance [m]

        Raises:
            InputError: if the mesh cannot be used, saying why and what to do
        """
        surface, _ = load_surface(path, unit=unit, cap=cap)
        return cls(surfaces=(open_entrance(surface, entrance, approach),))

    @classmethod
    def from_mesh(
        cls,
        mesh: "trimesh.Trimesh",
        *,
        name: str = "mesh",
        cap: bool = False,
        entrance: ArrayLike | None = None,
        approach: float = 0.3,
    ) -> Self:
        """Take a mesh in metres as the zone; arguments and errors as in `load`."""
        surface, _ = prepare(mesh.vertices, mesh.faces, name=name, cap=cap)
        return cls(surfaces=(open_entrance(surface, entrance, approach),))

    @classmethod
    def unbounded(cls) -> Self:
        """Space without any wall: the clearance is infinite everywhere."""
        return cls(surfaces=())

    def minus(self, mesh: "trimesh.Trimesh", *, name: str) -> Self:
        """Take the inside of a closed mesh in metres out of the zone.

        Raises:
            InputError: if the mesh cannot be used
        """
        surface, _ = prepare(mesh.vertices, mesh.faces, name=name, keep_out=True)
        return type(self)(surfaces=(*self.surfaces, surface))

    def nearest(self, p: ArrayLike) -> Nearest:
        """Clearance, gradient, triangle and foot of points p [m] (..., 3)."""
        points = np.asarray(p, dtype=np.float64)
        flat = np.ascontiguousarray(points.reshape(-1, 3))
        clearance, gradient = np.empty(len(flat)), np.empty((len(flat), 3))
        triangle = np.empty(len(flat), dtype=np.int64)
        bvh.nearest(self.arrays, flat, clearance, gradient, triangle)
        bounded = np.isfinite(clearance)[:, None]
        step = np.multiply(
            clearance[:, None], gradient, where=bounded, out=np.full_like(flat, np.nan)
        )
        lead = points.shape[:-1]
        return Nearest(
            clearance.reshape(lead),
            gradient.reshape(points.shape),
            triangle.reshape(lead),
            (flat - step).reshape(points.shape),
        )

    def clearance(self, p: ArrayLike) -> Array:
        """Signed distance to the wall [m] (...) of points p [m] (..., 3), positive inside."""
        return self.nearest(p).clearance

    def gradient(self, p: ArrayLike) -> Array:
        """Gradient of the clearance (..., 3) at points p [m] (..., 3)."""
        return self.nearest(p).gradient

    @cached_property
    def grid(self) -> Grid:
        """Lower bounds of the clearance, for compiled code; built when first asked for."""
        return make_grid(self.arrays, self.triangles[self.is_open])

    @property
    def triangles(self) -> Array:
        """Corners [m] (T, 3, 3) of all triangles, the open ones too, by number."""
        if not self.surfaces:
            return np.zeros((0, 3, 3))
        return np.concatenate([s.vertices[s.faces] for s in self.surfaces])

    @property
    def is_open(self) -> BoolArray:
        """Which triangles (T,) are open."""
        return np.concatenate([np.zeros(0, dtype=np.bool_), *(s.is_open for s in self.surfaces)])

    @property
    def is_guide(self) -> BoolArray:
        """Which triangles (T,) belong to a guide before an entrance."""
        return np.concatenate(
            [np.zeros(0, dtype=np.bool_), *(s.part == Part.GUIDE for s in self.surfaces)]
        )

    @property
    def is_keep_out(self) -> BoolArray:
        """Which triangles (T,) belong to a keep-out."""
        return np.concatenate(
            [
                np.zeros(0, dtype=np.bool_),
                *(np.full(len(s.faces), s.keep_out) for s in self.surfaces),
            ]
        )

    def describe_triangle(self, index: int) -> str:
        """Say which triangle a number means, in words a user can look up.

        Raises:
            IndexError: if there is no such triangle
        """
        for surface in self.surfaces:
            if 0 <= index < len(surface.faces):
                where = f"{'keep-out ' if surface.keep_out else ''}{surface.name}"
                number = int(surface.source[index])
                part = Part(int(surface.part[index]))
                if part is Part.CAP:
                    return f"triangle {number} of the caps of {where}"
                if part is Part.GUIDE:
                    return f"triangle {number} of the guide before the entrance of {where}"
                return f"triangle {number} of {where}"
            index -= len(surface.faces)
        raise IndexError("the zone has no such triangle")
