"""Two runs side by side."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.recording import Recording
from sinuous.summary import summarise, tip_error
from sinuous.view.curves import (
    LEAST_ERROR_MM,
    LIMIT_DASH,
    NO_STEPS,
    NO_WALL,
    draw_wall,
    scale_error,
    write_plainly,
)
from sinuous.view.style import BLUE, LIMIT, TIME_LABEL, VERMILION, note, save
from sinuous.view.summary_table import summary_rows
from sinuous.view.units import MM_PER_M, MS_PER_S, PERCENT

COLORS = (BLUE, VERMILION)

Summary = Mapping[str, Any]
Runs = list[tuple[str, str, Recording]]
"""(label, colour, run)"""


def save_comparison(
    a: Recording,
    b: Recording,
    out: Path | str,
    *,
    labels: tuple[str, str] | None = None,
    summaries: tuple[Summary, Summary] | None = None,
) -> list[Path]:
    """Write one figure with tip error, clearance, effort, solve time and summaries of two runs.

    Arguments:
        a, b: the runs
        out: the folder for the figure, made if it is not there
        labels: what to call the runs; their names by default
        summaries: what `summarise` gave for them, if it is at hand (it knows the wall time)

    Returns:
        the files
    """
    out = Path(out)
    out.mkdir(parents=True, exist_ok=True)
    names = labels or _names(a, b)
    numbers = summaries or (summarise(a), summarise(b))
    runs: Runs = list(zip(names, COLORS, (a, b), strict=True))

    def draw(figure: Figure) -> None:
        grid = figure.add_gridspec(3, 2, height_ratios=(1.0, 1.0, 1.05))
        _draw_tip_error(figure.add_subplot(grid[0, 0]), runs)
        _draw_clearance(figure.add_subplot(grid[0, 1]), runs)
        _draw_effort(figure.add_subplot(grid[1, 0]), runs)
        _draw_solve_time(figure.add_subplot(grid[1, 1]), runs)
        _draw_table(figure.add_subplot(grid[2, :]), names, numbers)

    return [save(out / "comparison.png", (11.0, 10.0), draw)]


def effort(recording: Recording) -> Array:
    """How hard the actuators work (K,): mean over them of |rate| by its limit, 0 to 1."""
    slowest, fastest = recording.header.rate_limits.T
    limit = np.where(recording.rates < 0.0, np.abs(slowest), np.abs(fastest))
    share = np.divide(
        np.abs(recording.rates), limit, out=np.zeros_like(recording.rates), where=limit > 0.0
    )
    return share.mean(axis=1)


def _names(a: Recording, b: Recording) -> tuple[str, str]:
    first, second = a.header.name, b.header.name
    return (first, second) if first != second else (f"{first} (1)", f"{second} (2)")


def _draw_tip_error(axes: Axes, runs: Runs) -> None:
    axes.set_title("Tip error, measured")
    axes.set(xlabel=TIME_LABEL, ylabel="tip error [mm]")
    errors: list[Array] = []
    for label, color, run in _not_empty(axes, runs):
        error = np.maximum(tip_error(run.actual_tip, run.target) * MM_PER_M, LEAST_ERROR_MM)
        axes.plot(run.time, error, color=color, label=label)
        errors.append(error)
    if errors:
        scale_error(axes, np.concatenate(errors))
        axes.legend()


def _draw_clearance(axes: Axes, runs: Runs) -> None:
    axes.set_title("Body clearance, actual")
    axes.set(xlabel=TIME_LABEL, ylabel="body clearance [mm]")
    walls = [run for run in _not_empty(axes, runs) if np.any(np.isfinite(run[2].actual_clearance))]
    for _, color, run in walls:
        axes.plot(run.time, run.actual_clearance * MM_PER_M, color=color)
    for margin in sorted({run.header.margin for _, _, run in walls}):
        axes.axhline(margin * MM_PER_M, color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH)
    if walls:
        draw_wall(axes)
    elif any(len(run) for _, _, run in runs):
        axes.set_yticks([])
        note(axes, NO_WALL)


def _draw_effort(axes: Axes, runs: Runs) -> None:
    axes.set_title("Effort: mean share of the rate limits")
    axes.set(xlabel=TIME_LABEL, ylabel="effort [%]")
    for _, color, run in _not_empty(axes, runs):
        axes.plot(run.time, effort(run) * PERCENT, color=color)
    axes.set_ylim(bottom=0.0)


def _draw_solve_time(axes: Axes, runs: Runs) -> None:
    axes.set_title("Solve time: share of steps that are faster")
    axes.set(xlabel="solve time [ms]", ylabel="steps [%]", ylim=(0.0, 101.0))
    for _, color, run in _not_empty(axes, runs):
        times = run.solve_time[run.solve_time > 0.0] * MS_PER_S
        if len(times):
            axes.ecdf(times, color=color)
            axes.set_xscale("log")
            write_plainly(axes.xaxis)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value * PERCENT:.0f}")
    axes.set_ylim(0.0, 1.01)


def _draw_table(axes: Axes, names: tuple[str, str], numbers: tuple[Summary, Summary]) -> None:
    axes.set_axis_off()
    first, second = (summary_rows(summary) for summary in numbers)
    rows = [[label, text, other] for (label, text), (_, other) in zip(first, second, strict=True)]
    table = axes.table(
        cellText=rows,
        colLabels=["", *names],
        loc="center",
        cellLoc="right",
        colWidths=[0.3, 0.3, 0.3],
    )
    table.auto_set_font_size(False)
    table.set_fontsize(10.0)
    for (row, column), cell in table.get_celld().items():
        cell.visible_edges = "B"
        cell.set_edgecolor("#D0D0D0")
        cell.set_height(1.0 / (len(rows) + 1))
        if column == 0:
            cell.set_text_props(ha="left", color="#404040")
        elif row == 0:
            cell.set_text_props(ha="right", color=COLORS[column - 1], weight="bold")


def _not_empty(axes: Axes, runs: Runs) -> Runs:
    """The runs that have steps; if none has, the axes say so."""
    found = [run for run in runs if len(run[2])]
    if not found:
        note(axes, NO_STEPS)
    return found
