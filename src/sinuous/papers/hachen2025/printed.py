"""II: formulas as printed beside our reading of them, and what a longer horizon smooths."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
from matplotlib.figure import Figure

from sinuous.arrays import Array
from sinuous.control.dls import DampedLeastSquares, PenaltySign
from sinuous.control.mpc import Costs, ShapeConstrainedMPC
from sinuous.control.terms import PrintedLengths, TipError
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.runs import sampled_targets
from sinuous.papers.hachen2025.undisturbed import DT, FREE, drive, held, place, tips
from sinuous.papers.workers import Workers
from sinuous.view.curves import write_plainly
from sinuous.view.style import BLACK, BLUE, GREEN, TIME_LABEL, VERMILION, save
from sinuous.view.units import MM_PER_M

TARGET = (0.05, 0.0, 0.16)  # [m]
DURATION = 10.0  # of the runs for (10) and (17) [s]
WEIGHTS = (10.0, 1.0, 0.0)  # S of (10), the first as printed
HORIZONS = (2, 5, 10)
TARGETS, QUICK_TARGETS, SEED = 10, 2, 5
PUSHED, STEPS = 0.25, 25  # bend of a segment into the wall [rad], steps of (30)


def run(workers: Workers, quick: bool) -> Data:
    """All of it; it takes seconds."""
    count = QUICK_TARGETS if quick else TARGETS
    items = [(horizon, k) for horizon in HORIZONS for k in range(count)]
    return {
        "dt_s": DT,
        "restart": _restart(),
        "cost": _cost(),
        "penalty": _penalty(),
        "smoothness": workers.map("oscillation by horizon", roughness, items),
    }


def _restart() -> dict[str, Any]:
    """(17) as printed starts from x*[0|k-1], ours from x*[1|k-1]: tip errors [m]."""
    here = place(FREE)
    mpc = ShapeConstrainedMPC(here.robot, here.zone, dt=DT, horizon=2)
    target, steps = np.array(TARGET), round(DURATION / DT)
    state, printed = mpc.init(here.start), list[float]()
    for _ in range(steps):
        after, _ = mpc.step(state, target)
        state = replace(after, c=state.c)
        printed.append(float(np.linalg.norm(here.robot.tip(state.c) - target)))
    ours = drive(mpc, here.start, held(target, DURATION))[1:]
    return {
        "printed_tip_error_m": printed,
        "ours_tip_error_m": np.linalg.norm(tips(here.robot, ours) - target, axis=1).tolist(),
    }


def _cost() -> dict[str, Any]:
    """(10) with x'Sx rests beside the target: tip errors [m]."""
    here, target = place(FREE), np.array(TARGET)
    printed = Costs.printed()
    choices = {
        f"printed, S = {S:g}": replace(
            printed, state=(TipError(weight=1000.0), PrintedLengths(weight=S))
        )
        for S in WEIGHTS
    } | {"ours": Costs()}
    found = dict[str, Any]()
    for name, costs in choices.items():
        mpc = ShapeConstrainedMPC(here.robot, here.zone, dt=DT, horizon=2, costs=costs)
        way = drive(mpc, here.start, held(target, DURATION))[1:]
        found[name] = np.linalg.norm(tips(here.robot, way) - target, axis=1).tolist()
    return found


def _penalty() -> dict[str, Any]:
    """h (31) [m^2] step by step, with the sign of (30) as printed and with the other one."""
    here = place("winding_tube")
    c = here.start.copy()
    c[3] += PUSHED
    found = dict[str, Any]()
    for name, sign in (("printed", PenaltySign.PRINTED), ("ours", PenaltySign.DESCENT)):
        dls = DampedLeastSquares(here.robot, here.zone, margin=here.margin, dt=DT, sign=sign)
        way = drive(dls, c, held(here.robot.tip(c), STEPS * DT))
        found[name] = [dls.collision_cost(here.robot.points(one))[0] for one in way]
    return found


def roughness(item: tuple[int, int]) -> dict[str, Any]:
    """How much the input of a plan with the printed cost goes to and fro on the way to a target.

    The sum of its second differences by the sum of its norms: zero for a constant input, four for
    one that changes its sign in every step.
    """
    horizon, number = item
    here = place(FREE)
    target = sampled_targets(here.robot, number + 1, SEED)[-1]
    mpc = ShapeConstrainedMPC(here.robot, here.zone, dt=DT, horizon=horizon, costs=Costs.printed())
    u = np.diff(here.robot.lengths(drive(mpc, here.start, held(target, DURATION))), axis=0)
    return {"horizon": horizon, "target": number, "roughness": _second_differences(u)}


def _second_differences(u: Array) -> float:
    """Of rows (K, P), by the sum of their norms."""
    size = float(np.sum(np.linalg.norm(u, axis=1)))
    return float(np.sum(np.linalg.norm(np.diff(u, n=2, axis=0), axis=1))) / size


def draw(data: Data, folder: Path) -> list[Path]:
    """The three formulas side by side."""
    return [save(folder / "misprints.png", (12.0, 4.4), lambda f: _draw(f, data))]


def _draw(figure: Figure, data: Data) -> None:
    restart, cost, penalty = figure.subplots(1, 3)
    dt = data["dt_s"]
    for axes, curves in (
        (restart, {name: data["restart"][f"{name}_tip_error_m"] for name in ("printed", "ours")}),
        (cost, data["cost"]),
    ):
        for (name, values), color in zip(
            curves.items(), (VERMILION, BLUE, GREEN, BLACK), strict=False
        ):
            time = dt * np.arange(1, len(values) + 1)
            axes.plot(time, np.maximum(np.array(values) * MM_PER_M, 1e-5), color=color, label=name)
        axes.set_yscale("log")
        write_plainly(axes.yaxis)
        axes.set_ylabel("tip error [mm]")
    for (name, values), color in zip(data["penalty"].items(), (VERMILION, BLUE), strict=True):
        time = dt * np.arange(len(values))
        penalty.plot(time, np.array(values) * MM_PER_M**2, color=color, label=name)
    penalty.set_ylabel("penalty (31) [mm²]")
    penalty.set_ylim(bottom=0.0)
    for axes, title in (
        (restart, "(17): the state to start from"),
        (cost, "(10): x'Sx pulls the tip off"),
        (penalty, "(30): the penalty's sign"),
    ):
        axes.set_title(title)
        axes.set_xlabel(TIME_LABEL)
        axes.margins(x=0.01)
        axes.legend()


PRINTED_READINGS = Experiment(
    name="printed",
    title="Formulas as printed and as we read them",
    section="II",
    run=run,
    draw=draw,
)
