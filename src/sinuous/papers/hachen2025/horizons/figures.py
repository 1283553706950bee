"""Figures of the horizons: a dead end, the map of one, and what steps bring and cost."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Circle

from sinuous.bench.axis_figure import draw_times, keys, tick
from sinuous.papers.experiment import Data
from sinuous.papers.hachen2025.horizons.scenes import (
    HOLE,
    HOLE_RADIUS,
    PLATE,
    TARGET,
    shown_scenario,
)
from sinuous.papers.hachen2025.horizons.verdicts import (
    PERIOD,
    REACHED,
    errors,
    families,
    guided,
    settled,
)
from sinuous.papers.sketch import unsketch
from sinuous.session.header import make_header
from sinuous.view.curves import LIMIT_DASH, write_plainly
from sinuous.view.scene3d import draw_shapes
from sinuous.view.style import (
    BLACK,
    BLUE,
    CYCLE,
    GREEN,
    GREY,
    LIMIT,
    ORANGE,
    PALE,
    PURPLE,
    SKY,
    VERMILION,
    save,
)
from sinuous.view.units import MM_PER_M, MS_PER_S, PERCENT

HORIZON = "steps looked ahead N"


def draw(data: Data, folder: Path) -> list[Path]:
    """The dead end with a short and with a long horizon, its map, and the statistics."""
    made = list[Path]()
    for row in data["shown"]:

        def shapes(figure: Figure, row: dict[str, Any] = row) -> None:
            header = make_header(shown_scenario(row["horizon"]))
            draw_shapes(figure, unsketch(row["sketch"], header))
            end = f"the tip ends {row['error_m'] * MM_PER_M:.1f} mm from its target"
            figure.suptitle(f"N = {row['horizon']} at 30 Hz: {end}", weight="bold")

        path = folder / f"dead_end_n{row['horizon']}.png"
        made.append(save(path, (14.0, 7.4), shapes))
    made.append(save(folder / "map.png", (7.4, 7.6), lambda figure: _map(figure, data)))
    made.append(save(folder / "horizons.png", (11.5, 8.4), lambda figure: _numbers(figure, data)))
    return made


def _map(figure: Figure, data: Data) -> None:
    """Seen along z: targets behind the plate, coloured by the shortest horizon that arrives."""
    axes, names = figure.subplots(), data["map_horizons"]
    targets = np.array([row["target_m"] for row in data["map"]]) * MM_PER_M
    reached = np.array([row["error_m"] for row in data["map"]]) <= REACHED
    first = np.where(reached.any(axis=1), reached.argmax(axis=1), len(names))
    axes.add_patch(Circle(tuple(HOLE * MM_PER_M), HOLE_RADIUS * MM_PER_M, color=PALE, zorder=0))
    style: dict[str, Any] = {"linestyle": "none", "marker": "o", "markersize": 11}
    for k, (N, color) in enumerate(zip(names, (GREEN, SKY, ORANGE, PURPLE), strict=True)):
        x, y = targets[first == k, :2].T
        axes.plot(x, y, color=color, label=f"first reached with N = {N}", **style)
    x, y = targets[first == len(names), :2].T
    axes.plot(x, y, "x", color=GREY, markersize=8, label="reached by none of them")
    x, y = TARGET[:2] * MM_PER_M
    axes.plot(x, y, "*", color=BLACK, markersize=15, label="target of the other figures")
    axes.plot([], [], "o", color=PALE, markersize=14, label="hole in the plate")
    behind = (TARGET[2] - PLATE) * MM_PER_M
    axes.set_title(f"Targets {behind:.0f} mm behind the plate, seen along z, 30 Hz")
    axes.set_xlabel("x [mm]")
    axes.set_ylabel("y [mm]")
    axes.set_aspect("equal")
    figure.legend(loc="outside lower center", ncols=2)


def _numbers(figure: Figure, data: Data) -> None:
    """What is reached and how near, how soon the body rests, and what a step costs."""
    (share, error), (rest, cost) = figure.subplots(2, 2)
    for rate, color, size in ((100.0, VERMILION, 9), (30.0, BLUE, 6), (10.0, GREEN, 4)):
        found = [row for row in data["attempts"] if row["rate_hz"] == rate]
        if found:
            horizons, values = errors(data, rate)
            name = f"{rate:.0f} Hz"
            part = np.mean(values <= REACHED, axis=0) * PERCENT
            style: dict[str, Any] = {"color": color, "label": name, "markersize": size}
            share.plot(horizons, part, "o-", **style)
            error.plot(horizons, np.mean(values, axis=0) * MM_PER_M, "o-", **style)
    count, total = guided(data)
    along = f"two way-points on the way ({count} of {total})"
    share.axhline(count / total * PERCENT, color=LIMIT, linestyle=LIMIT_DASH, label=along)
    share.set_ylim(0.0, 1.09 * PERCENT)
    share.set_title("Targets behind a plate with a hole")
    share.set_ylabel("reached [%]")
    error.set_ylim(0.0, 1.15 * error.get_ylim()[1])
    error.set_title("The same targets")
    error.set_ylabel("mean tip error at the end [mm]")
    for family, color in zip(families(data), CYCLE, strict=False):
        times = settled(data, family)
        rest.plot(list(times), list(times.values()), "o-", color=color, label=family)
    rest.set_ylim(0.0, 1.15 * rest.get_ylim()[1])
    rest.set_title("Targets that every N reaches, 30 Hz")
    rest.set_ylabel("mean time until the body rests [s]")
    _cost(cost, data)
    for axes in (share, error, rest, cost):
        axes.set_xscale("log")
        tick(axes.xaxis, data["horizons"])
        axes.set_xlabel(HORIZON)
    for axes in (share, error, rest):
        axes.legend(loc="lower right")


def _cost(axes: Axes, data: Data) -> None:
    names = ("median", "p99", "max")
    rows = [
        {"horizon": row["horizon"]} | {f"{k}_ms": row[f"{k}_s"] * MS_PER_S for k in names}
        for row in data["cost"]
    ]
    draw_times(axes, rows, "horizon", BLUE)
    axes.axhline(PERIOD * MS_PER_S, color=LIMIT, linestyle=LIMIT_DASH)
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    axes.set_title("Time of a step, all scenes, 100 Hz")
    axes.set_ylabel("time on the wall [ms]")
    period = Line2D([], [], color=LIMIT, linestyle=LIMIT_DASH, label="period of 100 Hz")
    axes.legend(handles=[*keys(), period], loc="lower right")
