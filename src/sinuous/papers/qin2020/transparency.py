"""3.3: what b and K cost, what is felt at rest, and what the operator can tell apart."""

from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.qin2020.rigs import plane, resistive
from sinuous.papers.qin2020.runs import BOUNDARY, DELAY, SCALE
from sinuous.papers.workers import Workers
from sinuous.teleop.analysis.hybrid import (
    ComplexArray,
    hybrid_matrix,
    standard_hybrid_matrix,
)
from sinuous.teleop.analysis.tradeoff import Task
from sinuous.teleop.analysis.transparency import transmitted_impedance, z_width
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import Operator, Prescribed
from sinuous.view.style import BLUE, CYCLE, GREY, PURPLE, VERMILION, save

IMPEDANCES = (2.5, 5.0, 10.0, 20.0, 40.0)  # b [N s/m]
GAINS = (0.5, 0.6, 0.75, 1.0)
QUICK_IMPEDANCES, QUICK_GAINS = (5.0, 20.0), (0.5, 1.0)
STOPS = ((0.1, 0.0), (0.1, 0.12), (0.21, 0.0), (-0.05, -0.1), (0.0, 0.0))
"""Where the hand goes and waits, on the follower's side [m]; one is beyond the boundary."""
MOVING, WAITING = 1.5, 3.0  # times of a move and of a stop in the sweep [s]

LAG = 0.2  # of the follower, that of the printed K_P [s]
DURATION, QUICK_DURATION = 22.5, 6.0  # [s]
PRINTED_B, PRINTED_CUTOFF = 10.0, 20.0
SCHEMES = {"C1": (1.0, np.inf), "C2": (0.5, PRINTED_CUTOFF)}  # K, lambda [rad/s]
OMEGA = np.geomspace(0.05, 60.0, 500)  # [rad/s]
SLOW = 1.0  # where an operator feels a wall [rad/s]

Item = tuple[float, float, float]


def run(workers: Workers, quick: bool) -> Data:
    """The sweep of b and K, and impedances over frequency."""
    impedances, gains = (QUICK_IMPEDANCES, QUICK_GAINS) if quick else (IMPEDANCES, GAINS)
    duration = QUICK_DURATION if quick else DURATION
    items: list[Item] = [(b, K, duration) for b in impedances for K in gains]
    return {
        "boundary_m": BOUNDARY,
        "delay_s": DELAY,
        "lag_s": LAG,
        "rows": workers.map("sweep of b and K", same_motion, items),
        "waiting": workers.map(
            "move and wait", move_and_wait, [(PRINTED_B, K, duration) for K, _ in SCHEMES.values()]
        ),
        "omega_rad_s": OMEGA.tolist(),
        "felt": {name: _felt(name) for name in (*SCHEMES, "standard waves")},
    }


def same_motion(item: Item) -> dict[str, float]:
    """The same motion of the leader for every b and K, with stops."""
    b, K, duration = item
    found = _task(Prescribed(tour), duration).run(b, K)
    return {
        "impedance_n_s_m": b,
        "gain": K,
        "velocity_m_s": found.velocity,
        "force_n": found.force,
    }


def move_and_wait(item: Item) -> dict[str, float]:
    """An operator who goes on when the force has come back: how exactly he feels it at rest."""
    b, K, duration = item
    hand = MoveAndWait(stops=np.array(STOPS) / SCALE)
    found = _task(hand, duration).run(b, K)
    return {"impedance_n_s_m": b, "gain": K, "waiting_n": found.waiting, "force_n": found.force}


def tour(time: float) -> Array:
    """Where the leader is (2,) [m]: from stop to stop, with a rest at each."""
    ends = np.array([(0.0, 0.0), *STOPS]) / SCALE
    number = min(int(time / (MOVING + WAITING)), len(STOPS) - 1)
    share = min((time - number * (MOVING + WAITING)) / MOVING, 1.0)
    way = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    return np.asarray(ends[number] + way * (ends[number + 1] - ends[number]), dtype=np.float64)


