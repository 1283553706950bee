"""How figures look: one palette that colour-blind readers can tell apart, one style."""

from collections.abc import Callable, Generator
from contextlib import contextmanager
from contextvars import ContextVar
from pathlib import Path
from typing import Any

import matplotlib as mpl
import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.colors import LinearSegmentedColormap, to_rgb
from matplotlib.figure import Figure

from sinuous.arrays import Array

# Okabe and Ito, "Color universal design" (2008)
BLACK = "#000000"
ORANGE = "#E69F00"
SKY = "#56B4E9"
GREEN = "#009E73"
YELLOW = "#F0E442"
BLUE = "#0072B2"
VERMILION = "#D55E00"
PURPLE = "#CC79A7"
GREY = "#8A8A8A"
PALE = "#D9DEE3"
PALER = "#EFF2F4"
SLATE = "#66727F"

NOMINAL = BLUE
MEASURED = VERMILION
LIMIT = BLACK
CYCLE = (BLUE, VERMILION, GREEN, PURPLE, ORANGE, SKY)

# Without the last tenth of "plasma", a yellow that white paper swallows.
TIMES = LinearSegmentedColormap.from_list("times", colormaps["plasma"](np.linspace(0.0, 0.8, 64)))
"""Colour of a moment, from the first (0) to the last (1) of a run."""

TIME_LABEL = "time [s]"
DPI = 150

STYLE: dict[Any, Any] = {
    "font.size": 10.5,
    "axes.titlesize": 12,
    "axes.titleweight": "bold",
    "axes.titlelocation": "left",
    "axes.titlepad": 10,
    "axes.labelsize": 10.5,
    "axes.labelcolor": "#303030",
    "axes.edgecolor": "#707070",
    "axes.linewidth": 0.8,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.axisbelow": True,
    "axes.grid": True,
    "grid.color": "#E4E4E4",
    "grid.linewidth": 0.7,
    "xtick.color": "#505050",
    "ytick.color": "#505050",
    "lines.linewidth": 1.6,
    "lines.solid_capstyle": "round",
    "legend.frameon": False,
    "legend.fontsize": 9.5,
    "figure.facecolor": "white",
    "savefig.facecolor": "white",
}


_STAMP = ContextVar("stamp", default="")


@contextmanager
def stamped(text: str) -> Generator[None]:
    """Write that text across the corner of every figure saved meanwhile; nothing if empty."""
    before = _STAMP.set(text)
    try:
        yield
    finally:
        _STAMP.reset(before)


def save(path: Path, size: tuple[float, float], draw: Callable[[Figure], None]) -> Path:
    """Draw one figure of that size [inch] and write it, without pyplot's global figures."""
    with mpl.rc_context(STYLE):
        figure = Figure(figsize=size, layout="constrained")
        FigureCanvasAgg(figure)
        draw(figure)
        if text := _STAMP.get():
            figure.text(0.995, 0.995, text, ha="right", va="top", color=VERMILION, weight="bold")
        figure.savefig(path, dpi=DPI)
    return path


def rgb(color: str) -> Array:
    """Red, green and blue (3,), 0 to 1."""
    return np.array(to_rgb(color))


def note(axes: Axes, text: str) -> None:
    """Say in the middle of empty axes why they are empty."""
    axes.text(
        0.5, 0.5, text, transform=axes.transAxes, ha="center", va="center", color=GREY, fontsize=12
    )
