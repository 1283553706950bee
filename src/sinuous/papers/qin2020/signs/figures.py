"""Figures of 3.2: what the printed signs and units do."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sinuous.papers.experiment import Data
from sinuous.view.curves import LIMIT_DASH
from sinuous.view.style import BLUE, LIMIT, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

PRINTED, OURS = "printed", "ours"
COLORS = {PRINTED: VERMILION, OURS: BLUE}


def draw(data: Data, folder: Path) -> list[Path]:
    """Both readings at both sides, and both dampers."""
    return [
        save(folder / "signs.png", (12.0, 4.2), lambda f: _signs(f, data)),
        save(folder / "damper.png", (8.0, 3.6), lambda f: _dampers(f, data["damping"])),
    ]


def _signs(figure: Figure, data: Data) -> None:
    point, arm = figure.subplots(1, 2)
    for row in data["point"]:
        place = np.maximum(np.abs(row["z_m"]), 1e-4)
        style = "solid" if row["side"] == "upper" else (0, (2, 2))
        label = f"{row['force']}, {row['side']} side"
        time = row["period_s"] * np.arange(len(place))
        point.plot(time, place, color=COLORS[row["force"]], linestyle=style, label=label)
    point.set(yscale="log", xlabel=TIME_LABEL, ylabel="distance of a point from the middle [m]")
    point.set_title("Follower without bounds")
    point.legend(loc="upper left")
    for row in data["chain"]:
        color = COLORS[row["force"]]
        time = row["period_s"] * np.arange(len(row["z_m"]))
        arm.plot(time, MM_PER_M * np.array(row["desired_m"]), color=color, linestyle=(0, (1, 1)))
        arm.plot(time, MM_PER_M * np.array(row["z_m"]), color=color)
    side = MM_PER_M * data["boundary_m"]
    for limit in (-side, side):
        arm.axhline(limit, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2)
    arm.set(xlabel=TIME_LABEL, ylabel="z [mm]")
    arm.set_title("The arm (solid) and where it should be (dots)")


def _dampers(figure: Figure, rows: list[dict[str, Any]]) -> None:
    axes = figure.subplots()
    for row, color in zip(reversed(rows), (VERMILION, BLUE), strict=True):
        time = row["period_s"] * np.arange(len(row["force_n"]))
        label = f"$c_b$ = {row['damping_n_s_m']:g} N s/m"
        axes.plot(time, row["force_n"], color=color, label=label)
    axes.set(xlabel=TIME_LABEL, ylabel="virtual force on z [N]")
    axes.set_title("Two readings of the damper, first contact of Set 2")
    axes.legend(loc="upper left")
