"""Figures of a calibration."""

from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array, IntArray
from sinuous.calibration.calibrate import Calibration
from sinuous.calibration.judge import Judgement
from sinuous.calibration.recording import Recording
from sinuous.view.style import BLACK, BLUE, GREEN, GREY, ORANGE, PALE, VERMILION, save

MM = 1e3
# Names of movements are legible up to about so many.
MOST_NAMED = 90


def draw(
    calibration: Calibration, folder: Path, *, validation: tuple[Recording, Array] | None
) -> list[Path]:
    """Draw residuals, movements and, if there is one, the validation; return the files.

    Arguments:
        calibration: what came out
        folder: where to, made if it is missing
        validation: a recording that was not fitted, and its predicted tips (T, 3) [m]
    """
    folder.mkdir(parents=True, exist_ok=True)
    out = [
        save(folder / "residuals.png", (11, 6), lambda f: _residuals(f, calibration)),
        save(folder / "movements.png", (11, 5), lambda f: _movements(f, calibration)),
    ]
    if validation is not None:
        recording, tips = validation
        out.append(save(folder / "validation.png", (11, 7), lambda f: _tips(f, recording, tips)))
    return out


def _residuals(figure: Figure, calibration: Calibration) -> None:
    above, below = figure.subplots(2, 1, sharex=True)
    own, patterns = calibration.problem.own_zeros, calibration.problem.patterns
    left_out = MM * np.linalg.norm(calibration.left_out, axis=1)
    rows = np.arange(len(patterns))
    for k, (axis, color) in enumerate(zip("xyz", (BLUE, VERMILION, GREEN), strict=True)):
        above.plot(rows, MM * calibration.errors[:, k], color=color, lw=0.9, label=axis)
    above.set_title("Tip error, everything fitted")
    above.set_ylabel("model - measured [mm]")
    above.legend(ncols=3, loc="lower right")
    fitted = MM * np.linalg.norm(calibration.errors, axis=1)
    below.plot(rows, fitted, color=GREY, lw=0.9, label="fitted")
    below.plot(rows, left_out, color=BLUE, lw=1.1, label="left out of the fit")
    below.set_title("Distance, fitted and predicted")
    below.set_ylabel("distance [mm]")
    below.set_xlabel("row")
    below.set_ylim(bottom=0.0)
    below.legend(ncols=2, loc="upper right")
    for axes in (above, below):
        _stripes(axes, patterns)
        if np.any(own):
            axes.axvspan(0, np.count_nonzero(own), color=ORANGE, alpha=0.12, lw=0)
    if np.any(own):
        above.text(0, above.get_ylim()[1], " single pulls", color=GREY, va="top", fontsize=9)


def _stripes(axes: Axes, patterns: IntArray) -> None:
    """A line where one movement ends and another begins."""
    for row in np.flatnonzero(np.diff(patterns)):
        axes.axvline(row + 0.5, color=PALE, lw=0.7, zorder=0)


def _movements(figure: Figure, calibration: Calibration) -> None:
    axes = figure.subplots()
    fitted = calibration.train.by_pattern
    judged = calibration.cross_validation
    left_out = judged.by_pattern if judged else {}
    names = list(fitted)
    places = np.arange(len(names))
    values = [MM * left_out.get(name, np.nan) for name in names]
    axes.bar(places, values, color=BLUE, width=0.8, label="left out of the fit")
    axes.plot(places, [MM * fitted[name] for name in names], "o", ms=4, color=ORANGE,
              mec=BLACK, mew=0.4, label="fitted")  # fmt: skip
    if judged is not None:
        axes.axhline(MM * judged.rmse, color=VERMILION, lw=1.2, ls="--",
                     label=f"all left out: {MM * judged.rmse:.1f} mm")  # fmt: skip
    axes.set_title("Tip error by movement")
    axes.set_ylabel("RMSE [mm]")
    axes.set_xlim(-0.7, len(names) - 0.3)
    axes.grid(visible=False, axis="x")
    axes.set_ylim(0.0, 1.25 * axes.get_ylim()[1])
    if len(names) <= MOST_NAMED:
        short = _short(names)
        axes.set_xticks(places, short, rotation=90, fontsize=6.5 if len(names) > 25 else 9)
    axes.legend(ncols=3, loc="upper right")


def _short(names: list[str]) -> list[str]:
    """Names without the beginning that all share."""
    common = 0
    while all(len(n) > common + 1 and n[common] == names[0][common] for n in names):
        common += 1
    cut = names[0][:common].rfind("_") + 1
    return [name[cut:] for name in names]


def _tips(figure: Figure, recording: Recording, tips: Array) -> None:
    judged = Judgement(
        errors=tips - recording.tips, patterns=recording.patterns, names=recording.names
    )
    seen, rows = tips - judged.offset, np.arange(len(tips))
    all_axes = figure.subplots(4, 1, sharex=True)
    for k, axes in enumerate(all_axes[:3]):
        axes.plot(rows, MM * recording.tips[:, k], color=BLACK, lw=1.1, label="measured")
        axes.plot(rows, MM * seen[:, k], color=VERMILION, lw=1.0, label="predicted")
        axes.set_ylabel(f"{'xyz'[k]} [mm]")
        _stripes(axes, recording.patterns)
    all_axes[0].set_title(f"A recording that was not fitted: {MM * judged.rmse:.1f} mm RMSE")
    all_axes[0].legend(ncols=2, loc="lower right")
    all_axes[3].plot(rows, MM * np.linalg.norm(seen - recording.tips, axis=1), color=BLUE, lw=1.0)
    all_axes[3].set_ylim(bottom=0.0)
    all_axes[3].set_ylabel("distance [mm]")
    all_axes[3].set_xlabel("row")
    _stripes(all_axes[3], recording.patterns)
