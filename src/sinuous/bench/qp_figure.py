"""The figure of `sinuous bench qp`: time against the horizon for every solver."""

from pathlib import Path

from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sinuous.bench.axis_figure import logarithmic, numbers, tick
from sinuous.bench.result import Result
from sinuous.view.style import BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, save

COLORS = (BLUE, VERMILION, GREEN, PURPLE, ORANGE)
APART = 0.035  # of the horizon, from solver to solver
ROOM = 1.6  # left and right of the horizons


def draw(result: Result, out: Path) -> list[Path]:
    """Write qp.png."""
    rows = result.table("rows").rows
    names = list(dict.fromkeys(str(row["solver"]) for row in rows))

    def paint(figure: Figure) -> None:
        axes = figure.subplots()
        handles = list[Line2D]()
        for k, (name, color) in enumerate(zip(names, COLORS, strict=True)):
            chosen = [row for row in rows if row["solver"] == name]
            shift = 1.0 + APART * (k - (len(names) - 1) / 2)
            x = [shift * N for N in numbers(chosen, "horizon")]
            median, p99, most = (numbers(chosen, f"{key}_ms") for key in ("median", "p99", "max"))
            axes.vlines(x, median, most, color=color, linewidth=1.0)
            axes.vlines(x, median, p99, color=color, linewidth=3.6)
            axes.plot(x, median, "o-", color=color, markersize=5.5, linewidth=1.2)
            axes.plot(x, most, "_", color=color, markersize=6.0)
            handles.append(Line2D([], [], color=color, marker="o", label=name))
        horizons = numbers(rows, "horizon")
        logarithmic(axes)
        tick(axes.xaxis, horizons)
        axes.set_xlim(min(horizons) / ROOM, max(horizons) * ROOM)
        axes.set_title("One QP of the controller, set up and solved")
        axes.set_xlabel("horizon N")
        axes.set_ylabel("processor time [ms]")
        axes.legend(handles=[*handles, *_keys()], loc="upper left")

    return [save(out / "qp.png", (7.4, 5.2), paint)]


def _keys() -> list[Line2D]:
    return [
        Line2D([], [], color=GREY, linewidth=3.6, label="to p99"),
        Line2D([], [], color=GREY, marker="_", linewidth=1.0, label="to the longest"),
    ]
