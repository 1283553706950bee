"""The figure of III-F: time of a step over the horizon, and what is printed."""

from pathlib import Path
from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from sinuous.papers.experiment import Data
from sinuous.papers.hachen2025.timing.verdicts import (
    BELOW_BOUND,
    OURS,
    PRINTED_BOUND,
    PRINTED_HORIZON,
    PRINTED_MEAN,
    of,
)
from sinuous.view.curves import LIMIT_DASH, write_plainly
from sinuous.view.style import BLUE, GREEN, GREY, LIMIT, ORANGE, PURPLE, SLATE, VERMILION, save
from sinuous.view.units import MS_PER_S

LONGEST = 20.8  # end of the axis of horizons


def draw(data: Data, folder: Path) -> list[Path]:
    """Write timing.png."""

    def paint(figure: Figure) -> None:
        panels = figure.subplots(1, 2, sharey=True)
        for axes, constrained in zip(panels, (True, False), strict=True):
            _times(axes, data, constrained)
            _printed(axes, constrained)
            axes.set_title(f"{'With' if constrained else 'Without'} shape constraints")
            axes.set_xlabel("steps looked ahead N")
            axes.set_xticks((1, 2, 3, 4, 5, 6, 10, 15, 20))
            axes.set_xlim(0.2, LONGEST)
        panels[0].set_yscale("log")
        write_plainly(panels[0].yaxis)
        panels[0].set_ylabel("processor time of a step [ms]")
        handles, labels = panels[0].get_legend_handles_labels()
        handles.append(Patch(color=GREY, alpha=0.3))
        labels.append("median to 99th percentile")
        figure.legend(handles, labels, loc="outside lower center", ncols=3)

    return [save(folder / "timing.png", (12.0, 6.2), paint)]


def _times(axes: Axes, data: Data, constrained: bool) -> None:
    """Means as lines with marks, and bands from the median to the 99th percentile."""
    names = dict.fromkeys(row["controller"] for row in data["rows"])
    for name, color in zip(names, (BLUE, VERMILION, ORANGE, GREEN, PURPLE, SLATE), strict=False):
        rows = of(data, name, constrained)
        if not rows:
            continue
        mean, median, p99 = (
            [row[key] * MS_PER_S for row in rows.values()]
            for key in ("mean_s", "median_s", "p99_s")
        )
        style: dict[str, Any] = {"marker": "o", "markersize": 4.0 if name == OURS else 6.0}
        axes.plot(list(rows), mean, color=color, label=f"{name}, mean", **style)
        axes.fill_between(list(rows), median, p99, color=color, alpha=0.15, linewidth=0.0)


def _printed(axes: Axes, constrained: bool) -> None:
    """The printed mean, and the bound up to the horizon that it is stated for."""
    bound, end = PRINTED_BOUND * MS_PER_S, BELOW_BOUND[constrained] - 0.5
    axes.plot(
        (0.2, end),
        (bound, bound),
        color=LIMIT,
        linestyle=LIMIT_DASH,
        marker="v",
        markevery=(1, 1),
        label="printed: the mean stays below",
    )
    axes.annotate(
        f"N < {BELOW_BOUND[constrained]}", (end, bound), (8, -4), textcoords="offset points"
    )
    if constrained:
        mean = PRINTED_MEAN * MS_PER_S
        axes.plot(
            PRINTED_HORIZON, mean, "*", color=LIMIT, markersize=15, label="printed: mean, N = 2"
        )
