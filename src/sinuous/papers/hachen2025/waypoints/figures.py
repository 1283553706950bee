"""Figures of III-D: the ways through the passages, and the room that was left."""

from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.papers.hachen2025.runs import scenario
from sinuous.papers.sketch import unsketch
from sinuous.session.header import make_header
from sinuous.view.curves import LIMIT_DASH, draw_wall
from sinuous.view.scene3d import draw_shapes
from sinuous.view.style import CYCLE, LIMIT, TIME_LABEL, save
from sinuous.view.units import MM_PER_M, PERCENT

NUMBERS = {
    ("winding_tube", "MPC"): "fig7_winding_tube_mpc",
    ("winding_tube", "DLS, printed gains"): "fig8_winding_tube_dls",
    ("winding_tube", "DLS, best gains"): "fig8_winding_tube_dls_best_gains",
    ("inverted_u", "MPC"): "video_inverted_u_mpc",
    ("inverted_u", "DLS, printed gains"): "video_inverted_u_dls",
    ("inverted_u", "DLS, best gains"): "video_inverted_u_dls_best_gains",
}

Rows = Sequence[dict[str, Any]]


def draw(data: Data, folder: Path) -> list[Path]:
    """The shapes of every run without disturbance, and two figures of clearance."""
    exact = [row for row in data["rows"] if not row["disturbed"]]
    disturbed = [row for row in data["rows"] if row["disturbed"]]
    made = list[Path]()
    for row in exact:

        def shapes(figure: Figure, row: dict[str, Any] = row) -> None:
            draw_shapes(figure, unsketch(row["sketch"], make_header(scenario(row["scene"]))))
            figure.suptitle(row["controller"], weight="bold")

        path = folder / f"{NUMBERS[row['scene'], row['controller']]}.png"
        made.append(save(path, (14.0, 6.8), shapes))
    made.append(save(folder / "clearance.png", (10.0, 7.0), lambda f: _clearance(f, exact)))
    made.append(save(folder / "disturbed.png", (10.0, 7.0), lambda f: _disturbed(f, disturbed)))
    return made


def _clearance(figure: Figure, rows: Rows) -> None:
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    panels = figure.subplots(len(scenes), 1)
    for axes, scene in zip(panels, scenes, strict=True):
        chosen = [row for row in rows if row["scene"] == scene]
        for row, color in zip(chosen, CYCLE, strict=False):
            room = np.array(row["clearance_m"]) * MM_PER_M
            axes.plot(row["time_s"], room, color=color, label=row["controller"])
        margin = chosen[0]["margin_m"] * MM_PER_M
        axes.axhline(margin, color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH, label="margin")
        draw_wall(axes)
        axes.margins(x=0.01)
        axes.set_title(scene.replace("_", " ") + ", no disturbance")
        axes.set_ylabel("body clearance [mm]")
    panels[-1].set_xlabel(TIME_LABEL)
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))


def _disturbed(figure: Figure, rows: Rows) -> None:
    scenes = list(dict.fromkeys(row["scene"] for row in rows))
    figure.suptitle("With the printed disturbance: one dot for each run")
    panels = figure.subplots(2, len(scenes), sharex=True, sharey="row")
    for column, scene in enumerate(scenes):
        chosen = [row for row in rows if row["scene"] == scene]
        worst, share = panels[0, column], panels[1, column]
        worst.set_title(scene.replace("_", " "))
        _dots(worst, chosen, lambda row: row["least_actual_clearance_m"] * MM_PER_M)
        _dots(share, chosen, lambda row: row["steps_in_the_wall"] / row["steps"] * PERCENT)
        worst.axhline(0.0, color=LIMIT, linewidth=1.2)
    panels[0, 0].set_ylabel("least clearance of\nthe real body [mm]")
    panels[1, 0].set_ylabel("steps with the real body\nin the wall [%]")
    panels[0, 0].set_ylim(top=4.0)
    panels[1, 0].set_ylim(0.0, PERCENT)


def _dots(axes: Axes, rows: Rows, value: Callable[[dict[str, Any]], float]) -> None:
    names = list(dict.fromkeys(row["controller"] for row in rows))
    for k, (name, color) in enumerate(zip(names, CYCLE, strict=False)):
        values = [value(row) for row in rows if row["controller"] == name]
        side = np.linspace(-0.15, 0.15, len(values)) if len(values) > 1 else np.zeros(1)
        axes.plot(k + side, values, linestyle="none", marker="o", color=color)
    axes.set_xticks(range(len(names)), [name.replace(", ", ",\n") for name in names])
    axes.set_xlim(-0.6, len(names) - 0.4)
