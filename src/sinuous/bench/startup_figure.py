"""The figure of `sinuous bench startup`: what passes before the first control step."""

from pathlib import Path

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.bench.axis_figure import numbers
from sinuous.bench.result import Result
from sinuous.view.style import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, SLATE, save

COLORS = (GREY, SKY, PURPLE, GREEN, ORANGE, BLUE)
SHOWN = 4  # the last row, which compiles everything, would dwarf the others


def draw(result: Result, out: Path) -> list[Path]:
    """Write startup.png."""

    def paint(figure: Figure) -> None:
        axes = figure.subplots()
        _bars(axes, result)
        axes.set_title("New processes, compiled code in the cache")
        axes.set_xlabel("time on the wall [s]")
        axes.legend(loc="upper right")

    return [save(out / "startup.png", (8.6, 4.0), paint)]


def _bars(axes: Axes, result: Result) -> None:
    rows, parts = result.table("rows").rows[:SHOWN], result.table("parts").rows
    names = [str(row["what"]) for row in rows]
    medians, longest = numbers(rows, "median_s"), numbers(rows, "max_s")
    places = range(len(rows))
    axes.barh(places[:-1], medians[:-1], height=0.6, color=SLATE)
    left = 0.0
    for part, length, color in zip(parts, numbers(parts, "median_s"), COLORS, strict=True):
        axes.barh(places[-1], length, left=left, height=0.6, color=color, label=str(part["part"]))
        left += length
    axes.plot(longest, places, "|", color=GREY, markersize=14, label="longest process")
    for place, median in zip(places, medians, strict=True):
        axes.annotate(
            f"{median:.2f} s", (max(longest[place], median), place), (6, 0),
            textcoords="offset points", va="center",
        )  # fmt: skip
    axes.set_yticks(places, names)
    axes.invert_yaxis()
    axes.tick_params(axis="y", length=0)
    axes.grid(visible=False, axis="y")
    axes.set_xlim(0.0, 1.15 * max(longest))
