"""Notes A12: waves carry velocities, so where the follower should be drifts from the leader."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.qin2020.rigs import point_follower, push, resistive
from sinuous.papers.qin2020.runs import BOUNDARY, DELAY
from sinuous.papers.workers import Workers
from sinuous.teleop.bilateral import Bilateral, BilateralState, Signals
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.ledger import Ledger
from sinuous.teleop.operators import Prescribed
from sinuous.teleop.waves import ModifiedWaves
from sinuous.view.curves import LIMIT_DASH
from sinuous.view.style import BLUE, CYCLE, GREY, LIMIT, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

SCHEMES = {"C1": ModifiedWaves.c1(), "C2": ModifiedWaves.c2()}
Z = 1  # the axis that is pushed along
LAG = 0.2  # of the follower [s]

DEPTHS = (0.19, 0.2, 0.22, 0.25, 0.3)  # where the hand is held, beyond the boundary [m]
QUICK_DEPTHS = (0.22,)
REST = 12.0  # until then all has come to rest [s]

PUSH = 0.25  # of the runs below [m]
OUT, HELD, BACK = 2.0, 4.0, 2.0  # times on the way out, there, and on the way back [s]
DURATION, QUICK_DURATION = 30.0, 9.0  # [s]
_out = push([0.0, PUSH], after=0.0, lasting=OUT)
_back = push([0.0, PUSH], after=OUT + HELD, lasting=BACK)
CLAMP = 0.19  # where targets are clamped [m]
LOST = (1.5, 2.0)  # when packets to the follower are lost [s]
Edit = Callable[[BilateralState[Any], float], BilateralState[Any]]
"""What happens to a state before the tick at a time [s]."""

STRIDE = 50  # ticks between the points that are kept


def _nothing(state: BilateralState[Any], time: float) -> BilateralState[Any]:
    return state


def _clamped(state: BilateralState[Any], time: float) -> BilateralState[Any]:
    """No target beyond a limit, as where a workspace ends."""
    inside = np.clip(state.follower.X_sd, -CLAMP, CLAMP)
    return state._replace(follower=state.follower._replace(X_sd=inside))


def _lost(state: BilateralState[Any], time: float) -> BilateralState[Any]:
    """Half a second in which nothing arrives at the follower."""
    return state._replace(to_follower=()) if LOST[0] <= time < LOST[1] else state


CASES: dict[str, tuple[Edit, DriftCorrection | None]] = {
    "as printed": (_nothing, None),
    "clamped": (_clamped, None),
    "clamped, corrected": (_clamped, DriftCorrection()),
    "lost": (_lost, None),
    "lost, corrected": (_lost, DriftCorrection()),
}
"""What happens to the desired point, and how it is brought back."""


def run(workers: Workers, quick: bool) -> Data:
    """The offset at rest against theory, and what makes it permanent."""
    depths = QUICK_DEPTHS if quick else DEPTHS
    items = [(scheme, depth) for scheme in SCHEMES for depth in depths]
    duration = QUICK_DURATION if quick else DURATION
    return {
        "boundary_m": BOUNDARY,
        "delay_s": DELAY,
        "impedance_n_s_m": SCHEMES["C2"].impedance,
        "clamped_at_m": CLAMP,
        "lost_s": LOST,
        "at_rest": workers.map("offset at rest", at_rest, items),
        "runs": workers.map("drift", there_and_back, [(case, duration) for case in CASES]),
    }


def at_rest(item: tuple[str, float]) -> dict[str, Any]:
    """The hand holds still beyond the boundary: X_sd less X against -(2T + 1/lambda) F_s / b."""
    name, depth = item
    scheme = SCHEMES[name]
    hand = Prescribed(push([0.0, depth], after=0.0, lasting=OUT))
    teleop = point_follower(scheme, hand, resistive())
    last = _drive(teleop, REST, _nothing)[-1]
    force = float(last.follower.F_s[Z])
    slow = 2.0 * DELAY + (1.0 / scheme.cutoff if np.isfinite(scheme.cutoff) else 0.0)
    return {
        "scheme": name,
        "held_m": depth,
        "force_n": force,
        "velocity_error_m_s": float(abs(last.follower.V_sd[Z] - last.leader.V[Z])),
        "offset_m": float(last.follower.X_sd[Z] - last.leader.X[Z]),
        "theory_m": -slow * force / scheme.impedance,
    }


def there_and_back(item: tuple[str, float]) -> dict[str, Any]:
    """The hand goes beyond the boundary, stays, and comes back to where it started."""
    case, duration = item
    edit, correction = CASES[case]
    teleop = point_follower(SCHEMES["C2"], Prescribed(_way), resistive(), correction=correction)
    signals = _drive(teleop, duration, edit)
    X = np.array([one.leader.X[Z] for one in signals])
    X_sd = np.array([one.follower.X_sd[Z] for one in signals])
    return {
        "case": case,
        "largest_offset_m": float(np.max(np.abs(X_sd - X))),
        "last_offset_m": float(X_sd[-1] - X[-1]),
        "last_force_n": float(signals[-1].follower.F_s[Z]),
        "least_channel_j": _least_channel(signals, teleop.dt),
        "period_s": STRIDE * teleop.dt,
        "leader_m": X[::STRIDE].round(6).tolist(),
        "offset_m": (X_sd - X)[::STRIDE].round(7).tolist(),
    }


def _way(time: float) -> Array:
    """Where the leader is (2,) [m]: out, there for a while, and back."""
    return _out(time) - _back(time)


def _least_channel(signals: list[Signals], dt: float) -> float:
    """The least that ports, links and the correction have taken in since the start [J]."""
    ledger, least = Ledger(dt), 0.0
    for one in signals:
        least = min(least, ledger.observe(one).channel)
    return least


def _drive(teleop: Bilateral[Any], duration: float, edit: Edit) -> list[Signals]:
    """Signals of every tick with a point that follows with a lag, from the origin."""
    tip, state, signals = np.zeros(3), teleop.init(np.zeros(3)), list[Signals]()
    for k in range(round(duration / teleop.dt)):
        state, now = teleop.step(edit(state, k * teleop.dt), tip)
        tip = tip + teleop.dt / LAG * (now.follower.target_w - tip)
        signals.append(now)
    return signals


def draw(data: Data, folder: Path) -> list[Path]:
    """The offset at rest, and in runs there and back."""
    return [save(folder / "drift.png", (12.0, 4.2), lambda f: _draw(f, data))]


def _draw(figure: Figure, data: Data) -> None:
    rest, back = figure.subplots(1, 2)
    for name, color in zip(SCHEMES, (VERMILION, BLUE), strict=True):
        rows = [row for row in data["at_rest"] if row["scheme"] == name]
        force = np.array([row["force_n"] for row in rows])
        offset = MM_PER_M * np.array([row["offset_m"] for row in rows])
        theory = MM_PER_M * np.array([row["theory_m"] for row in rows])
        rest.plot(force, offset, color=color, marker="o", linestyle="none", label=name)
        label = "theory" if name == "C2" else None
        rest.plot(force, theory, color=LIMIT, linestyle=LIMIT_DASH, linewidth=1.2, label=label)
    rest.set(xlabel="virtual force at rest [N]", ylabel="desired less leader [mm]")
    rest.set_title("At rest in contact")
    rest.legend()
    for row, color in zip(data["runs"], CYCLE, strict=False):
        offset = MM_PER_M * np.array(row["offset_m"])
        style = LIMIT_DASH if "corrected" in row["case"] else "solid"
        time = row["period_s"] * np.arange(len(offset))
        back.plot(time, offset, color=color, linestyle=style, label=row["case"])
    back.axhline(0.0, color=GREY, linewidth=0.9)
    back.set(xlabel=TIME_LABEL, ylabel="desired less leader [mm]")
    back.set_title("To the boundary and back")
    back.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))


DRIFT = Experiment(
    name="drift",
    title="Drift of the desired point",
    section="3.1",
    run=run,
    draw=draw,
)
