"""Time of a step over what is varied: median, 99th percentile and the longest."""

from collections.abc import Sequence
from typing import cast

from matplotlib.axes import Axes
from matplotlib.axis import Axis
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from sinuous.bench.result import Row
from sinuous.view.curves import write_plainly
from sinuous.view.style import GREY


def numbers(rows: Sequence[Row], key: str) -> list[float]:
    """A column of numbers."""
    return [float(cast(float, row[key])) for row in rows]


def draw_times(axes: Axes, rows: Sequence[Row], key: str, color: str, unit: str = "ms") -> None:
    """A band from the median to the 99th percentile, and a dash at the longest."""
    x = numbers(rows, key)
    median, p99, most = (numbers(rows, f"{name}_{unit}") for name in ("median", "p99", "max"))
    axes.fill_between(x, median, p99, color=color, alpha=0.18, linewidth=0.0)
    axes.plot(x, p99, color=color, linewidth=1.0)
    axes.plot(x, median, "o-", color=color, markersize=5.0)
    axes.plot(x, most, "_", color=color, markersize=9.0, markeredgewidth=1.4)


def keys() -> list[Line2D]:
    """What the marks mean."""
    return [
        Line2D([], [], color=GREY, marker="o", markersize=5.0, label="median"),
        Line2D([], [], color=GREY, linewidth=1.0, label="99th percentile"),
        Line2D([], [], color=GREY, marker="_", markersize=9.0, linestyle="none", label="longest"),
    ]


def logarithmic(axes: Axes) -> None:
    """Both axes, with numbers as people write them."""
    axes.set_xscale("log")
    axes.set_yscale("log")
    write_plainly(axes.yaxis)


def tick(axis: Axis, values: Sequence[float]) -> None:
    """A tick at every value, with thousands set apart."""
    axis.set_major_locator(FixedLocator(sorted(set(values))))
    axis.set_minor_locator(NullLocator())
    axis.set_major_formatter(FuncFormatter(_thousands))


def _thousands(value: float, _: int | None) -> str:
    return f"{value:,.6g}"
