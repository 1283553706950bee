"""The figure of `sinuous bench mpc`: time of a step above, what it bought below."""

from collections.abc import Sequence
from pathlib import Path
from typing import cast

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sinuous.bench.result import Result, Row
from sinuous.view.curves import write_plainly
from sinuous.view.style import (
    BLUE,
    GREEN,
    GREY,
    LIMIT,
    ORANGE,
    PALER,
    PURPLE,
    SKY,
    VERMILION,
    YELLOW,
    save,
)

COLORS = (BLUE, SKY, VERMILION, YELLOW, ORANGE, PURPLE, GREEN)
WIDTH = 0.78  # of a group of participants, with 1 from horizon to horizon
SHOWN_MARGIN = 0.2  # symmetric logarithm: linear up to here [mm]


def draw(result: Result, out: Path) -> list[Path]:
    """Write mpc.png."""
    rows = [row for row in result.table("rows").rows if "median_ms" in row]
    disks = list(dict.fromkeys(row["disks"] for row in rows))
    names = list(dict.fromkeys(str(row["controller"]) for row in rows))
    colors: dict[str, str] = dict(zip(names, COLORS, strict=False))

    def paint(figure: Figure) -> None:
        grid = figure.subplots(
            2, len(disks), sharex="col", sharey="row", squeeze=False, height_ratios=(2.0, 1.0)
        )
        for column, count in enumerate(disks):
            chosen = [row for row in rows if row["disks"] == count]
            grid[0, column].set_title(f"{count} disks")
            _times(grid[0, column], chosen, colors)
            _margins(grid[1, column], chosen, colors)
        grid[0, 0].set_ylabel("processor time of a step [ms]")
        grid[1, 0].set_ylabel("least margin [mm]\nbelow 0: broken")
        figure.legend(handles=_keys(colors), loc="outside lower center", ncols=4)

    return [save(out / "mpc.png", (5.6 * len(disks) + 0.8, 7.4), paint)]


def _places(axes: Axes, rows: Sequence[Row], names: Sequence[str]) -> list[float]:
    """Where each row goes: horizons side by side, participants side by side within."""
    horizons = list(dict.fromkeys(row["horizon"] for row in rows))
    for k in range(0, len(horizons), 2):
        axes.axvspan(k - 0.5, k + 0.5, color=PALER, zorder=0)
    axes.set_xticks(range(len(horizons)), [f"N = {horizon}" for horizon in horizons])
    axes.set_xlim(-0.5, len(horizons) - 0.5)
    axes.tick_params(axis="x", length=0)
    axes.grid(visible=False, axis="x")
    slot = WIDTH / len(names)
    return [
        horizons.index(row["horizon"])
        + slot * (names.index(str(row["controller"])) - (len(names) - 1) / 2)
        for row in rows
    ]


def _number(row: Row, key: str) -> float:
    return float(cast(float, row[key]))


def _times(axes: Axes, rows: Sequence[Row], colors: dict[str, str]) -> None:
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    for x, row in zip(_places(axes, rows, list(colors)), rows, strict=True):
        color = colors[str(row["controller"])]
        median, p99, most = (_number(row, f"{key}_ms") for key in ("median", "p99", "max"))
        axes.plot([x, x], [median, most], color=color, linewidth=1.0, zorder=2)
        axes.plot([x, x], [median, p99], color=color, linewidth=4.0, zorder=3)
        axes.plot(x, median, "o", color=color, markersize=6.5, zorder=4)
        axes.plot(x, most, "_", color=color, markersize=7, zorder=3)


def _margins(axes: Axes, rows: Sequence[Row], colors: dict[str, str]) -> None:
    axes.set_yscale("symlog", linthresh=SHOWN_MARGIN, linscale=0.8)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.axhline(0.0, color=LIMIT, linewidth=1.2)
    axes.set_ylim(-30.0, 1.0)
    axes.set_yticks([-10.0, -1.0, -0.1, 0.0, 0.1, 1.0])
    for x, row in zip(_places(axes, rows, list(colors)), rows, strict=True):
        color, margin = colors[str(row["controller"])], _number(row, "min_margin_mm")
        axes.plot([x, x], [0.0, margin], color=color, linewidth=4.0, zorder=3)
        axes.plot(x, margin, "o", color=color, markersize=5.0, zorder=4)


def _keys(colors: dict[str, str]) -> list[Line2D]:
    names = [
        Line2D([], [], color=color, marker="o", linewidth=4.0, label=name)
        for name, color in colors.items()
    ]
    return [
        *names,
        Line2D([], [], color=GREY, marker="o", linestyle="none", label="median"),
        Line2D([], [], color=GREY, linewidth=4.0, label="to p99"),
        Line2D([], [], color=GREY, marker="_", linewidth=1.0, label="to the longest"),
    ]
