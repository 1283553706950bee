"""3.3: the norm of the scattering matrix (29) over frequency, and where the channel is passive."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.workers import Workers
from sinuous.teleop.analysis.hybrid import hybrid_matrix
from sinuous.teleop.analysis.passivity import least_gain
from sinuous.teleop.analysis.scattering import largest_norms, scattering_norm
from sinuous.view.curves import LIMIT_DASH
from sinuous.view.style import BLUE, CYCLE, GREY, LIMIT, VERMILION, save

NONE = np.inf  # cutoff of no low-pass [rad/s]
FIG8 = {"gain": 0.6, "impedance": 10.0, "cutoff": 20.0, "delay": 1.0}
"""Printed for Fig. 8."""

ROUNDING = 1e-9
"""By which rounding may put a norm above one."""

SLOWEST, FASTEST = 1e-3, 60.0  # [rad/s]
SHOWN, QUICK_SHOWN = 6001, 1501  # frequencies
SWEPT, QUICK_SWEPT = 1200, 200
GAINS = (0.5, 0.6, 0.7, 0.8, 0.9, 0.99)
BELOW, ABOVE = (0.3, 0.4, 0.45, 0.49), (1.0, 1.5, 2.0)
IMPEDANCES = (0.1, 1.0, 2.0, 10.0, 100.0, 1000.0)
CUTOFFS = (5.0, 20.0, 200.0, NONE)
DELAYS = (0.05, 0.2, 1.0, 2.0)
STANDING = 0.3
"""A gain below 1/2, to see whether b and T say anything about passivity."""

NO_DELAYS = (0.0, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0)


def run(workers: Workers, quick: bool) -> Data:
    """Fig. 8 and the region of parameters in which the norm stays below one."""
    swept = QUICK_SWEPT if quick else SWEPT
    omega, gains = _frequencies(swept), (*BELOW, *GAINS, *ABOVE)
    return {
        "fig8": _fig8(QUICK_SHOWN if quick else SHOWN),
        "sweep": workers.map("scattering norms", sweep, [(gain, swept) for gain in gains]),
        "delays": [_delay(T, omega) for T in NO_DELAYS],
        "impedances": [_impedance(b, omega) for b in IMPEDANCES],
    }


def _fig8(count: int) -> dict[str, Any]:
    """The printed curve, the same without the low-pass, and others with less gain."""
    omega = np.append(SLOWEST, _frequencies(count))
    curves = {
        "K = 0.6": _norm(omega),
        "K = 0.6, no low-pass": _norm(omega, cutoff=NONE),
        "K = 0.49": _norm(omega, gain=0.49),
        "K = 0.3": _norm(omega, gain=0.3),
    }
    # One period of exp(-2 j omega T) after the other.
    period = np.pi / FIG8["delay"]
    number = np.floor(omega / period).astype(np.int64)
    whole = range(int(FASTEST / period))
    return {
        "settings": FIG8,
        "omega_rad_s": omega.round(6).tolist(),
        "norm": {name: values.round(10).tolist() for name, values in curves.items()},
        "period_rad_s": period,
        "mean_by_period": [float(np.mean(curves["K = 0.6"][number == k])) for k in whole],
        "largest_by_period": [float(np.max(curves["K = 0.6"][number == k])) for k in whole],
    }


def _norm(omega: Array, **changes: float) -> Array:
    return scattering_norm(hybrid_matrix(omega, **(FIG8 | changes)))


def sweep(item: tuple[float, int]) -> dict[str, Any]:
    """The largest norm of a K over b, lambda, T and so many frequencies."""
    gain, count = item
    omega = _frequencies(count)
    norms = largest_norms(omega, gains=gain, impedances=IMPEDANCES, cutoffs=CUTOFFS, delays=DELAYS)
    at = np.unravel_index(int(np.argmax(norms)), norms.shape)
    cutoff = CUTOFFS[at[2]]
    return {
        "gain": gain,
        "combinations": norms.size,
        "largest_norm": float(np.max(norms)),
        "impedance_n_s_m": IMPEDANCES[at[1]],
        "cutoff_rad_s": cutoff if np.isfinite(cutoff) else None,
        "delay_s": DELAYS[at[3]],
    }


def _frequencies(count: int) -> Array:
    return np.linspace(FASTEST / count, FASTEST, count)


def _delay(T: float, omega: Array) -> dict[str, float]:
    """A delay: the largest norm of a gain below 1/2, and the least gain that is passive (A11)."""
    least = least_gain(omega, cutoff=FIG8["cutoff"], delay=T)
    bare = _norm(omega, gain=STANDING, delay=T, cutoff=NONE)
    return {
        "delay_s": T,
        "largest_norm": float(np.max(_norm(omega, gain=STANDING, delay=T))),
        "largest_norm_no_low_pass": float(np.max(bare)),
        "least_passive_gain": float(np.max(least)),
    }


def _impedance(b: float, omega: Array) -> dict[str, float]:
    """A wave impedance: the largest norm of a gain below 1/2 and of the smallest passive one."""
    return {
        "impedance_n_s_m": b,
        "largest_norm_below": float(np.max(_norm(omega, gain=0.45, impedance=b, delay=0.2))),
        "largest_norm_at_half": float(np.max(_norm(omega, gain=0.5, impedance=b, delay=0.2))),
    }


def draw(data: Data, folder: Path) -> list[Path]:
    """Fig. 8, and the largest norm over K, b and T."""
    return [
        save(folder / "fig8_scattering_norm.png", (11.0, 5.6), lambda f: _fig8_figure(f, data)),
        save(folder / "passive_region.png", (13.0, 4.2), lambda f: _region(f, data)),
    ]


def _fig8_figure(figure: Figure, data: Data) -> None:
    printed, others = figure.subplots(2, 1, sharex=True)
    fig8 = data["fig8"]
    omega, period = fig8["omega_rad_s"], fig8["period_rad_s"]
    printed.plot(omega, fig8["norm"]["K = 0.6"], color=BLUE, label="K = 0.6")
    middles = period * (np.arange(len(fig8["mean_by_period"])) + 0.5)
    printed.plot(middles, fig8["mean_by_period"], color=GREY, marker=".", label="mean of a period")
    printed.set_title("Fig. 8: K = 0.6, b = 10 N s/m, T = 1 s, λ = 20 rad/s")
    for (name, values), color in zip(list(fig8["norm"].items())[1:], CYCLE[1:], strict=False):
        others.plot(omega, values, color=color, label=name, linewidth=1.1)
    others.set_xlabel("frequency [rad/s]")
    for axes in (printed, others):
        _one(axes)
        axes.set_ylabel("norm of S")
        axes.margins(x=0.01)
        axes.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


def _region(figure: Figure, data: Data) -> None:
    by_gain, by_delay, by_impedance = figure.subplots(1, 3)
    rows = data["sweep"]
    by_gain.plot(
        [r["gain"] for r in rows], [r["largest_norm"] for r in rows], color=BLUE, marker="o"
    )
    by_gain.axvline(0.5, color=GREY, linewidth=1.0)
    by_gain.set(xlabel="K", ylabel="largest norm of S")
    by_gain.set_title(f"Over {rows[0]['combinations']} settings each")
    delays = data["delays"]
    T = [row["delay_s"] for row in delays]
    for key, label, color in (
        ("largest_norm", "λ = 20 rad/s", BLUE),
        ("largest_norm_no_low_pass", "no low-pass", VERMILION),
    ):
        by_delay.plot(T, [row[key] for row in delays], color=color, marker="o", label=label)
    by_delay.set(xlabel="T [s]", title=f"K = {STANDING}, b = 10")
    by_delay.legend()
    b = [row["impedance_n_s_m"] for row in data["impedances"]]
    for key, label, color in (
        ("largest_norm_below", "K = 0.45", VERMILION),
        ("largest_norm_at_half", "K = 0.5", BLUE),
    ):
        norms = [row[key] for row in data["impedances"]]
        by_impedance.plot(b, norms, color=color, marker="o", label=label)
    by_impedance.set(xlabel="b [N s/m]", xscale="log", title="T = 0.2 s, λ = 20 rad/s")
    by_impedance.legend()
    for axes in (by_gain, by_delay, by_impedance):
        _one(axes)


def _one(axes: Axes) -> None:
    axes.axhline(1.0, color=LIMIT, linewidth=1.2, linestyle=LIMIT_DASH)


SCATTERING = Experiment(
    name="scattering",
    title="Norm of the scattering matrix (Fig. 8)",
    section="3.3",
    run=run,
    draw=draw,
)
