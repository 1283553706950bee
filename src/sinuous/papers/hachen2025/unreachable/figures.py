"""Figures of III-E: shapes at rest, room at rest over all targets, and what sweeps do."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data
from sinuous.papers.hachen2025.plane import X, Y, Z, draw_body, draw_passage, draw_target
from sinuous.papers.hachen2025.undisturbed import place
from sinuous.papers.hachen2025.unreachable.sweeps import SWEEPS
from sinuous.view.curves import LIMIT_DASH
from sinuous.view.style import BLUE, GREEN, GREY, LIMIT, ORANGE, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

COLORS = {"MPC": BLUE, "DLS, printed gains": VERMILION, "DLS, best gains": GREEN}
AIR = 0.045  # around the passage, so that targets beside it are seen [m]
AROUND = 35.0  # around the ways of a sweep [mm]
DOTTED: dict[str, Any] = {"color": LIMIT, "linestyle": (0, (1.2, 1.6))}
SIDE = 0.28  # half the width of a column of dots

Rows = list[dict[str, Any]]


def draw(data: Data, folder: Path) -> list[Path]:
    """Shapes as in Fig. 10, the room at rest, and one figure for each sweep."""
    sweeps = list(dict.fromkeys(row["sweep"] for row in data["sweeps"]))
    made = [
        save(folder / "fig10_unreachable.png", (13.0, 5.2), lambda f: _shapes(f, data)),
        save(folder / "room_at_rest.png", (10.0, 6.4), lambda f: _rest(f, data)),
    ]
    for name in sweeps:
        rows = [row for row in data["sweeps"] if row["sweep"] == name]

        def passing(figure: Figure, name: str = name, rows: Rows = rows) -> None:
            _sweep(figure, name, rows, data["dt_s"])

        path = folder / f"sweep_{name.replace(' ', '_')}.png"
        made.append(save(path, (11.0, 6.4), passing))
    return made


def label(row: dict[str, Any]) -> str:
    """A controller and what it aims at."""
    return f"{row['controller']}, projected target" if row["projected"] else str(row["controller"])


def _shapes(figure: Figure, data: Data) -> None:
    """The start and every controller at the end, for the target most in the picture's plane."""
    here = place(data["place"])
    plain = [row for row in data["rest"] if not row["projected"] and row["controller"] in COLORS]

    def aside(row: dict[str, Any]) -> float:
        target = np.array(row["target_m"])
        return float(abs(target - here.zone.nearest(target).foot)[Y])

    target = min(plain, key=aside)["target_m"]
    panels = figure.subplots(1, len(COLORS) + 1, sharey=True)
    for axes in panels:
        draw_passage(axes, here.zone, air=AIR)
        draw_target(axes, np.array(target))
    draw_body(panels[0], here.robot, np.array(data["start_points_m"]), GREY)
    panels[0].set_title("start")
    panels[0].set_ylabel("z [mm]")
    chosen = [row for row in plain if row["target_m"] == target]
    for axes, row in zip(panels[1:], chosen, strict=True):
        draw_body(axes, here.robot, np.array(row["points_m"]), COLORS[row["controller"]])
        axes.set_title(row["controller"])
        room = f"clearance {row['clearance_at_rest_m'] * MM_PER_M:.1f} mm"
        axes.text(0.04, 0.96, room, transform=axes.transAxes, va="top")


def _rest(figure: Figure, data: Data) -> None:
    """Room left and distance to the target, one dot for each target."""
    rows: Rows = data["rest"]
    names = list(dict.fromkeys(label(row) for row in rows))
    room, error = figure.subplots(2, 1, sharex=True)
    for k, name in enumerate(names):
        chosen = [row for row in rows if label(row) == name]
        color = COLORS.get(chosen[0]["controller"], ORANGE)
        _dots(room, k, [row["clearance_at_rest_m"] for row in chosen], color)
        _dots(error, k, [row["tip_error_m"] for row in chosen], color)
    count = len(rows) // len(names)
    time = f"after {data['duration_s']:g} s"
    figure.suptitle(f"{count} targets 10 to 40 mm outside the tube, one dot each, {time}")
    margin = data["margin_m"] * MM_PER_M
    room.axhline(margin, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2, label="margin")
    room.axhline(0.0, color=LIMIT, linewidth=1.2, label="wall")
    room.legend(loc="lower right")
    room.set_ylabel("clearance of the body [mm]")
    error.set_ylabel("tip to target [mm]")
    error.set_ylim(bottom=0.0)
    error.set_xticks(range(len(names)), [name.replace(", ", ",\n") for name in names])


def _dots(axes: Axes, k: int, values: list[float], color: str) -> None:
    side = SIDE * np.linspace(-1.0, 1.0, len(values)) if len(values) > 1 else np.zeros(1)
    found = MM_PER_M * np.array(values)
    axes.plot(k + side, found, linestyle="none", marker="o", markersize=4, color=color)
    axes.hlines(float(np.median(found)), k - 0.35, k + 0.35, color=LIMIT, linewidth=1.0)


def _sweep(figure: Figure, name: str, rows: Rows, dt: float) -> None:
    """The zone with the ways of target and tips, and how fast aims and tips move."""
    grid = figure.add_gridspec(2, 2, width_ratios=(1.0, 1.2))
    space, aims, tips = (figure.add_subplot(g) for g in (grid[:, 0], grid[0, 1], grid[1, 1]))
    tips.sharex(aims)
    draw_passage(space, SWEEPS[name]().here.zone)
    target = MM_PER_M * np.array(rows[0]["target_m"])
    places = [target]
    for row in rows:
        tip = MM_PER_M * np.array(row["tip_m"])
        style: dict[str, Any] = {"color": COLORS[row["controller"]], "label": label(row)}
        style |= {"linestyle": (0, (4, 1.5)), "linewidth": 1.4} if row["projected"] else {}
        space.plot(tip[:, X], tip[:, Z], **style)
        _way(tips, tip, dt, **style)
        places.append(tip)
    projection = next(MM_PER_M * np.array(row["aim_m"]) for row in rows if row["projected"])
    _way(aims, target, dt, label="the target", **DOTTED)
    _way(aims, projection, dt, label="its projection", color=LIMIT)
    aims.legend(loc="lower right")
    for axes in (aims, tips):
        axes.set_ylim(bottom=0.0)
    space.plot(target[:, X], target[:, Z], label="target", **DOTTED)
    low, high = np.min(np.concatenate(places), axis=0), np.max(np.concatenate(places), axis=0)
    space.set_xlim(low[X] - AROUND, high[X] + AROUND)
    space.set_ylim(low[Z] - AROUND, high[Z] + AROUND)
    space.set_ylabel("z [mm]")
    aims.set_title("what a controller aims at")
    tips.set_title("the tip")
    tips.set_xlabel(TIME_LABEL)
    figure.suptitle(f"A target that sweeps {name}")
    figure.legend(*space.get_legend_handles_labels(), loc="outside lower center", ncols=3)


def _way(axes: Axes, path: Array, dt: float, **style: Any) -> None:
    """How far from its beginning a path (K, 3) [mm] is."""
    axes.plot(dt * np.arange(len(path)), np.linalg.norm(path - path[0], axis=1), **style)
    axes.set_ylabel("from the start [mm]")
