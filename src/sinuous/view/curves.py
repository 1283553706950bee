"""One quantity of a run over time, drawn on axes that are given."""

from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.ticker import FuncFormatter, LogFormatter

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.recording import Recording
from sinuous.summary import tip_error, violates_margin
from sinuous.view.style import (
    BLACK,
    GREY,
    LIMIT,
    MEASURED,
    NOMINAL,
    PURPLE,
    SKY,
    TIME_LABEL,
    VERMILION,
    note,
)
from sinuous.view.units import MM_PER_M, MS_PER_S

LEAST_ERROR_MM = 1e-4
"""Errors below 0.1 micrometre are drawn there: no robot shows them, and logarithms need a floor."""

LOG_SPREAD = 50.0
"""A curve that spans more than this factor reads better on a logarithmic axis."""

MOVING_SHARE = 0.2
"""A target that changes in more than this share of the steps moves; otherwise it jumps."""

NO_STEPS = "no steps recorded"
NO_WALL = "no wall: clearance is unlimited"
LIMIT_DASH = (0, (5, 3))
BENEATH: dict[str, Any] = {"linewidth": 3.6, "alpha": 0.5}
"""Style of the broader curve of two that are often the same."""


def way_point_switches(recording: Recording) -> IntArray:
    """Steps at which a new way-point begins; none if the target moves all the time."""
    changed = np.flatnonzero(np.any(np.diff(recording.target, axis=0) != 0.0, axis=1)) + 1
    return changed if len(changed) <= MOVING_SHARE * len(recording) else changed[:0]


def way_points(recording: Recording) -> Array:
    """The targets (W, 3) [m] in the order they were given; none if the target moves."""
    switches = way_point_switches(recording)
    if not len(switches) and np.any(recording.target != recording.target[:1]):
        return recording.target[:0]
    return recording.target[np.concatenate(([0], switches))]


def draw_tip_error(axes: Axes, recording: Recording) -> None:
    """Distance from tip to target, of the model and of the plant."""
    if not prepare(axes, recording, "tip error [mm]"):
        return
    nominal = _error_mm(recording.nominal_tip, recording.target)
    actual = _error_mm(recording.actual_tip, recording.target)
    axes.plot(recording.time, actual, color=MEASURED, label="actual", **BENEATH)
    axes.plot(recording.time, nominal, color=NOMINAL, label="nominal")
    scale_error(axes, np.concatenate((nominal, actual)))
    mark_switches(axes, recording)


def scale_error(axes: Axes, values: Array) -> None:
    """A logarithmic axis if the values span decades, else a linear one from zero."""
    if values.max() > LOG_SPREAD * values.min():
        axes.set_yscale("log")
        write_plainly(axes.yaxis)
        axes.set_ylim(top=values.max() * 2.0)
    else:
        axes.set_ylim(0.0, values.max() * 1.1)


def write_plainly(axis: Axis) -> None:
    """Write decades as 0.1, 1, 10 rather than as powers."""
    axis.set_major_formatter(FuncFormatter(_plain))
    axis.set_minor_formatter(_BetweenDecades())


def mark_switches(axes: Axes, recording: Recording) -> None:
    """A thin line wherever the target jumps to its next way-point."""
    for i, k in enumerate(way_point_switches(recording)):
        axes.axvline(
            float(recording.time[k]),
            color=GREY,
            linewidth=0.9,
            linestyle=(0, (2, 2)),
            zorder=1,
            label="next way-point" if i == 0 else None,
        )


def draw_clearance(axes: Axes, recording: Recording) -> None:
    """Least clearance of the body, the margin, and the steps that break it."""
    if not prepare(axes, recording, "body clearance [mm]"):
        return
    if not np.any(np.isfinite(recording.nominal_clearance)):
        axes.set_yticks([])
        note(axes, NO_WALL)
        return
    actual, nominal = recording.actual_clearance, recording.nominal_clearance
    axes.plot(recording.time, actual * MM_PER_M, color=MEASURED, label="actual", **BENEATH)
    axes.plot(recording.time, nominal * MM_PER_M, color=NOMINAL, label="nominal")
    margin = recording.header.margin * MM_PER_M
    axes.axhline(margin, color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH, label="margin")
    draw_wall(axes)
    broken = violates_margin(recording)
    if np.any(broken):
        axes.plot(
            recording.time,
            np.where(broken, nominal * MM_PER_M, np.nan),
            color=BLACK,
            linewidth=3.2,
            marker="o",
            markersize=3.2,
            markeredgewidth=0.0,
            label=f"margin violated ({np.count_nonzero(broken)} steps)",
        )
    mark_switches(axes, recording)


def draw_wall(axes: Axes) -> None:
    """Shade what is inside the wall, and keep it in view without letting it fill the axes."""
    low, high = axes.get_ylim()
    low = min(0.0, low) - 0.04 * (high - low)
    axes.axhspan(low, 0.0, color=VERMILION, alpha=0.15, linewidth=0, label="wall")
    axes.set_ylim(low, high)


def draw_solve_time(axes: Axes, recording: Recording) -> None:
    """Solve time of every step, on a logarithmic axis, with the control period above it."""
    if not prepare(axes, recording, "solve time [ms]"):
        return
    times, late = recording.solve_time * MS_PER_S, is_late(recording)
    dots: dict[str, Any] = {"linestyle": "none", "marker": ".", "markersize": 4.5}
    for chosen, color, label in ((~late, SKY, "in time"), (late, VERMILION, "late")):
        if np.any(chosen):
            name = f"{label} ({np.count_nonzero(chosen)} steps)"
            axes.plot(recording.time[chosen], times[chosen], color=color, label=name, **dots)
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    mark_solve_times(axes, recording)


def is_late(recording: Recording) -> BoolArray:
    """Which steps (K,) took the controller longer than a control period."""
    return recording.solve_time > recording.header.dt


def mark_solve_times(axes: Axes, recording: Recording) -> None:
    """Horizontal lines at the median, the 99th percentile and the control period."""
    times = recording.solve_time * MS_PER_S
    period = recording.header.dt * MS_PER_S
    lines = (
        ("control period", period, LIMIT, LIMIT_DASH),
        ("99th percentile", float(np.percentile(times, 99)), PURPLE, "solid"),
        ("median", float(np.median(times)), NOMINAL, "solid"),
    )
    for name, value, color, style in lines:
        label = f"{name}: {value:.3g} ms"
        axes.axhline(value, color=color, linewidth=1.3, linestyle=style, label=label)


def prepare(axes: Axes, recording: Recording, label: str) -> bool:
    """Label the axes; whether there is anything to draw."""
    axes.set_xlabel(TIME_LABEL)
    axes.set_ylabel(label)
    if not len(recording):
        note(axes, NO_STEPS)
        return False
    axes.margins(x=0.01)
    return True


class _BetweenDecades(LogFormatter):
    """Numbers between decades, on axes too short for decades alone."""

    def __call__(self, x: float, pos: int | None = None) -> str:
        return _plain(x, pos) if super().__call__(x, pos) else ""


def _plain(value: float, _: int | None) -> str:
    return f"{value:g}"


def _error_mm(tip: Array, target: Array) -> Array:
    return np.maximum(tip_error(tip, target) * MM_PER_M, LEAST_ERROR_MM)
