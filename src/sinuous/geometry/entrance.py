"""Open entrances: planar facets that a robot passes through, and the guides before them."""

from dataclasses import replace

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray
from sinuous.errors import InputError
from sinuous.geometry.bvh import nearest
from sinuous.geometry.facet import PLANE, flatness, largest_facet
from sinuous.geometry.normals import face_normals, unit
from sinuous.geometry.report import places
from sinuous.geometry.surface import Part, Surface, zone_arrays
from sinuous.geometry.topology import edges_of, half_edges
from sinuous.geometry.triangle import distances

STEPS = 64  # places along a guide where it is checked not to run into the mesh


def nearest_facet(surface: Surface, point: Array) -> BoolArray:
    """The facet (F,) nearest to a point; of several that touch there, the largest.

    Raises:
        InputError: if the point is farther away than the facet is wide, so that it can hardly have
            been meant
    """
    corners = np.ascontiguousarray(surface.vertices[surface.faces])
    away = distances(corners, face_normals(corners), point)
    away[surface.is_open | (surface.part == Part.GUIDE)] = np.inf
    best = largest_facet(surface, away <= away.min() + flatness(surface))
    points = corners[best].reshape(-1, 3)
    width = 2.0 * float(np.linalg.norm(points - points.mean(axis=0), axis=1).max())
    if away.min() > width:
        centre = places([corners[best].mean(axis=(0, 1))])
        raise InputError(
            file=surface.name,
            field="entrance",
            expected="a point on a planar end of the mesh, in metres",
            found=f"{places([point])}, {1e3 * away.min():.3g} mm from the nearest planar facet, "
            f"which is {1e3 * width:.3g} mm wide and lies at {centre}",
            remedy="Give the centre of the end that the robot enters through.",
        )
    return best


def _guide(surface: Surface, facet: BoolArray, approach: float) -> Surface:
    """Move a facet outward by `approach` and wall the way there."""
    normal = unit(
        np.sum(
            np.cross(*np.swapaxes(np.diff(surface.vertices[surface.faces[facet]], axis=1), 0, 1)),
            axis=0,
        )
    )
    moved = np.unique(surface.faces[facet])
    twin = np.arange(len(surface.vertices))
    twin[moved] = len(surface.vertices) + np.arange(len(moved))
    rim = half_edges(surface.faces)[(edge_uses(surface.faces, facet) == 1) & facet[:, None]]
    a, b = rim.T
    walls = np.concatenate([np.stack([a, b, twin[b]], 1), np.stack([a, twin[b], twin[a]], 1)])
    before = int(np.sum(surface.part == Part.GUIDE))
    return replace(
        surface,
        vertices=np.concatenate([surface.vertices, surface.vertices[moved] + approach * normal]),
        faces=np.concatenate([np.where(facet[:, None], twin[surface.faces], surface.faces), walls]),
        is_open=np.concatenate([surface.is_open | facet, np.zeros(len(walls), dtype=np.bool_)]),
        part=np.concatenate([surface.part, np.full(len(walls), int(Part.GUIDE))]),
        source=np.concatenate([surface.source, before + np.arange(len(walls))]),
    )


def edge_uses(faces: IntArray, chosen: BoolArray) -> IntArray:
    """How many chosen triangles meet at the edge from corner k to k + 1 (F, 3)."""
    edges, _ = edges_of(faces)
    return np.bincount(edges[chosen].ravel(), minlength=int(edges.max()) + 1)[edges]


def _check_clear(surface: Surface, guided: Surface, facet: BoolArray, approach: float) -> None:
    """Raise if a guide runs into the mesh it belongs to."""
    start, end = surface.faces[facet], guided.faces[: len(facet)][facet]
    _, once = np.unique(start, return_index=True)
    points = surface.vertices[start]
    start = np.concatenate([points.reshape(-1, 3)[once], points.mean(axis=1)])
    points = guided.vertices[end]
    end = np.concatenate([points.reshape(-1, 3)[once], points.mean(axis=1)])
    share = np.arange(1, STEPS + 1)[:, None, None] / STEPS
    points = np.ascontiguousarray((start + share * (end - start)).reshape(-1, 3))
    inside, gradient = np.empty(len(points)), np.empty((len(points), 3))
    number = np.empty(len(points), dtype=np.int64)
    nearest(zone_arrays((surface,)), points, inside, gradient, number)
    hit = (inside > PLANE * float(np.abs(surface.vertices).max())).reshape(STEPS, -1).any(axis=1)
    if hit.any():
        room = approach * float(np.argmax(hit)) / STEPS
        raise InputError(
            file=surface.name,
            field="approach",
            expected="a straight guide before the entrance that stays outside the mesh",
            found=f"one of {approach:g} m that runs into the mesh after {room:.3g} m",
            remedy=f"Set approach to at most {room:.3g}.",
        )


def open_entrance(surface: Surface, entrance: ArrayLike | None, approach: float) -> Surface:
    """Open the facets nearest to the entrance points and put a guide before each.

    Arguments:
        surface: closed
        entrance: [m] (3,) or (E, 3), in the mesh's frame; None leaves the surface closed
        approach: length of every guide [m]

    Raises:
        InputError: if a point names no facet, or a guide has no length or no room
    """
    if entrance is None:
        return surface
    points = np.atleast_2d(np.asarray(entrance, dtype=np.float64))
    if points.ndim != 2 or points.shape[1] != 3 or not np.isfinite(points).all():
        raise InputError(
            file=surface.name,
            field="entrance",
            expected="one point or several, three finite coordinates [m] each",
            found=str(entrance),
            remedy="Give the centre of the end that the robot enters through.",
        )
    if not (np.isfinite(approach) and approach > 0.0):
        raise InputError(
            file=surface.name,
            field="approach",
            expected="a positive length [m]",
            found=f"{approach:g}",
            remedy="Give at least the length of the robot that is outside the mesh.",
        )
    facets = [nearest_facet(surface, np.ascontiguousarray(point)) for point in points]
    if np.any(np.sum(facets, axis=0) > 1):
        raise InputError(
            file=surface.name,
            field="entrance",
            expected="one point for every entrance",
            found="several points for the same planar facet",
            remedy="Remove all but one of them.",
        )
    for facet in facets:
        facet = np.pad(facet, (0, len(surface.faces) - len(facet)))  # guides were added behind
        guided = _guide(surface, facet, approach)
        _check_clear(surface, guided, facet, approach)
        surface = guided
    return surface
