"""The figures of one run."""

from pathlib import Path

import numpy as np
from matplotlib.figure import Figure

from sinuous.recording import Recording
from sinuous.view.by_hand import by_hand_height, draw_by_hand
from sinuous.view.curves import (
    NO_STEPS,
    draw_clearance,
    draw_solve_time,
    draw_tip_error,
    mark_solve_times,
)
from sinuous.view.rates import draw_rates, rates_height
from sinuous.view.scene3d import draw_shapes
from sinuous.view.style import SKY, note, save
from sinuous.view.units import MS_PER_S

WIDE = (10.0, 4.6)


def save_figures(recording: Recording, out: Path | str) -> list[Path]:
    """Write all figures of a run as PNG files.

    Arguments:
        recording: one run; zero steps and free space are fine
        out: the folder for the figures, made if it is not there

    Returns:
        the files, in the order in which to look at them
    """
    out = Path(out)
    out.mkdir(parents=True, exist_ok=True)
    figures = [
        save(out / "shapes.png", (14.0, 6.6), lambda f: draw_shapes(f, recording)),
        save(out / "tip_error.png", WIDE, lambda f: _tip_error(f, recording)),
        save(out / "clearance.png", WIDE, lambda f: _clearance(f, recording)),
        save(
            out / "rates.png",
            (10.0, rates_height(recording)),
            lambda f: draw_rates(f, recording),
        ),
        save(out / "solve_time.png", WIDE, lambda f: _solve_time(f, recording)),
    ]
    if len(recording.signals):
        size = (12.0, by_hand_height(recording))
        figures.append(save(out / "by_hand.png", size, lambda f: draw_by_hand(f, recording)))
    return figures


def _tip_error(figure: Figure, recording: Recording) -> None:
    axes = figure.subplots()
    axes.set_title("Distance from the tip to its target")
    draw_tip_error(axes, recording)
    _legend(figure)


def _clearance(figure: Figure, recording: Recording) -> None:
    axes = figure.subplots()
    axes.set_title("Least clearance between body surface and wall")
    draw_clearance(axes, recording)
    _legend(figure)


def _solve_time(figure: Figure, recording: Recording) -> None:
    axes, histogram = figure.subplots(1, 2, sharey=True, width_ratios=(3.0, 1.0))
    axes.set_title("Wall-clock time of the controller per step, against the control period")
    draw_solve_time(axes, recording)
    histogram.set_xlabel("share of steps [%]")
    if not len(recording):
        note(histogram, NO_STEPS)
        return
    times = recording.solve_time * MS_PER_S
    positive = times[times > 0.0]
    if len(positive):
        edges = np.geomspace(positive.min() / 1.1, positive.max() * 1.1, 25)
        weights = np.full(len(positive), 100.0 / len(times))
        histogram.hist(
            positive, bins=list(edges), weights=weights, orientation="horizontal", color=SKY
        )
    mark_solve_times(histogram, recording)
    _legend(figure)


def _legend(figure: Figure) -> None:
    """One legend above the first axes, in a row, where it hides no data."""
    handles, labels = figure.axes[0].get_legend_handles_labels()
    if handles:
        figure.legend(
            handles, labels, loc="outside lower center", ncols=len(handles), columnspacing=1.3
        )
