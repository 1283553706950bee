"""How often a step takes longer than so long, and where the time of the slowest goes."""

from collections.abc import Mapping
from pathlib import Path
from typing import cast

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.bench.result import Result
from sinuous.view.curves import write_plainly
from sinuous.view.style import BLUE, GREEN, VERMILION, save

QUANTILES = {"median": 0.5, "p99": 0.01, "p99.9": 0.001, "p99.99": 0.0001}
COLORS = (BLUE, GREEN, VERMILION)


def draw(result: Result, out: Path) -> list[Path]:
    """Write tails.png."""

    def paint(figure: Figure) -> None:
        left, right = figure.subplots(1, 2)
        _tails(left, cast(Mapping[str, Mapping[str, float]], result.about["quantiles"]))
        _phases(right, result)

    return [save(out / "tails.png", (11.6, 4.6), paint)]


def _tails(axes: Axes, quantiles: Mapping[str, Mapping[str, float]]) -> None:
    for (name, values), color in zip(quantiles.items(), COLORS, strict=False):
        times = [values[key] for key in QUANTILES]
        axes.plot(times, list(QUANTILES.values()), "o-", color=color, label=name)
        axes.axvline(values["max"], color=color, linestyle=":", linewidth=1.0)
    axes.set(xscale="log", yscale="log", xlabel="processor time of a step [ms]")
    axes.set_ylabel("share of steps that take longer")
    axes.set_title("The tail; dotted: the slowest step")
    write_plainly(axes.xaxis)
    axes.legend()


def _phases(axes: Axes, result: Result) -> None:
    rows = [row for row in result.table("worst").rows if row["horizon"] == 2]
    bottom = [0.0] * len(rows)
    for phase, color in zip(("prepare", "solve", "decide"), COLORS, strict=True):
        heights = [cast(float, row[f"{phase}_ms"]) for row in rows]
        axes.bar(range(len(rows)), heights, bottom=bottom, color=color, label=phase)
        bottom = [a + b for a, b in zip(bottom, heights, strict=True)]
    for k, row in enumerate(rows):
        axes.annotate(str(row["qps"]), (k, bottom[k]), ha="center", va="bottom", fontsize=8)
    axes.set(xticks=[], xlabel="slowest steps at N = 2, QPs above the bars")
    axes.set_ylabel("processor time when repeated [ms]")
    axes.set_title("Where their time goes")
    axes.legend()
