"""Sets 1 and 2 on physics: where the real tip is, and what encoders do not see of it."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.papers.physics import is_missing
from sinuous.view.style import BLUE, GREY, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

COLORS = (GREY, BLUE, VERMILION)  # of the plants
SCHEME = "C2"  # which is drawn


def draw(data: Data, folder: Path) -> list[Path]:
    """One figure."""
    if is_missing(data):
        return []
    return [save(folder / "sets_physics.png", (12.0, 6.4), lambda f: _draw(f, data))]


def _draw(figure: Figure, data: Data) -> None:
    """A column for each set: the real tip from its desired place, and what no encoder sees."""
    figure.suptitle(f"Both sets with {SCHEME}", weight="bold", x=0.01, ha="left")
    panels = figure.subplots(2, 2, sharex="col", sharey="row")
    for column, name in enumerate(("set1", "set2")):
        rows = [r for r in data["rows"] if (r["set"], r["scheme"]) == (name, SCHEME)]
        # The model's curve lies on that of physics, so it is drawn last.
        for row, color in reversed(list(zip(rows, COLORS, strict=True))):
            for line, key in enumerate(("real_error_m", "unseen_m")):
                panels[line, column].plot(
                    row["sample_s"], np.array(row[key]) * MM_PER_M, color=color, label=row["plant"]
                )
        panels[0, column].set_title(f"Set {name[-1]}")
        panels[1, column].set_xlabel(TIME_LABEL)
    panels[0, 0].set_ylabel("real tip to desired place [mm]")
    panels[1, 0].set_ylabel("real tip to where\nencoders see it [mm]")
    for axes in panels.flat:
        axes.margins(x=0.01)
        axes.set_ylim(bottom=0.0)
    panels[0, 1].legend(loc="upper right")
