"""The robot's shapes over time inside the zone: one view in space and two along axes."""

from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.axes import Axes
from matplotlib.cm import ScalarMappable
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.colors import Normalize
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.patheffects import withStroke
from matplotlib.ticker import MaxNLocator
from mpl_toolkits.mplot3d.art3d import Poly3DCollection
from mpl_toolkits.mplot3d.axes3d import Axes3D

from sinuous.arrays import Array
from sinuous.recording import Recording
from sinuous.view.curves import NO_STEPS
from sinuous.view.scene import Scene
from sinuous.view.solids import Solid, glass, normals_of, together
from sinuous.view.style import BLACK, GREEN, PALE, PALER, SKY, SLATE, TIME_LABEL, TIMES, note

AZIMUTH, ELEVATION = -58, 16  # from where one looks into the space [deg]
MOST_LABELS = 20
"""More way-points are drawn without their numbers, which would hide each other."""

ZOOM: dict[str, Any] = {"zoom": 1.08}
CLEAR = (1.0, 1.0, 1.0, 0.0)
NAMES = ("x", "y", "z")
STAR: dict[str, Any] = {
    "linestyle": "none",
    "marker": "*",
    "markersize": 13,
    "color": GREEN,
    "markeredgecolor": "white",
    "markeredgewidth": 0.8,
}
PURSUED: dict[str, Any] = {"linewidth": 1.6, "linestyle": (0, (1.2, 1.6)), "color": GREEN}
TIP: dict[str, Any] = {"linewidth": 1.0, "color": BLACK, "alpha": 0.75}
SEAMS: dict[str, Any] = {"linewidths": 0.4, "joinstyle": "round"}
"""Edges that close the seams between opaque polygons; glass must have none."""


def draw_shapes(figure: Figure, recording: Recording) -> None:
    """Body shapes coloured by time, the zone, the way-points, and the robot at the end."""
    if not len(recording):
        note(figure.subplots(), NO_STEPS)
        return
    scene = Scene.of(recording)
    width, depth, _ = scene.high - scene.low
    # The second column is room for labels in space, whose extent the layout does not see.
    ratios = (0.9 * (width + depth), 0.06 * (width + depth), width, depth)
    grid = figure.add_gridspec(1, 4, width_ratios=ratios)
    space = Axes3D(figure, grid[0], azim=AZIMUTH, elev=ELEVATION, proj_type="ortho")
    figure.add_axes(space)
    _draw_space(space, scene)
    space.set_title(recording.header.name, pad=-2)
    front = figure.add_subplot(grid[2])
    side = figure.add_subplot(grid[3], sharey=front)
    _draw_plane(front, scene, (0, 2))
    _draw_plane(side, scene, (1, 2))
    side.tick_params(labelleft=False)
    side.set_ylabel("")
    start, end = float(recording.time[0]), float(recording.time[-1])
    times = ScalarMappable(Normalize(start, max(end, start + recording.header.dt)), TIMES)
    figure.colorbar(times, ax=[front, side], label=TIME_LABEL, shrink=0.8, aspect=30)
    explained = keys(scene)
    figure.legend(handles=explained, loc="outside lower center", ncols=len(explained))


def _draw_space(axes: Axes3D, scene: Scene) -> None:
    axes.computed_zorder = False  # glass is drawn in two layers, and what is inside between them
    up, round_z = np.radians((ELEVATION, AZIMUTH))
    towards = np.array([np.cos(up) * np.cos(round_z), np.cos(up) * np.sin(round_z), np.sin(up)])
    front = normals_of(scene.walls) @ towards > 0.0
    for seen, faint, rim, layer in ((~front, 0.12, 0.50, 1), (front, 0.04, 0.35, 4)):
        walls = scene.walls[seen]
        colors = glass(walls, towards, SKY, faint, rim)
        _add(axes, list(walls), colors, layer)
    _add(axes, scene.guide, np.tile((0.5, 0.5, 0.5, 0.05), (len(scene.guide), 1)), 1)
    inside = together([scene.earlier, scene.robot, scene.keep_outs]).facing(towards)
    _add(axes, list(inside.polygons), inside.lit(), 3)
    x, y, z = scene.tip.T
    axes.plot(x, y, z, zorder=5, **TIP)
    x, y, z = scene.targets.T
    axes.plot(x, y, z, zorder=6, **(STAR if scene.jumps else PURSUED))
    if scene.jumps and len(scene.targets) <= MOST_LABELS:
        style: dict[str, Any] = {"fontsize": 10, "weight": "bold", "zorder": 7}
        halo = [withStroke(linewidth=2.5, foreground="white")]
        for i, p in enumerate(scene.targets):
            axes.text(p[0], p[1], p[2], f"   {i + 1}", path_effects=halo, **style)
    axes.set_box_aspect(scene.high - scene.low, **ZOOM)
    limits = list(zip(scene.low, scene.high, strict=True))
    axes.set(xlim=limits[0], ylim=limits[1], zlim=limits[2])
    axes.set_xlabel("x [mm]", labelpad=-2)
    axes.set_ylabel("y [mm]", labelpad=-2)
    axes.set_zlabel("z [mm]", labelpad=-1)
    spatial: tuple[Any, ...] = (axes.xaxis, axes.yaxis, axes.zaxis)
    for axis, room in zip(spatial, scene.high - scene.low, strict=True):
        axis.set_pane_color(CLEAR)
        axis.line.set_color("#909090")
        axis.set_tick_params(labelsize=8.5, pad=0)
        share = room / float((scene.high - scene.low).max())
        axis.set_major_locator(MaxNLocator(5 if share > 0.7 else 3))


