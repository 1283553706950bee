"""Figures of whole-body sensing: one shape, the error along the body, and whether it is honest."""

from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data
from sinuous.view.style import BLACK, BLUE, GREEN, GREY, ORANGE, PURPLE, VERMILION, save
from sinuous.view.units import MM_PER_M

COLORS = {
    "encoders alone": GREY,
    "encoders, tip": ORANGE,
    "encoders, fibre": GREEN,
    "encoders, fibre, tip": BLUE,
}
FUSED = "encoders, fibre, tip"
SHOWN = ("hachen2025", "representative")
AXES = ("x", "y", "z")
PROMISED = 0.95
CLOSE = 14.0  # half the width of what is seen from near [mm]


def draw(data: Data, folder: Path) -> list[Path]:
    """Three figures."""
    return [
        save(folder / "shape.png", (11.0, 7.4), lambda f: _shape(f, data["example"])),
        save(folder / "along_the_body.png", (9.0, 5.0), lambda f: _along(f, data["rows"])),
        save(folder / "calibration.png", (11.0, 5.6), lambda f: _calibration(f, data)),
    ]


def _shape(figure: Figure, example: Data) -> None:
    grid = figure.add_gridspec(6, 2, width_ratios=(1.0, 1.25))
    true, estimates = np.array(example["true_m"]), example["estimates"]
    whole, near = figure.add_subplot(grid[:3, 0]), figure.add_subplot(grid[3:, 0])
    _side_view(whole, true, estimates)
    whole.set_title("One robot that differs from its model")
    whole.set_aspect("equal", adjustable="datalim")
    whole.legend(loc="lower center")
    tip = _side_view(near, true, estimates)
    near.set_xlim(tip[0] - CLOSE, tip[0] + CLOSE)
    near.set_ylim(tip[1] - 0.5 * CLOSE, tip[1] + 0.5 * CLOSE)
    near.set_aspect("equal")
    near.set_title("Its tip from near, and two stated deviations")
    near.set_xlabel("towards the tip [mm]")
    arc = np.array(example["arc_m"]) * MM_PER_M
    panels = [figure.add_subplot(grid[2 * k : 2 * k + 2, 1]) for k in range(3)]
    for k, axes in enumerate(panels):
        for name in ("encoders, tip", FUSED):
            error = (np.array(estimates[name]["points_m"]) - true)[:, k] * MM_PER_M
            variance = np.array(estimates[name]["covariance_m2"])[:, k, k]
            band = 2.0 * np.sqrt(np.maximum(variance, 0.0)) * MM_PER_M
            color = COLORS[name]
            axes.fill_between(arc, -band, band, color=color, alpha=0.2, linewidth=0.0)
            axes.plot(arc, error, color=color, label=name)
        axes.set_ylabel(f"error in {AXES[k]} [mm]")
        axes.margins(x=0.01)
        axes.tick_params(labelbottom=k == 2)
    panels[0].set_title("Error along the body and two stated deviations")
    panels[0].legend(loc="upper left", ncols=2)
    panels[2].set_xlabel("arc length from the base [mm]")


