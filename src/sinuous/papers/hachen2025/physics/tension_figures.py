"""Loss of tension: the least tension of a run over time, and where tips and bodies rest."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.papers.physics import is_missing
from sinuous.view.curves import LIMIT_DASH
from sinuous.view.style import BLACK, BLUE, GREEN, LIMIT, PURPLE, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

COLORS = (VERMILION, GREEN, BLUE, PURPLE)  # of the cures
WIDTH = 0.09  # between the dots of two cures

Row = dict[str, Any]


def draw(data: Data, folder: Path) -> list[Path]:
    """One figure."""
    if is_missing(data):
        return []
    return [save(folder / "tension.png", (12.0, 4.8), lambda f: _draw(f, data))]


def _draw(figure: Figure, data: Data) -> None:
    over_time, at_rest = figure.subplots(1, 2)
    rows: Sequence[Row] = data["rows"]
    cures = list(dict.fromkeys(row["cure"] for row in rows))
    colors = dict(zip(cures, COLORS, strict=False))
    low = min(row["pretension_m"] for row in rows)
    first = rows[0]["controller"]
    for row in rows:
        if (row["controller"], row["pretension_m"], row["target"]) == (first, low, 0):
            over_time.plot(
                row["time_s"], row["least_tension_n"], color=colors[row["cure"]], label=row["cure"]
            )
    over_time.axhline(data["floor_n"], color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2)
    over_time.set_title(f"{first}, one target, pretension {low * MM_PER_M:g} mm")
    over_time.set_xlabel(TIME_LABEL)
    over_time.set_ylabel("least tension of all cables [N]")
    over_time.margins(x=0.01)
    over_time.set_ylim(top=2.0 * data["floor_n"])
    over_time.legend(title="cure", loc="upper right")
    _errors(at_rest, rows, colors)


def _errors(axes: Axes, rows: Sequence[Row], colors: Mapping[str, str]) -> None:
    """Columns of dots for each controller and pretension, one for each cure."""
    columns = list(dict.fromkeys((row["controller"], row["pretension_m"]) for row in rows))
    for k, column in enumerate(columns):
        for j, (cure, color) in enumerate(colors.items()):
            values = [
                row["body_error_at_rest_m"] * MM_PER_M
                for row in rows
                if (row["controller"], row["pretension_m"], row["cure"]) == (*column, cure)
            ]
            if not values:
                continue
            x = k + 2.2 * WIDTH * (j - 1.5)
            axes.plot(
                np.full(len(values), x), values, linestyle="none", marker="o", markersize=4,
                color=color,
            )  # fmt: skip
            axes.hlines(float(np.median(values)), x - WIDTH, x + WIDTH, color=BLACK, linewidth=2.0)
    labels = [f"{name}\n{pretension * MM_PER_M:g} mm" for name, pretension in columns]
    axes.set_xticks(range(len(columns)), labels)
    axes.set_ylim(bottom=0.0)
    axes.set_title("At rest, a dot for each target")
    axes.set_ylabel("largest distance of the body\nfrom where the model has it [mm]")