def _add(axes: Axes3D, polygons: list[Array], colors: Array, layer: int) -> None:
    if len(polygons):
        edges = list(colors) if np.all(colors[:, 3] == 1.0) else "none"
        drawn = Poly3DCollection(
            polygons, facecolors=list(colors), edgecolors=edges, zorder=layer, **SEAMS
        )
        axes.add_collection3d(drawn)


def _draw_plane(axes: Axes, scene: Scene, plane: tuple[int, int]) -> None:
    first, second = plane
    along = 3 - first - second
    axes.set_title(f"seen along {NAMES[along]}")
    axes.set_xlabel(f"{NAMES[first]} [mm]")
    axes.set_ylabel(f"{NAMES[second]} [mm]")
    # Opaque polygons of one colour give the outline of the whole.
    for polygons, color in ((scene.guide, PALER), (scene.walls, PALE)):
        outline = [polygon[:, plane] for polygon in polygons]
        axes.add_collection(PolyCollection(outline, facecolors=color, edgecolors=color, zorder=0.6))
    towards = np.zeros(3)
    towards[along] = -1.0 if along == 1 else 1.0  # with the other two axes to the right and up
    _fill(axes, scene.keep_outs, plane, towards, 1)
    _fill(axes, scene.robot, plane, towards, 2)
    lines = list(scene.shapes[:-1, :, plane])
    colors = list(scene.colors[:-1])
    axes.add_collection(LineCollection(lines, colors=colors, linewidths=1.3, zorder=3))
    axes.plot(*scene.tip[:, plane].T, zorder=4, **TIP)
    axes.plot(*scene.targets[:, plane].T, zorder=5, **(STAR if scene.jumps else PURSUED))
    axes.set_xlim(scene.low[first], scene.high[first])
    axes.set_ylim(scene.low[second], scene.high[second])
    axes.set_aspect("equal", adjustable="box")


def _fill(axes: Axes, solid: Solid, plane: tuple[int, int], towards: Array, layer: int) -> None:
    """Draw a solid seen from that direction, what is farthest away first."""
    seen = solid.facing(towards)
    order = np.argsort(seen.polygons.mean(axis=1) @ towards)
    flat, colors = list(seen.polygons[order][:, :, plane]), list(seen.lit()[order])
    axes.add_collection(
        PolyCollection(flat, facecolors=colors, edgecolors=colors, zorder=layer, **SEAMS)
    )


def keys(scene: Scene) -> list[Artist]:
    """What the legend explains: only what is there."""
    style = STAR if scene.jumps else PURSUED
    found: list[Artist] = [
        Line2D([], [], label="way-points" if scene.jumps else "target", **style),
        Line2D([], [], label="path of the tip", **TIP),
        Line2D([], [], label="earlier shapes", color=TIMES(0.35), linewidth=2.0),
        Line2D([], [], label="robot at the end", color=TIMES(1.0), linewidth=7.0),
    ]
    if len(scene.walls):
        found.append(Patch(label="passage", facecolor=SKY, alpha=0.35))
    if scene.guide:
        found.append(Patch(label="guide before the entrance", facecolor=PALER, edgecolor=PALE))
    if len(scene.keep_outs.polygons):
        found.append(Patch(label="keep-outs", facecolor=SLATE))
    return found
