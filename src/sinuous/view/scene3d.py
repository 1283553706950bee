"""The robot's shapes over time inside the zone: one view in space and two along axes."""

from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Line3DCollection, Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from sinuous.arrays import Array
from sinuous.recording import Recording
from sinuous.view.curves import NO_STEPS, way_points
from sinuous.view.style import BLACK, PALE, SKY, TIME_LABEL, VERMILION, note
from sinuous.view.units import MM_PER_M

SHAPES = 14
"""How many shapes are drawn; more overlap."""

MOST_TRIANGLES = 12_000
"""Larger meshes are thinned out for drawing: every triangle costs, few can be told apart."""

MOST_LABELS = 20
"""More way-points are drawn without their numbers, which would hide each other."""

MAP = colormaps["viridis"]
ZOOM: dict[str, Any] = {"zoom": 1.08}
CLEAR = (1.0, 1.0, 1.0, 0.0)
NAMES = ("x", "y", "z")
SLIMMEST = 0.45
"""Least extent of what is shown by the largest one; flatter boxes leave no room for labels."""


def draw_shapes(figure: Figure, recording: Recording) -> None:
    """Body shapes coloured by time, the zone, the way-points, start and end."""
    if not len(recording):
        note(figure.subplots(), NO_STEPS)
        return
    width, depth, _ = np.subtract(*_bounds(recording)[::-1])
    grid = figure.add_gridspec(1, 3, width_ratios=(1.3 * (width + depth), width, depth))
    space = Axes3D(figure, grid[0], azim=-58, elev=18)
    figure.add_axes(space)
    _draw_space(space, recording)
    front = figure.add_subplot(grid[1])
    side = figure.add_subplot(grid[2], sharey=front)
    _draw_plane(front, recording, (0, 2))
    _draw_plane(side, recording, (1, 2))
    side.tick_params(labelleft=False)
    side.set_ylabel("")
    start, end = float(recording.time[0]), float(recording.time[-1])
    times = ScalarMappable(Normalize(start, max(end, start + recording.header.dt)), MAP)
    figure.colorbar(times, ax=[front, side], label=TIME_LABEL, shrink=0.8, aspect=30)
    handles, labels = space.get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(handles))


def _draw_space(axes: Axes3D, recording: Recording) -> None:
    axes.set_title("Shapes of the body over time", loc="left")
    triangles = _thinned(recording.header.zone_triangles) * MM_PER_M
    if len(triangles):
        mesh = Poly3DCollection(list(triangles), facecolor=SKY, edgecolor="none", alpha=0.10)
        axes.add_collection3d(mesh)
    shapes, colors = _chosen_shapes(recording)
    axes.add_collection3d(Line3DCollection(list(shapes), colors=list(colors), linewidths=1.6))
    for points, label, style in _marks(recording):
        axes.plot(points[:, 0], points[:, 1], points[:, 2], label=label, **style)
    targets = way_points(recording) * MM_PER_M
    for i, p in enumerate(targets if len(targets) <= MOST_LABELS else ()):
        axes.text(p[0], p[1], p[2], f"  {i + 1}", fontsize=9)
    low, high = _bounds(recording)
    axes.set_box_aspect(high - low, **ZOOM)
    axes.set_xlim(low[0], high[0])
    axes.set_ylim(low[1], high[1])
    axes.set_zlim(low[2], high[2])
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.set_zlabel("z [mm]")
    spatial: tuple[Any, ...] = (axes.xaxis, axes.yaxis, axes.zaxis)
    for axis in spatial:
        axis.set_pane_color(CLEAR)
        axis.set_major_locator(MaxNLocator(5))


def _draw_plane(axes: Axes, recording: Recording, plane: tuple[int, int]) -> None:
    first, second = plane
    axes.set_title(f"Seen along {NAMES[3 - first - second]}")
    axes.set_xlabel(f"{NAMES[first]} [mm]")
    axes.set_ylabel(f"{NAMES[second]} [mm]")
    triangles = _thinned(recording.header.zone_triangles)[:, :, plane] * MM_PER_M
    if len(triangles):
        # Opaque triangles of one colour give the outline of the whole zone.
        axes.add_collection(PolyCollection(list(triangles), facecolor=PALE, edgecolor=PALE))
    shapes, colors = _chosen_shapes(recording)
    axes.add_collection(
        LineCollection(list(shapes[:, :, plane]), colors=list(colors), linewidths=1.4)
    )
    for points, _, style in _marks(recording):
        axes.plot(points[:, first], points[:, second], **style)
    low, high = _bounds(recording)
    axes.set_xlim(low[first], high[first])
    axes.set_ylim(low[second], high[second])
    axes.set_aspect("equal", adjustable="box")


def _chosen_shapes(recording: Recording) -> tuple[Array, Array]:
    """Some measured shapes (M, S, 3) [mm], evenly spaced along the tip's way, and their colours."""
    last = len(recording) - 1
    steps = np.linalg.norm(np.diff(recording.nominal_tip, axis=0), axis=1)
    way = np.concatenate(([0.0], np.cumsum(steps)))
    chosen = np.unique(np.searchsorted(way, np.linspace(0.0, way[-1], SHAPES)))
    colors = np.asarray(MAP(chosen / max(last, 1)), dtype=np.float64)
    return recording.measured_points[chosen] * MM_PER_M, colors


def _marks(recording: Recording) -> list[tuple[Array, str, dict[str, Any]]]:
    """Lines and markers that every view shows: points (M, 3) [mm], label, style."""
    body = recording.measured_points * MM_PER_M
    disks = body[-1, recording.header.disk_indices]
    tip = recording.measured_tip * MM_PER_M
    dot: dict[str, Any] = {"linestyle": "none", "color": BLACK, "zorder": 5}
    jumps = len(way_points(recording)) > 0
    targets = (way_points(recording) if jumps else recording.target) * MM_PER_M
    star: dict[str, Any] = {
        "marker": "*",
        "markersize": 11,
        "markeredgecolor": "white",
        "markeredgewidth": 0.7,
    }
    line: dict[str, Any] = {
        "linewidth": 1.4,
        "linestyle": (0, (1.2, 1.6)),
        "color": VERMILION,
        "zorder": 4,
    }
    return [
        (tip, "path of the tip", {"linewidth": 0.9, "color": BLACK, "alpha": 0.6, "zorder": 4}),
        (body[0], "start", {"linewidth": 2.6, "color": MAP(0.0), "zorder": 3}),
        (body[-1], "end", {"linewidth": 2.6, "color": MAP(1.0), "zorder": 3}),
        (disks, "disks at the end", dot | {"marker": "o", "markersize": 2.4}),
        (targets, "way-points", dot | star | {"color": VERMILION})
        if jumps
        else (targets, "target", line),
    ]


def _bounds(recording: Recording) -> tuple[Array, Array]:
    """Lower and upper corner [mm] of everything drawn, with a little air."""
    parts = (recording.measured_points, recording.target, recording.header.zone_triangles)
    points = np.concatenate([part.reshape(-1, 3) for part in parts]) * MM_PER_M
    low, high = points.min(axis=0), points.max(axis=0)
    extent = high - low
    air = np.maximum(0.06 * extent.max(), 0.5 * (SLIMMEST * extent.max() - extent))
    return low - air, high + air


def _thinned(triangles: Array) -> Array:
    """Every n-th triangle, so that there are not too many."""
    return triangles[:: 1 + len(triangles) // MOST_TRIANGLES]
