"""Figures of section IV: four goals, slack cables, and a boundary that is held."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.view.curves import LIMIT_DASH, draw_wall, write_plainly
from sinuous.view.style import BLUE, CYCLE, GREEN, GREY, LIMIT, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

PAPERS, OURS = "MPC + local", "MPC + local, offset-free"

Row = dict[str, Any]


def draw(data: Data, folder: Path) -> list[Path]:
    """Fig. 12 for the paper's controller and ours, with slack cables too; Fig. 13; all runs."""
    rows = data["rows"]
    shown = {(r["test"], r["controller"]): r["curves"] for r in rows if r["curves"] is not None}
    switches = np.cumsum(data["goal_times_s"])[:-1]
    made = list[Path]()
    for name, test, title in (
        ("fig12_goals", "goals", "Four goals"),
        ("fig12_slack", "slack", "Four goals, cables that go slack beyond 40 deg of bend"),
    ):

        def goals(figure: Figure, test: str = test, title: str = title) -> None:
            draw_goals(figure, title, {c: shown[test, c] for c in (PAPERS, OURS)}, switches)

        made.append(save(folder / f"{name}.png", (10.0, 8.0), goals))
    boundary = {c: shown["boundary", c] for c in (PAPERS, OURS)}
    margin = rows[0]["margin_m"] * MM_PER_M
    made.append(
        save(folder / "fig13_boundary.png", (10.0, 4.6), lambda f: draw_held(f, boundary, margin))
    )
    made.append(save(folder / "all_robots.png", (10.0, 4.6), lambda f: draw_all(f, rows)))
    return made


def draw_goals(figure: Figure, title: str, curves: dict[str, Any], switches: np.ndarray) -> None:
    """Errors of both controllers over time, and inputs; lines where goals change [s]."""
    figure.suptitle(title, weight="bold")
    panels = figure.subplots(3, 1, sharex=True, height_ratios=(1.4, 1.4, 1.0))
    for axes, (name, found) in zip(panels, curves.items(), strict=False):
        for key, label, color in (
            ("real_m", "real tip to target", VERMILION),
            ("nominal_m", "nominal tip to its target", BLUE),
            ("local_m", "real tip to nominal tip", GREEN),
        ):
            values = np.maximum(np.array(found[key]) * MM_PER_M, 1e-3)
            axes.plot(found["time_s"], values, color=color, label=label)
        axes.set_yscale("log")
        write_plainly(axes.yaxis)
        axes.set_ylim(1e-2, 200.0)
        axes.set_ylabel("error [mm]")
        axes.set_title(name)
    for (name, found), color in zip(curves.items(), (BLUE, GREEN), strict=True):
        norm = np.array(found["local_input_m_s"]) * MM_PER_M
        panels[2].plot(found["time_s"], norm, color=color, label=name, linewidth=1.0)
    panels[2].set_ylabel("input of the local\ncontroller [mm/s]")
    panels[2].set_ylim(bottom=0.0)
    panels[2].set_xlabel(TIME_LABEL)
    for axes in panels:
        for time in switches:
            axes.axvline(float(time), color=GREY, linewidth=0.9, linestyle=(0, (2, 2)))
        axes.margins(x=0.01)
    panels[0].legend(loc="lower right", ncols=3)
    panels[2].legend(loc="upper right", ncols=2)


def draw_held(figure: Figure, curves: dict[str, Any], margin: float) -> None:
    """Room between tip and boundary over time, beside the margin [mm]."""
    axes = figure.subplots()
    axes.set_title("A target beyond the wall: room between tip and boundary")
    for (name, found), color in zip(curves.items(), (VERMILION, GREEN), strict=True):
        axes.plot(
            found["time_s"],
            np.array(found["tip_room_m"]) * MM_PER_M,
            color=color,
            label=f"real tip, {name}",
        )
    nominal = np.array(curves[PAPERS]["nominal_tip_room_m"]) * MM_PER_M
    axes.plot(curves[PAPERS]["time_s"], nominal, color=BLUE, label=f"nominal tip, {PAPERS}")
    axes.axhline(margin, color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH, label="margin")
    draw_wall(axes)
    axes.set_ylim(top=2.5 * margin)  # the way there is of no interest
    axes.margins(x=0.01)
    axes.set_xlabel(TIME_LABEL)
    axes.set_ylabel("tip clearance [mm]")
    axes.legend(loc="upper right")


def draw_all(figure: Figure, rows: Sequence[Row]) -> None:
    """Errors at goals and room at the boundary, all rows."""
    error, room = figure.subplots(1, 2)
    figure.suptitle("All runs, one dot for each run and goal")
    goals = [row for row in rows if row["test"] == "goals"]
    _dots(error, goals, "real_error_at_goals_m")
    error.set_ylabel("real tip error at rest [mm]")
    error.set_ylim(bottom=0.0)
    _dots(room, [row for row in rows if row["test"] == "boundary"], "least_tip_room_m")
    room.set_ylabel("least clearance of the real tip\nat the boundary [mm]")
    room.axhline(rows[0]["margin_m"] * MM_PER_M, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2)
    draw_wall(room)


def _dots(axes: Axes, rows: Sequence[Row], key: str) -> None:
    names = list(dict.fromkeys(row["controller"] for row in rows))
    for k, (name, color) in enumerate(zip(names, CYCLE, strict=False)):
        values = np.ravel([row[key] for row in rows if row["controller"] == name]) * MM_PER_M
        side = np.linspace(-0.25, 0.25, len(values)) if len(values) > 1 else np.zeros(1)
        axes.plot(k + side, values, linestyle="none", marker="o", markersize=4, color=color)
    labels = [name.replace(", ", ",\n").replace(" + ", "\n+ ") for name in names]
    axes.set_xticks(range(len(names)), labels)
