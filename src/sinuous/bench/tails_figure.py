"""How often a step takes longer than so long, with and without a budget."""

from collections.abc import Mapping
from pathlib import Path
from typing import cast

import matplotlib.pyplot as plt

from sinuous.bench.result import Result

QUANTILES = {"median": 0.5, "p99": 0.01, "p99.9": 0.001, "p99.99": 0.0001}
COLOURS = ("#0072B2", "#009E73", "#D55E00")


def draw(result: Result, folder: Path) -> list[Path]:
    """Write tails.png."""
    figure, (left, right) = plt.subplots(1, 2, figsize=(11.0, 4.2), layout="constrained")
    quantiles = cast(Mapping[str, Mapping[str, float]], result.about["quantiles"])
    for (name, values), colour in zip(quantiles.items(), COLOURS, strict=False):
        times = [values[key] for key in QUANTILES]
        left.plot(times, list(QUANTILES.values()), "o-", color=colour, label=name)
        left.axvline(values["max"], color=colour, linestyle=":", linewidth=1.0)
    left.set(xscale="log", yscale="log", xlabel="processor time of a step [ms]")
    left.set_ylabel("share of steps that take longer")
    left.set_title("the tail; dotted: the slowest step", fontsize=10)
    left.legend(frameon=False, fontsize=9)
    left.grid(alpha=0.3, which="both")
    rows = [row for row in result.table("worst").rows if row["horizon"] == 2]
    bottom = [0.0] * len(rows)
    for phase, colour in zip(("prepare", "solve", "decide"), COLOURS, strict=True):
        heights = [cast(float, row[f"{phase}_ms"]) for row in rows]
        right.bar(range(len(rows)), heights, bottom=bottom, color=colour, label=phase)
        bottom = [a + b for a, b in zip(bottom, heights, strict=True)]
    for k, row in enumerate(rows):
        right.annotate(str(row["qps"]), (k, bottom[k]), ha="center", va="bottom", fontsize=8)
    right.set(xticks=[], xlabel="slowest steps at N = 2, QPs above the bars", ylabel="[ms]")
    right.set_title("where their time goes when they are repeated", fontsize=10)
    right.legend(frameon=False, fontsize=9)
    path = folder / "tails.png"
    figure.savefig(path, dpi=130)
    plt.close(figure)
    return [path]