def _task(operator: Operator[Any], duration: float) -> Task:
    return Task(
        operator=operator,
        force=resistive(),
        mapping=plane(),
        cutoff=PRINTED_CUTOFF,
        delay=DELAY,
        lag=LAG,
        duration=duration,
    )


def _felt(name: str) -> dict[str, Any]:
    """Impedances that the operator feels (29), by frequency [N s/m]."""
    H = _hybrid(name)
    width = z_width(H)
    wall = transmitted_impedance(H, BoxForce.stiffness / (1j * OMEGA))
    return {
        "free_n_s_m": _size(width.free),
        "clamped_n_s_m": _size(width.clamped),
        "wall_n_s_m": _size(wall),
        "width_when_slow": float(
            np.interp(SLOW, OMEGA, np.abs(width.clamped) / np.abs(width.free))
        ),
    }


def _hybrid(name: str) -> ComplexArray:
    if name not in SCHEMES:
        return standard_hybrid_matrix(OMEGA, impedance=PRINTED_B, delay=DELAY)
    K, cutoff = SCHEMES[name]
    return hybrid_matrix(OMEGA, gain=K, impedance=PRINTED_B, cutoff=cutoff, delay=DELAY)


def _size(Z: ComplexArray) -> list[float]:
    size: Array = np.abs(Z)
    return [float(f"{value:.5g}") for value in size]


def draw(data: Data, folder: Path) -> list[Path]:
    """The trade-off and the impedances."""
    return [
        save(folder / "trade_off.png", (11.0, 4.2), lambda f: _trade_off(f, data)),
        save(folder / "impedances.png", (12.0, 4.2), lambda f: _impedances(f, data)),
    ]


def _trade_off(figure: Figure, data: Data) -> None:
    panels = figure.subplots(1, 2)
    gains = sorted({row["gain"] for row in data["rows"]})
    for axes, key, label, title in (
        (panels[0], "velocity_m_s", "distortion [mm/s]", "Desired velocity, the same for every K"),
        (panels[1], "force_n", "error [N]", "Force felt"),
    ):
        scale = 1e3 if key == "velocity_m_s" else 1.0
        for gain, color in zip(gains, CYCLE, strict=False):
            rows = [row for row in data["rows"] if row["gain"] == gain]
            values = [scale * row[key] for row in rows]
            axes.plot(
                [row["impedance_n_s_m"] for row in rows],
                values,
                color=color,
                marker="o",
                label=f"K = {gain:g}",
            )
        axes.set(xscale="log", xlabel="b [N s/m]", ylabel=label, title=title)
        b = sorted({row["impedance_n_s_m"] for row in data["rows"]})
        axes.set_xticks(b, [f"{value:g}" for value in b])
        axes.minorticks_off()
        axes.set_ylim(bottom=0.0)
    panels[1].legend(loc="upper left")


def _impedances(figure: Figure, data: Data) -> None:
    panels = figure.subplots(1, 3, sharex=True, sharey=True)
    omega = np.array(data["omega_rad_s"])
    true = BoxForce.stiffness / omega
    for axes, (name, felt) in zip(panels, data["felt"].items(), strict=True):
        for key, label, color in (
            ("free_n_s_m", "nothing at the other end", BLUE),
            ("wall_n_s_m", "the boundary's spring", PURPLE),
            ("clamped_n_s_m", "the other end held", VERMILION),
        ):
            axes.plot(omega, felt[key], color=color, label=label)
        axes.plot(omega, true, color=GREY, linestyle=(0, (2, 2)), label="the spring itself")
        axes.set(xscale="log", yscale="log", ylim=(0.3, 2000.0), xlabel="frequency [rad/s]")
        axes.set_title(name)
    panels[0].set_ylabel("impedance felt [N s/m]")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=len(labels))


TRANSPARENCY = Experiment(
    name="transparency",
    title="Transparency: b, K, move and wait, impedances",
    section="3.3",
    run=run,
    draw=draw,
)
