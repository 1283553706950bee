"""The figure of `sinuous bench rate`: error of the tip over time at both rates."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any, cast

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.bench.result import Result
from sinuous.bench.scene import DT, WINDOWS
from sinuous.view.curves import write_plainly
from sinuous.view.style import BLUE, PALER, TIME_LABEL, VERMILION, save

LEAST_MM = 1e-2  # smaller errors are drawn there
STYLES: tuple[dict[str, Any], ...] = (
    {"color": VERMILION, "linewidth": 3.2, "alpha": 0.55},
    {"color": BLUE, "linewidth": 1.3},
)


def draw(result: Result, out: Path) -> list[Path]:
    """Write rate.png."""
    series = cast(Sequence[dict[str, Any]], result.about["series_mm"])
    time = cast(list[float], result.about["time_s"])
    horizons = list(dict.fromkeys(one["horizon"] for one in series))

    def paint(figure: Figure) -> None:
        all_axes = figure.subplots(len(horizons), 1, sharex=True, squeeze=False)[:, 0]
        for axes, horizon in zip(all_axes, horizons, strict=True):
            chosen = [one for one in series if one["horizon"] == horizon]
            _errors(axes, time, chosen)
            axes.set_title(f"N = {horizon}")
        all_axes[-1].set_xlabel(TIME_LABEL)
        handles, labels = all_axes[0].get_legend_handles_labels()
        figure.legend(handles, labels, loc="outside lower center", ncols=3)

    return [save(out / "rate.png", (9.0, 2.9 * len(horizons) + 0.7), paint)]


def _errors(axes: Axes, time: list[float], series: Sequence[dict[str, Any]]) -> None:
    for number, (first, last, *_) in enumerate(WINDOWS):
        if first * DT < time[-1]:
            label = None if number else "target outside the mesh"
            axes.axvspan(first * DT, last * DT, color=PALER, zorder=0, label=label)
    for one, style in zip(series, STYLES, strict=True):
        error = [max(value, LEAST_MM) for value in one["tracking"]]
        axes.plot(time, error, label=f"{one['rate_hz']:.0f} Hz", **style)
    axes.set_yscale("log")
    write_plainly(axes.yaxis)
    axes.margins(x=0.01)
    axes.set_ylabel("tip to target [mm]")
