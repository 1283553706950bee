"""The figures of `sinuous bench scaling`: one for each thing that is varied."""

from collections.abc import Sequence
from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sinuous.bench.axis_figure import draw_times, keys, logarithmic, numbers, tick
from sinuous.bench.result import Result, Row
from sinuous.view.style import BLUE, GREEN, GREY, LIMIT, ORANGE, SKY, VERMILION, save

SIZE, WIDE = (6.4, 4.4), (11.6, 4.6)  # [inch]
ROOM = 1.35  # above the longest step, for the legend; of decades if logarithmic
TWICE, LONGEST_LOAD = 2.0, 3.0  # what is asked of the largest mesh: factor, [s]
DASH = (0, (5, 3))

AXES = {
    "disks": ("disks", "disks", "A step against disks"),
    "points": ("points", "guarded points of the body", "A step against guarded points"),
    "segments": ("segments", "segments", "A step against segments"),
    "horizon": ("horizon", "horizon N", "A step against the horizon"),
}
STEP_LABEL = "processor time of a step [ms]"
LINEAR = ("disks", "segments")


def draw(result: Result, out: Path) -> list[Path]:
    """Write scaling_AXIS.png for every axis."""
    paths = [_plain(result, name, out) for name in AXES]
    rows = result.table("mesh").rows

    def paint(figure: Figure) -> None:
        left, right = figure.subplots(1, 2)
        _mesh_times(left, rows)
        _loading(right, result.table("loading").rows)

    return [*paths, save(out / "scaling_mesh.png", WIDE, paint)]


def _plain(result: Result, name: str, out: Path) -> Path:
    key, label, title = AXES[name]
    rows = sorted(result.table(name).rows, key=lambda row: numbers([row], key))

    def paint(figure: Figure) -> None:
        axes = figure.subplots()
        draw_times(axes, rows, key, BLUE)
        if name in LINEAR:
            axes.set_ylim(0.0, ROOM * max(numbers(rows, "max_ms")))
        else:
            logarithmic(axes)
            _make_room(axes)
        tick(axes.xaxis, numbers(rows, key))
        axes.set_title(title)
        axes.set_xlabel(label)
        axes.set_ylabel(STEP_LABEL)
        handles = keys()
        if name == "horizon":
            handles.append(_proportional(axes, rows))
        axes.legend(handles=handles, loc="upper left")

    return save(out / f"scaling_{name}.png", SIZE, paint)


def _make_room(axes: Axes) -> None:
    """For the legend, above what is drawn."""
    low, high = axes.get_ylim()
    axes.set_ylim(low, high * (high / low) ** (ROOM - 1.0))


def _proportional(axes: Axes, rows: Sequence[Row]) -> Line2D:
    """What work in proportion to the horizon would look like."""
    x, median = numbers(rows, "horizon"), numbers(rows, "median_ms")
    slope = median[-1] / x[-1]
    (line,) = axes.plot(
        x, [slope * N for N in x], color=GREY, linestyle=DASH, linewidth=1.0, zorder=1,
        label="in proportion to N",
    )  # fmt: skip
    return line


def _mesh_times(axes: Axes, rows: Sequence[Row]) -> None:
    horizons = list(dict.fromkeys(numbers(rows, "horizon")))
    names = list[Line2D]()
    for horizon, color in zip(horizons, (BLUE, VERMILION), strict=True):
        chosen = [row for row in rows if row["horizon"] == horizon]
        draw_times(axes, chosen, "vertices", color)
        limit = TWICE * numbers(chosen, "median_ms")[0]
        axes.axhline(limit, color=color, linestyle=DASH, linewidth=1.0, zorder=1)
        names.append(Line2D([], [], color=color, marker="o", label=f"N = {horizon:g}"))
    logarithmic(axes)
    tick(axes.xaxis, numbers(rows, "vertices"))
    _make_room(axes)
    twice = Line2D([], [], color=GREY, linestyle=DASH, label="twice the first median")
    axes.legend(handles=[*names, *keys(), twice], ncols=2, loc="upper left")
    axes.set_title("A step against the mesh")
    axes.set_xlabel("vertices")
    axes.set_ylabel(STEP_LABEL)


def _loading(axes: Axes, rows: Sequence[Row]) -> None:
    x = numbers(rows, "vertices")
    parts = (
        ("load_s", "read, join, check", GREEN),
        ("build_s", "tree and normals", ORANGE),
        ("grid_s", "grid of lower bounds", SKY),
    )
    for key, label, color in parts:
        axes.plot(x, numbers(rows, key), "o-", color=color, markersize=5.0, label=label)
    total = [sum(numbers([row], key)[0] for key, _, _ in parts) for row in rows]
    axes.plot(x, total, "o-", color=LIMIT, markersize=5.0, label="all")
    most = f"{LONGEST_LOAD:g} s"
    axes.axhline(LONGEST_LOAD, color=GREY, linestyle=DASH, linewidth=1.0, zorder=1, label=most)
    logarithmic(axes)
    _make_room(axes)
    tick(axes.xaxis, x)
    axes.set_title("From file to zone")
    axes.set_xlabel("vertices")
    axes.set_ylabel("processor time [s]")
    axes.legend(loc="upper left")