def _side_view(axes: Axes, true: Array, estimates: Data) -> Array:
    """In the vertical plane of the tip, with two stated deviations to either side of the body.

    Returns the true tip in that plane (2,) [mm].
    """
    across = true[-1, :2] / max(float(np.hypot(*true[-1, :2])), 1e-9)
    plane = np.array([[*across, 0.0], [0.0, 0.0, 1.0]])
    fused = np.array(estimates[FUSED]["points_m"]) @ plane.T * MM_PER_M
    spread = plane @ np.array(estimates[FUSED]["covariance_m2"]) @ plane.T
    along = np.gradient(fused, axis=0)
    normal = np.stack([-along[:, 1], along[:, 0]], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    variance = np.einsum("si,sij,sj->s", normal, spread, normal)
    band = 2.0 * np.sqrt(np.maximum(variance, 0.0))[:, None] * normal * MM_PER_M
    outline = np.concatenate([fused + band, (fused - band)[::-1]])
    axes.fill(*outline.T, color=COLORS[FUSED], alpha=0.25, linewidth=0.0)
    model = np.array(estimates["encoders alone"]["points_m"]) @ plane.T * MM_PER_M
    axes.plot(*model.T, color=GREY, linestyle=(0, (5, 3)), label="model at the encoders' lengths")
    axes.plot(*(true @ plane.T * MM_PER_M).T, color=BLACK, linewidth=2.6, label="true")
    axes.plot(*fused.T, color=COLORS[FUSED], linewidth=1.4, label=f"estimate: {FUSED}")
    axes.set_ylabel("height [mm]")
    return plane @ true[-1] * MM_PER_M


def _along(figure: Figure, rows: Sequence[dict[str, Any]]) -> None:
    axes = figure.subplots()
    for row in rows:
        if (row["robot"], row["mismatch"]) != SHOWN:
            continue
        found = np.array(row["rms_by_point_m"]) * MM_PER_M
        stated = np.array(row["stated_by_point_m"]) * MM_PER_M
        share = np.arange(1, len(found) + 1) / len(found)
        color = COLORS[row["sensors"]]
        axes.plot(share, found, color=color, label=row["sensors"])
        axes.plot(share, stated, color=color, linestyle=(0, (2, 2)), linewidth=1.1)
    axes.plot([], [], color=BLACK, linestyle=(0, (2, 2)), linewidth=1.1, label="stated deviation")
    axes.set_yscale("log")
    axes.set_ylim(bottom=0.05)
    axes.yaxis.set_major_formatter(lambda value, _: f"{value:g}")
    axes.margins(x=0.01)
    axes.set_title(f"Root mean square error along the body ({', '.join(SHOWN)} mismatch)")
    axes.set_xlabel("share of the body from base to tip")
    axes.set_ylabel("error [mm]")
    axes.legend(loc="lower right", ncols=2)


def _calibration(figure: Figure, data: Data) -> None:
    left, right = figure.subplots(1, 2, width_ratios=(1.0, 1.25))
    rows = [row for row in data["rows"] if row["sensors"] == FUSED]
    _histogram(left, data["bins"], rows)
    _coverage(right, rows)


def _histogram(axes: Axes, bins: Sequence[float], rows: Sequence[dict[str, Any]]) -> None:
    """Of all robots and mismatches together, beside what a perfect statement would give."""
    count = np.sum([row["histogram"] for row in rows], axis=0)
    width = bins[1] - bins[0]
    density = count / (np.sum(count) * width)
    middle = np.array(bins[:-1]) + 0.5 * width
    axes.bar(middle, density, width=width, color=BLUE, alpha=0.45, label="all estimates")
    x = np.linspace(bins[0], bins[-1], 200)
    normal = np.exp(-0.5 * x**2) / np.sqrt(2.0 * np.pi)
    axes.plot(x, normal, color=BLACK, label="if stated exactly")
    for side in (-2.0, 2.0):
        axes.axvline(side, ymax=0.75, color=VERMILION, linewidth=1.1, linestyle=(0, (5, 3)))
    axes.set_ylim(top=1.3 * max(float(np.max(density)), float(np.max(normal))))
    axes.set_title("Errors over stated deviation")
    axes.set_xlabel("error / stated deviation, per axis")
    axes.set_ylabel("density")
    axes.legend(loc="upper left")


def _coverage(axes: Axes, rows: Sequence[dict[str, Any]]) -> None:
    colors = dict(zip(AXES, (VERMILION, GREEN, PURPLE), strict=True))
    names = [f"{row['robot']}: {row['mismatch']}" for row in rows]
    for k, axis in enumerate(AXES):
        places = np.arange(len(rows)) + 0.2 * (k - 1)
        values = [100.0 * row["coverage_by_axis"][k] for row in rows]
        axes.plot(values, places, "o", color=colors[axis], markersize=5.0, label=axis)
    axes.axvline(100.0 * PROMISED, color=BLACK, linewidth=1.1, linestyle=(0, (5, 3)))
    axes.set_yticks(range(len(rows)), names)
    axes.invert_yaxis()
    axes.set_xlim(min(90.0, axes.get_xlim()[0]), 101.0)
    axes.set_title("Errors within two stated deviations")
    axes.set_xlabel("share [%]; promised: 95 %")
    axes.legend(loc="lower left", ncols=3, title="axis")
