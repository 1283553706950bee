"""The figure of `sinuous bench rod`: a few shapes, errors of all of them, convergence."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from mpl_toolkits.mplot3d import Axes3D

from sinuous.bench.result import Result, Row
from sinuous.view.curves import write_plainly
from sinuous.view.style import BLACK, BLUE, CYCLE, GREY, VERMILION, save
from sinuous.view.units import MM_PER_M

SHOWN = 6  # shapes, spread over the order of their error
PERCENT = 100.0
ASKED_MEAN, ASKED_WORST = 0.5, 2.0  # [%]


def draw(result: Result, out: Path) -> list[Path]:
    """Write rod.png."""

    def paint(figure: Figure) -> None:
        grid = figure.add_gridspec(1, 3, width_ratios=(1.15, 1.0, 1.0))
        rows = cast(Sequence[Row], result.about["rows"])
        lines = cast(Sequence[dict[str, Any]], result.about["lines"])
        _shapes(figure.add_subplot(grid[0], projection="3d"), rows, lines)
        _errors(figure.add_subplot(grid[1]), rows)
        _convergence(figure.add_subplot(grid[2]), result.table("convergence").rows)

    return [save(out / "rod.png", (14.0, 4.8), paint)]


def _shapes(axes: Axes3D, rows: Sequence[Row], lines: Sequence[dict[str, Any]]) -> None:
    order = np.argsort([cast(float, row["mean_error_fraction"]) for row in rows])
    chosen = order[np.linspace(0, len(order) - 1, min(SHOWN, len(order))).astype(int)]
    for color, number in zip(CYCLE, chosen, strict=False):
        ours = np.array(lines[number]["points_m"]) * MM_PER_M
        theirs = np.array(lines[number]["file_points_m"]) * MM_PER_M
        axes.plot(*ours.T, color=color, linewidth=1.6)
        axes.plot(*theirs.T, "o", color=color, markersize=4.0, markerfacecolor="none")
    axes.plot([], [], color=GREY, label="here")
    axes.plot([], [], "o", color=GREY, markerfacecolor="none", label="in the file")
    axes.set_aspect("equal")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.set_zlabel("z [mm]")
    axes.locator_params(nbins=3)
    axes.tick_params(pad=1.0)
    axes.legend(loc="upper right")
    axes.set_title("Shapes, from the best to the worst", loc="left")


def _errors(axes: Axes, rows: Sequence[Row]) -> None:
    for key, color, label in (
        ("mean_error_fraction", BLUE, "mean of the stations"),
        ("worst_error_fraction", VERMILION, "worst station"),
    ):
        values = np.sort([PERCENT * cast(float, row[key]) for row in rows])
        axes.plot(PERCENT * np.arange(1, len(values) + 1) / len(values), values, color=color,
                  label=label)  # fmt: skip
    for asked, text in ((ASKED_MEAN, "asked of the mean"), (ASKED_WORST, "asked of the worst")):
        axes.axhline(asked, color=BLACK, linewidth=0.9, linestyle=(0, (4, 3)))
        axes.text(1.0, asked * 1.08, text, color=BLACK, fontsize=9)
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    axes.set_xlabel("share of the shapes [%]")
    axes.set_ylabel("error [% of the length]")
    axes.set_title("Errors of all shapes, sorted")
    axes.legend(loc="lower right")


def _convergence(axes: Axes, rows: Sequence[Row]) -> None:
    links = [cast(int, row["links_per_half"]) for row in rows]
    for key, color, label in (
        ("worst_error_fraction", VERMILION, "worst, to the file"),
        ("mean_error_fraction", BLUE, "mean, to the file"),
    ):
        axes.plot(links, [PERCENT * cast(float, row[key]) for row in rows], "o-", color=color,
                  label=label)  # fmt: skip
    changes = [PERCENT * cast(float, row["change_fraction"]) for row in rows[:-1]]
    axes.plot(links[:-1], changes, "s-", color=GREY, label="mean, to twice as many links")
    slope = [changes[0] * (links[0] / count) ** 2 for count in links]
    axes.plot(links, slope, color=BLACK, linewidth=0.9, linestyle=(0, (4, 3)), label="order 2")
    axes.set_xscale("log", base=2)
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    axes.set_xticks(links, [str(count) for count in links])
    axes.set_xlabel("links in each half")
    axes.set_ylabel("error [% of the length]")
    axes.set_title("Convergence")
    axes.legend(loc="upper right")
