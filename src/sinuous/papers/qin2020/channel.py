"""3.1 and 3.3: energy of the channel in time, tick by tick (notes A11), and (20), (21)."""

import warnings
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.workers import Workers
from sinuous.teleop.analysis.passivity import power_terms
from sinuous.teleop.analysis.ports import PortRun, channel_energy, drive_ports, worst_sinusoid
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.waves import ActiveChannelWarning, ModifiedWaves, Scheme, StandardWaves
from sinuous.view.style import CYCLE, GREY, TIME_LABEL, save

DT = 1e-3  # [s]
IMPEDANCE, CUTOFF = 10.0, 20.0  # b [N s/m], lambda [rad/s]
GAINS = (0.3, 0.49, 0.5, 1.0)
STANDARD = "standard waves"
NAMES = (*(f"K = {gain:g}" for gain in GAINS), STANDARD)
DELAYS = (0.0, 0.2, 0.7)  # [s]
RANDOM, WORST = "random", "worst sinusoid"
INPUTS = (RANDOM, WORST)
DURATION, QUICK_DURATION = 40.0, 4.0  # [s]
OMEGA = np.linspace(1.0, 60.0, 5901)  # frequencies among which the worst is [rad/s]
SEED = 9
SPEED, FORCE = 0.1, 1.0  # standard deviation of random inputs [m/s], [N]
HELD = 20  # ticks that a random value is held for, on average
SHOWN = 60.0  # largest energy in the figure of sinusoids [J]
STRIDE = 100  # ticks between the points that are kept

Item = tuple[str, float, str, float]


def run(workers: Workers, quick: bool) -> Data:
    """Every scheme and delay with both inputs."""
    duration = QUICK_DURATION if quick else DURATION
    items: list[Item] = [
        (name, delay, what, duration) for delay in DELAYS for name in NAMES for what in INPUTS
    ]
    return {
        "impedance_n_s_m": IMPEDANCE,
        "cutoff_rad_s": CUTOFF,
        "duration_s": duration,
        "rows": workers.map("energy of the channel", drive, items),
    }


def drive(item: Item) -> dict[str, Any]:
    """One scheme over one delay with one input."""
    name, delay, what, duration = item
    scheme, omega, power = _scheme(name), None, None
    if what == RANDOM:
        v, force = _random(round(duration / DT))
    else:
        gain = scheme.gain if isinstance(scheme, ModifiedWaves) else 0.5
        # Of ports without a delay of their own a packet takes a tick: so does theory.
        late = ConstantDelay(delay=delay, dt=DT).ticks * DT
        worst = worst_sinusoid(OMEGA, gain=gain, impedance=IMPEDANCE, cutoff=CUTOFF, delay=late)
        (v, force), omega, power = worst.signals(duration, DT), worst.omega, worst.power
    found = drive_ports(scheme, delay, v, force)
    energy = channel_energy(found, v, force, DT)
    return {
        "scheme": name,
        "delay_s": delay,
        "input": what,
        "omega_rad_s": omega,
        "power_by_theory_w": power if isinstance(scheme, ModifiedWaves) else None,
        "least_j": float(np.min(energy, initial=0.0)),
        "last_j": float(energy[-1]),
        "energy_j": energy[STRIDE - 1 :: STRIDE].round(6).tolist(),
        **_identities(scheme, found, v, force, delay),
    }


def _scheme(name: str) -> Scheme:
    if name == STANDARD:
        return StandardWaves(impedance=IMPEDANCE, dt=DT)
    gain = GAINS[NAMES.index(name)]
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ActiveChannelWarning)  # that is what is shown
        return ModifiedWaves(
            impedance=IMPEDANCE, gain=gain, cutoff=CUTOFF, dt=DT, allow_active=True
        )


def _random(ticks: int) -> tuple[Array, Array]:
    """Velocity and force (K, 1) that jump at random times."""
    rng = np.random.default_rng(SEED)
    number = np.cumsum(rng.random(ticks) < 1.0 / HELD)
    values = rng.normal(size=(number[-1] + 1, 2)) * (SPEED, FORCE)
    return values[number, :1], values[number, 1:]


def _identities(
    scheme: Scheme, found: PortRun, v: Array, force: Array, delay: float
) -> dict[str, float]:
    """By how much the power's terms, (20) and (21) differ from what the ports do, relatively.

    Nothing of standard waves, of which the paper says nothing.
    """
    if not isinstance(scheme, ModifiedWaves):
        return {}
    terms = power_terms(
        scheme, v=v, at_leader=found.at_leader, force=force, at_follower=found.at_follower
    )
    power = found.F_m * v - force * found.v_sd
    late = ConstantDelay(delay=delay, dt=DT).ticks
    b, K = scheme.impedance, scheme.gain
    back = _late(force, late)
    desired = _low_pass(_late(v, late) + _late(force, 2 * late) / b, scheme.share) - force / b
    felt = back + K * b * v
    return {
        "power_identity": _relative(terms.total, power),
        "equation_20": _relative(desired, found.v_sd),
        "equation_21": _relative(felt, found.F_m),
    }


def _late(signal: Array, ticks: int) -> Array:
    """A signal (K, 1) some ticks later, zero before."""
    return np.concatenate([np.zeros((ticks, 1)), signal[: len(signal) - ticks]])


def _low_pass(signal: Array, share: float) -> Array:
    """The forward filter of the ports, a signal (K, 1) that is at rest before."""
    out, value = np.empty_like(signal), 0.0
    for k, new in enumerate(signal[:, 0].tolist()):
        value += share * (new - value)
        out[k] = value
    return out


def _relative(found: Array, expected: Array) -> float:
    return float(np.max(np.abs(found - expected)) / np.max(np.abs(expected)))


def draw(data: Data, folder: Path) -> list[Path]:
    """Energy in time, one row for each input."""
    return [save(folder / "channel_energy.png", (12.0, 6.2), lambda f: _draw(f, data))]


def _draw(figure: Figure, data: Data) -> None:
    panels = figure.subplots(len(INPUTS), len(DELAYS), sharex=True, squeeze=False)
    for row, what in enumerate(INPUTS):
        for column, delay in enumerate(DELAYS):
            axes = panels[row, column]
            chosen = [
                one for one in data["rows"] if (one["input"], one["delay_s"]) == (what, delay)
            ]
            for one, color in zip(chosen, CYCLE, strict=False):
                _energy(axes, one, color)
            axes.axhline(0.0, color=GREY, linewidth=0.9)
            axes.set_title(f"{what}, T = {delay:g} s")
            if what == WORST:
                axes.set_yscale("symlog", linthresh=0.1)
                axes.set_ylim(-SHOWN, SHOWN)
                axes.set_xlabel(TIME_LABEL)
        panels[row, 0].set_ylabel("energy taken in [J]")
    handles, labels = panels[0, 0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))


def _energy(axes: Axes, row: Data, color: str) -> None:
    time = STRIDE * DT * (1.0 + np.arange(len(row["energy_j"])))
    axes.plot(time, row["energy_j"], color=color, label=row["scheme"])


CHANNEL = Experiment(
    name="channel",
    title="Energy of the channel in time",
    section="3.3",
    run=run,
    draw=draw,
)
