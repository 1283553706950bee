"""The figure of `sinuous bench link`: transparency against robustness, and where schemes fail."""

from collections.abc import Sequence
from pathlib import Path
from typing import cast

import numpy as np
from matplotlib.axes import Axes
from matplotlib.colors import LinearSegmentedColormap
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FixedLocator, NullLocator

from sinuous.bench.link_grid import SchemeName
from sinuous.bench.link_summary import CLASSES, FLOOR, makes_energy, number
from sinuous.bench.result import Result, Row
from sinuous.view.style import BLUE, GREEN, GREY, ORANGE, PURPLE, SLATE, VERMILION, save
from sinuous.view.units import MM_PER_M

COLORS = {
    SchemeName.STANDARD: VERMILION,
    SchemeName.C1: BLUE,
    SchemeName.C2: GREEN,
    SchemeName.POSITION_FORCE: PURPLE,
}
NONE = 1e-6  # less energy is drawn there [J]
SHARES = LinearSegmentedColormap.from_list("shares", ["#FFFFFF", ORANGE, VERMILION])


def draw(result: Result, out: Path) -> list[Path]:
    """Write link.png."""
    rows = cast(Sequence[Row], result.about["rows"])

    def paint(figure: Figure) -> None:
        force, tracking, where = figure.subplots(1, 3, width_ratios=(1.0, 1.0, 1.25))
        _trade(force, rows, "force_rms_n", 1.0)
        force.set_xlabel("force error, median of all cells [N]")
        force.set_ylabel("most energy that the channel made [J]")
        force.set_title("Feeling")
        _trade(tracking, rows, "tracking_rms_m", MM_PER_M)
        tracking.set_xlabel("tracking error, median of all cells [mm]")
        tracking.set_title("Following")
        _where(where, [row for row in rows if not row["passivity_control"]])
        figure.legend(handles=_keys(), loc="outside lower left", ncols=2)

    return [save(out / "link.png", (14.5, 5.1), paint)]


def _trade(axes: Axes, rows: Sequence[Row], key: str, scale: float) -> None:
    """Error against the most energy, from without control to with it."""
    for scheme, color in COLORS.items():
        points = list[tuple[float, float]]()
        for control in (False, True):
            own = [
                row
                for row in rows
                if row["scheme"] == scheme and row["passivity_control"] == control
            ]
            error = float(np.median([scale * number(row, key) for row in own]))
            made = max(max(-number(row, "ledger_min_j") for row in own), NONE)
            points.append((error, made))
        axes.annotate(
            "", points[1], points[0],
            arrowprops={"arrowstyle": "-|>", "color": color, "shrinkA": 5, "shrinkB": 5},
        )  # fmt: skip
        for (error, made), face in zip(points, ("white", color), strict=True):
            axes.plot(error, made, "o", color=color, markerfacecolor=face, markersize=8.0)
        axes.annotate(
            scheme.value, points[0], (0, 9), textcoords="offset points", ha="center", color=color
        )
    axes.axhline(-FLOOR, color=GREY, linewidth=0.9, linestyle=(0, (3, 2)), zorder=1)
    axes.annotate(
        r"$F_{max} v_{max} dt$", (0.98, -FLOOR), (0, 3), ha="right", textcoords="offset points",
        xycoords=axes.get_yaxis_transform(), color=SLATE, fontsize=9,
    )  # fmt: skip
    axes.set_yscale("log")
    high = axes.get_ylim()[1]
    axes.set_ylim(0.4 * NONE, 6.0 * high)
    right = axes.get_xlim()[1]
    axes.set_xlim(-0.08 * right, 1.15 * right)  # room for names
    powers = [10.0**k for k in range(-5, int(np.log10(high)) + 2)]
    axes.yaxis.set_major_locator(FixedLocator([NONE, *powers]))
    axes.yaxis.set_minor_locator(NullLocator())
    axes.set_yticklabels(["none", *(f"{power:.5f}".rstrip("0").rstrip(".") for power in powers)])


def _where(axes: Axes, rows: Sequence[Row]) -> None:
    """Share of cells that make energy without control, by kind of connection."""
    shares = np.full((len(SchemeName), len(CLASSES)), np.nan)
    for i, scheme in enumerate(SchemeName):
        for j, of in enumerate(CLASSES.values()):
            own = [row for row in rows if row["scheme"] == scheme and of(row)]
            if own:
                shares[i, j] = np.mean([makes_energy(row) or bool(row["unbounded"]) for row in own])
    axes.imshow(shares, cmap=SHARES, vmin=0.0, vmax=1.0, aspect="auto")
    for (i, j), share in np.ndenumerate(shares):
        if np.isfinite(share):
            axes.text(j, i, f"{share:.0%}", ha="center", va="center", fontsize=10)
    axes.set_xticks(range(len(CLASSES)), list(CLASSES), rotation=30, ha="right")
    axes.set_yticks(range(len(SchemeName)), [scheme.value for scheme in SchemeName])
    axes.tick_params(length=0)
    axes.grid(visible=False)
    axes.spines[:].set_visible(False)
    axes.set_title("Cells that fail without control")


def _keys() -> list[Line2D]:
    return [
        Line2D([], [], color=GREY, marker="o", markerfacecolor="white", ls="none", label="without"),
        Line2D([], [], color=GREY, marker="o", ls="none", label="with passivity control"),
    ]
