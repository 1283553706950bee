"""Figs. 10 to 13, and the error of the force of both schemes on the same motion."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.view.curves import BENEATH, LIMIT_DASH
from sinuous.view.style import BLUE, GREEN, GREY, LIMIT, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

NUMBERS = {
    ("set1", "C1"): ("fig10_set1_c1", "Set 1, free motion: C1"),
    ("set1", "C2"): ("fig11_set1_c2", "Set 1, free motion: C2"),
    ("set2", "C1"): ("fig12_set2_c1", "Set 2, contact: C1"),
    ("set2", "C2"): ("fig13_set2_c2", "Set 2, contact: C2"),
}
COLORS = {"C1": VERMILION, "C2": BLUE}


def draw(data: Data, folder: Path) -> list[Path]:
    """One figure for each set and scheme, and one that compares the schemes."""
    made = list[Path]()
    for row in data["rows"]:
        if row["curves"] is None:
            continue
        name, title = NUMBERS[row["set"], row["scheme"]]

        def panels(figure: Figure, row: dict[str, Any] = row, title: str = title) -> None:
            _panels(figure, row, title, data)

        made.append(save(folder / f"{name}.png", (12.0, 6.4), panels))
    made.append(save(folder / "force_error.png", (12.0, 6.0), lambda f: _errors(f, data)))
    return made


def _panels(figure: Figure, row: Data, title: str, data: Data) -> None:
    """Positions above and forces below, one column for each axis."""
    figure.suptitle(title, weight="bold", x=0.01, ha="left")
    panels = figure.subplots(2, 2, sharex=True, sharey="row")
    curves, side = row["curves"], data["boundary_m"] * MM_PER_M
    for column, axis in enumerate(data["axes"]):
        places, forces = panels[:, column]
        for key, label, color in (
            ("leader_m", "leader, mapped", GREY),
            ("desired_m", "desired", GREEN),
            ("follower_m", "follower", BLUE),
        ):
            values = MM_PER_M * np.array(curves[key][column])
            style = BENEATH if key == "desired_m" else {}
            places.plot(_time(row, values), values, color=color, label=label, **style)
        for limit in (-side, side):
            label = "boundary" if limit > 0.0 else None
            places.axhline(limit, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2, label=label)
        for key, label, color in (
            ("felt_n", "felt at the leader, $F_m$", VERMILION),
            ("virtual_n", "virtual, $F_s$", BLUE),
        ):
            values = np.array(curves[key][column])
            forces.plot(_time(row, values), values, color=color, label=label)
        places.set_title(f"{axis} axis")
        forces.set_xlabel(TIME_LABEL)
        forces.margins(x=0.01)
        _shade(forces, row, axis)
        _shade(places, row, axis)
    panels[0, 0].set_ylabel("position [mm]")
    panels[1, 0].set_ylabel("force [N]")
    for axes in panels[:, 1]:
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _shade(axes: Axes, row: Data, axis: str) -> None:
    """Where the follower has reached the boundary on this axis."""
    for contact in row["contacts"]:
        if contact["axis"] == axis:
            axes.axvspan(contact["from_s"], contact["to_s"], color=GREY, alpha=0.15, linewidth=0)


def _time(row: Data, values: np.ndarray) -> np.ndarray:
    return row["period_s"] * np.arange(len(values))


def _errors(figure: Figure, data: Data) -> None:
    """F_m less F_s of one delay before, where the leader moves the same with both schemes."""
    figure.suptitle(
        "Error of the force felt, the same motion of the leader", weight="bold", x=0.01, ha="left"
    )
    panels = figure.subplots(2, 2, sharex="row", sharey="row")
    for line, name in enumerate(("set1", "set2")):
        for column, axis in enumerate(data["axes"]):
            axes = panels[line, column]
            for row in data["rows"]:
                if row["set"] == name and row["force_error_n"] is not None:
                    values = np.array(row["force_error_n"][column])
                    axes.plot(
                        _time(row, values), values, color=COLORS[row["scheme"]], label=row["scheme"]
                    )
            axes.set_title(f"Set {name[-1]}, {axis} axis")
            axes.margins(x=0.01)
        panels[line, 0].set_ylabel("$F_m(t) - F_s(t - T)$ [N]")
    for axes in panels[1]:
        axes.set_xlabel(TIME_LABEL)
    panels[0, 1].legend(loc="upper right")
