"""Passages and bodies seen along an axis."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot
from sinuous.view.solids import body
from sinuous.view.style import GREEN, PALE, PALER, SLATE, rgb
from sinuous.view.units import MM_PER_M

X, Y, Z = range(3)
TOWARDS = np.array([0.0, -1.0, 0.0])
"""From where one looks: x points to the right and z up."""

TARGET: dict[str, Any] = {
    "linestyle": "none",
    "marker": "*",
    "markersize": 13,
    "color": GREEN,
    "markeredgecolor": "white",
    "markeredgewidth": 0.8,
}


def draw_passage(axes: Axes, zone: SafeZone, *, air: float = 0.0) -> None:
    """The outline of a zone, its guide paler and its keep-outs darker.

    Arguments:
        air: around the passage [m]
    """
    triangles = zone.triangles * MM_PER_M
    wall = ~zone.is_guide & ~zone.is_keep_out & ~zone.is_open
    for chosen, color, layer in (
        (zone.is_guide, PALER, 0.5),
        (wall, PALE, 0.6),
        (zone.is_keep_out, SLATE, 0.7),
    ):
        outline = list(triangles[chosen][:, :, [X, Z]])
        axes.add_collection(
            PolyCollection(outline, facecolors=color, edgecolors=color, zorder=layer)
        )
    corners = triangles[wall].reshape(-1, 3)
    low, high = corners.min(axis=0) - MM_PER_M * air, corners.max(axis=0) + MM_PER_M * air
    axes.set_xlim(low[X], high[X])
    axes.set_ylim(low[Z], high[Z])
    axes.set_aspect("equal", adjustable="box")
    axes.set_xlabel("x [mm]")
    axes.grid(visible=False)


def draw_body(axes: Axes, robot: Robot, points: Array, color: str) -> None:
    """A robot by its guarded points (S, 3) [m]."""
    solid = body(points * MM_PER_M, robot.radii * MM_PER_M, robot.disk_indices, rgb(color))
    seen = solid.facing(TOWARDS)
    order = np.argsort(seen.polygons.mean(axis=1) @ TOWARDS)
    flat, colors = list(seen.polygons[order][:, :, [X, Z]]), list(seen.lit()[order])
    axes.add_collection(
        PolyCollection(flat, facecolors=colors, edgecolors=colors, linewidths=0.4, zorder=2)
    )


def draw_target(axes: Axes, target: Array) -> None:
    """A target (3,) [m]."""
    axes.plot(target[X] * MM_PER_M, target[Z] * MM_PER_M, zorder=5, **TARGET)
