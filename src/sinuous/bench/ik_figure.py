"""The figure of `sinuous bench ik`: time and success of every solver, joint motion along a path."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from sinuous.bench.result import Result, Row
from sinuous.view.curves import write_plainly
from sinuous.view.style import BLUE, GREEN, GREY, ORANGE, PURPLE, SKY, VERMILION, save

COLORS = {
    "sinuous": BLUE,
    "from Python": SKY,
    "DLS": VERMILION,
    "DLS, 5 rows": VERMILION,
    "Newton": GREEN,
    "Newton, 5 rows": GREEN,
    "CCD": PURPLE,
    "FABRIK": ORANGE,
}
# What each panel can show without covering itself; all numbers are in the tables.
FOLLOWED = ("sinuous", "DLS", "CCD", "FABRIK")
LEAST_RAD_MM = 1e-5  # smaller motion is drawn there


def draw(result: Result, out: Path) -> list[Path]:
    """Write ik.png."""

    def paint(figure: Figure) -> None:
        left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.15))
        _times(left, result.table("targets").rows)
        _motion(right, cast(Sequence[dict[str, Any]], result.about["series"]))

    return [save(out / "ik.png", (12.0, 4.8), paint)]


def _times(axes: Axes, rows: Sequence[Row]) -> None:
    for place, row in enumerate(rows):
        color = COLORS[str(row["solver"])]
        median, p99, most = (float(cast(float, row[f"{k}_us"])) for k in ("median", "p99", "max"))
        axes.hlines(place, median, most, color=color, linewidth=1.0)
        axes.hlines(place, median, p99, color=color, linewidth=3.6)
        axes.plot(median, place, "o", color=color, markersize=6.0)
        axes.plot(most, place, "|", color=color, markersize=8.0)
        axes.text(
            1.02, place, f"{cast(float, row['solved']):.1%}", color=color, va="center",
            transform=axes.get_yaxis_transform(),
        )  # fmt: skip
    axes.text(1.02, -0.9, "solved", va="center", transform=axes.get_yaxis_transform())
    axes.set_xscale("log")
    write_plainly(axes.xaxis)
    axes.set_yticks(range(len(rows)), [str(row["solver"]) for row in rows])
    axes.set_ylim(len(rows) - 0.4, -0.6)
    axes.grid(False, axis="y")
    axes.set_xlabel("processor time of a target [µs]")
    axes.set_title("Targets all over the disc")
    axes.legend(handles=_keys(), loc="upper right")


def _motion(axes: Axes, series: Sequence[dict[str, Any]]) -> None:
    for name in FOLLOWED:
        one = [each for each in series if each["solver"] == name][-1]  # warm, where it can be
        motion = [max(value, LEAST_RAD_MM) for value in one["largest_rad_mm"]]
        way = [one["step_mm"] * (k + 1) for k in range(len(motion))]
        axes.plot(way, motion, color=COLORS[name], linewidth=1.4, label=name)
    for number, step in enumerate(series[0]["switches"]):
        label = None if number else "k switches"
        way = series[0]["step_mm"] * (step + 1)
        axes.axvline(way, color=GREY, linewidth=0.9, linestyle=(0, (2, 2)), zorder=1, label=label)
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    axes.margins(x=0.01)
    axes.set_xlabel("way of the tip along the longest path [mm]")
    axes.set_ylabel("largest change of a joint angle [rad/mm]")
    axes.set_title("Joint motion, each from its last solution")
    axes.legend(loc="upper right")


def _keys() -> list[Line2D]:
    return [
        Line2D([], [], color=GREY, marker="o", linestyle="none", label="median"),
        Line2D([], [], color=GREY, linewidth=3.6, label="to p99"),
        Line2D([], [], color=GREY, marker="|", linewidth=1.0, label="to the longest"),
    ]
