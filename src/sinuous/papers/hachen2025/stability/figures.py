"""Figures of the stability search: who comes to rest, one case that does not, and the gains."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data
from sinuous.papers.hachen2025.plane import X, Z, draw_passage, draw_target
from sinuous.papers.hachen2025.settling import END, End
from sinuous.papers.hachen2025.undisturbed import DLS, FREE, MPC, place
from sinuous.view.curves import LIMIT_DASH
from sinuous.view.style import BLUE, GREEN, LIMIT, ORANGE, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M, PERCENT

AIR = 0.015  # around the passage [m]
SMALLEST, LARGEST = 1e-6, 1e2  # what a tip covers is drawn between these [mm]

COLORS = {MPC: BLUE, **dict(zip(DLS, (VERMILION, ORANGE, GREEN), strict=True))}

Rows = list[dict[str, Any]]


def draw(data: Data, folder: Path) -> list[Path]:
    """All targets, the worst one, and the search for the best gains."""
    return [
        save(folder / "oscillation.png", (11.0, 5.4), lambda f: _all(f, data)),
        save(folder / "fig9_unstable_dls.png", (11.0, 5.4), lambda f: _worst(f, data["example"])),
        save(folder / "gain_search.png", (11.0, 4.0), lambda f: _search(f, data["search"])),
    ]


def _all(figure: Figure, data: Data) -> None:
    """For every extent the share of targets at which the tip covers more."""
    rows: Rows = data["rows"]
    places = list(dict.fromkeys(row["place"] for row in rows))
    for axes, name in zip(figure.subplots(1, len(places), sharey=True), places, strict=True):
        chosen = [row for row in rows if row["place"] == name]
        laws = list(dict.fromkeys(row["controller"] for row in chosen))
        for law in laws:
            _share(axes, [row for row in chosen if row["controller"] == law], law, COLORS[law])
        axes.axvline(
            data["oscillating_above_m"] * MM_PER_M, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2
        )
        axes.set_xscale("log")
        axes.set_xlim(SMALLEST, LARGEST)
        axes.set_title(f"{name.replace('_', ' ')}, {len(chosen) // len(laws)} targets")
        axes.set_xlabel("peak to peak of the tip in the last 2 s [mm]")
        axes.legend(
            loc="upper left", bbox_to_anchor=(0.0, -0.16), title="above 0.5 mm (to and fro)"
        )
    figure.axes[0].set_ylabel("targets with more than that [%]")


def _share(axes: Axes, rows: Rows, law: str, color: str) -> None:
    ends = [End(extent=row["extent_m"], path=row["path_m"]) for row in rows]
    moving, back = sum(end.moving for end in ends), sum(end.to_and_fro for end in ends)
    extents = np.sort([max(end.extent * MM_PER_M, SMALLEST) for end in ends])
    left = PERCENT * (1.0 - np.arange(len(extents) + 1) / len(extents))
    extents = np.concatenate([[SMALLEST], extents])
    axes.step(extents, left, where="post", color=color, label=f"{law}: {moving} ({back})")


def _worst(figure: Figure, example: Data) -> None:
    """The tip's distance from the target, how it moves at the end, and the last shapes."""
    grid = figure.add_gridspec(2, 3, width_ratios=(1.4, 1.0, 1.0))
    whole, last = figure.add_subplot(grid[0, 0]), figure.add_subplot(grid[1, 0])
    shapes = [figure.add_subplot(grid[:, k]) for k in (1, 2)]
    here, target = place(example["place"]), np.array(example["target_m"])
    for (law, way), axes in zip(example["ways"].items(), shapes, strict=True):
        tip, color = MM_PER_M * np.array(way["tip_m"]), COLORS[law]
        time = example["dt_s"] * np.arange(len(tip))
        away = np.linalg.norm(tip - MM_PER_M * target, axis=1)
        whole.plot(time, away, color=color, label=law)
        ending = time > time[-1] - END
        last.plot(time[ending], _along_the_longest(tip[ending]), color=color)
        if example["place"] == FREE:
            axes.set_aspect("equal", adjustable="datalim")
            axes.set_xlabel("x [mm]")
        else:
            draw_passage(axes, here.zone, air=AIR)
        for points in np.array(way["shapes_m"]) * MM_PER_M:
            axes.plot(points[:, X], points[:, Z], color=color, linewidth=1.2)
        draw_target(axes, target)
        axes.set_title("the last second")
    whole.set_title("one target, undisturbed")
    whole.set_ylabel("tip to target [mm]")
    whole.set_ylim(bottom=0.0)
    whole.legend(loc="upper right")
    last.set_xlabel(TIME_LABEL)
    last.set_ylabel("tip along its\nlargest motion [mm]")
    shapes[0].set_ylabel("z [mm]")


def _along_the_longest(path: Array) -> Array:
    """A path (K, 3) along the direction in which it covers most, around its mean."""
    around = path - path.mean(axis=0)
    return around @ np.linalg.svd(around, full_matrices=False)[2][0]


def _search(figure: Figure, rows: Rows) -> None:
    """How often every candidate fails, and what its runs cost."""
    dampings = sorted({row["damping"] for row in rows})
    gains = sorted({row["gain"] for row in rows})
    penalties = sorted({row["penalty"] for row in rows})
    most = max(row["failed"] for row in rows)
    panels = figure.subplots(1, len(dampings), sharey=True, squeeze=False)[0]
    for axes, damping in zip(panels, dampings, strict=True):
        failed = np.full((len(penalties), len(gains)), np.nan)
        for row in rows:
            if row["damping"] != damping:
                continue
            i, j = penalties.index(row["penalty"]), gains.index(row["gain"])
            failed[i, j] = row["failed"]
            best = {"weight": "bold"} if row is rows[0] else {}
            text = f"{row['failed']}\n{row['cost_s']:.1f} s"
            color = "white" if row["failed"] > 0.5 * most else "black"
            axes.text(j, i, text, ha="center", va="center", fontsize=9, color=color, **best)
        axes.imshow(failed, origin="lower", vmin=0, vmax=most + 1, cmap="Blues", aspect="auto")
        axes.set_xticks(range(len(gains)), [f"{gain:g}" for gain in gains])
        axes.set_yticks(range(len(penalties)), [f"{penalty:.3g}" for penalty in penalties])
        axes.set_xlabel("$k_j$")
        axes.set_title(f"$c_w$ = {damping:g}")
        axes.grid(visible=False)
    panels[0].set_ylabel("stiffness of the penalty,\ndh/du by dh/dx")
    figure.suptitle(f"Failed of {rows[0]['runs']} runs, and the mean cost of a run; best in bold")
