"""Many targets on physics: one of them over time, and where all of them end."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.papers.physics import is_missing
from sinuous.view.curves import LIMIT_DASH, write_plainly
from sinuous.view.style import BLACK, CYCLE, LIMIT, TIME_LABEL, save
from sinuous.view.units import MM_PER_M

ASKED = 0.5  # largest error at rest that is asked for [mm]
WIDTH = 0.3  # of a column of dots

Row = dict[str, Any]


def draw(data: Data, folder: Path) -> list[Path]:
    """One figure."""
    if is_missing(data):
        return []
    return [save(folder / "targets.png", (12.0, 4.8), lambda f: _draw(f, data["rows"]))]


def _draw(figure: Figure, rows: Sequence[Row]) -> None:
    over_time, at_rest = figure.subplots(1, 2)
    columns = list(dict.fromkeys((row["controller"], row["sensor"]) for row in rows))
    names = list(dict.fromkeys(name for name, _ in columns))
    colors = dict(zip(names, CYCLE, strict=False))
    first = columns[0][1]
    for row in rows:
        if row["curve"] is not None and row["sensor"] == first:
            error = np.array(row["curve"]["real_m"]) * MM_PER_M
            name = row["controller"]
            over_time.plot(row["curve"]["time_s"], error, color=colors[name], label=name)
    over_time.set_title("One target, sensor with noise")
    over_time.set_xlabel(TIME_LABEL)
    over_time.margins(x=0.01)
    over_time.legend(loc="upper right")
    count = len({row["target"] for row in rows})
    for k, (name, sensor) in enumerate(columns):
        chosen = [r for r in rows if (r["controller"], r["sensor"]) == (name, sensor)]
        _column(at_rest, k, [r["tip_error_at_rest_m"] * MM_PER_M for r in chosen], colors[name])
    at_rest.set_title(f"{count} targets, at rest")
    labels = [f"{_narrow(name)}\n({sensor})" for name, sensor in columns]
    at_rest.set_xticks(range(len(columns)), labels, fontsize=7.5)
    for axes in (over_time, at_rest):
        axes.set_yscale("log")
        write_plainly(axes.yaxis)
        axes.set_ylabel("true tip error [mm]")
        axes.axhline(ASKED, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2)


def _narrow(name: str) -> str:
    return name.replace(" ", "\n", 1).replace(", ", ",\n").replace("and", "\nand")


def _column(axes: Axes, k: int, values: list[float], color: str) -> None:
    side = np.linspace(-WIDTH, WIDTH, len(values)) if len(values) > 1 else np.zeros(1)
    axes.plot(k + side, values, linestyle="none", marker="o", markersize=3.5, color=color)
    axes.hlines(float(np.median(values)), k - 0.4, k + 0.4, color=BLACK, linewidth=2.0)
