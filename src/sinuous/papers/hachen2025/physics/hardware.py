"""IV again, on physics: the tests of `hardware` with a robot that the engine moves."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np

from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.hardware.experiment import (
    CONTROLLERS,
    GOAL_TIMES,
    PAIR,
    QUICK_TIMES,
    Item,
    driven,
    judged,
)
from sinuous.papers.hachen2025.hardware.figures import draw_all, draw_goals, draw_held
from sinuous.papers.hachen2025.physics.loop import touched
from sinuous.papers.hachen2025.runs import scenario
from sinuous.papers.physics import is_missing, nothing, why_not
from sinuous.papers.workers import Workers
from sinuous.view.style import save
from sinuous.view.units import MM_PER_M

SCENARIO = "hardware_physics"


def run(workers: Workers, quick: bool) -> Data:
    """Four goals (Fig. 12), and holding at a boundary (Fig. 13)."""
    if reason := why_not():
        return nothing(reason)
    items: list[Item] = [
        (test, name, 0, quick)
        for test in ("goals", "boundary")
        for name in (PAIR if quick else tuple(CONTROLLERS))
    ]
    return {
        "missing": "",
        "scenario": SCENARIO,
        "goal_times_s": list(QUICK_TIMES if quick else GOAL_TIMES),
        "rows": workers.map("like the hardware, on physics", drive, items),
    }


def drive(item: Item) -> dict[str, Any]:
    """One controller and test."""
    _, name, seed, _ = item
    base = replace(scenario(SCENARIO, *CONTROLLERS[name]), seed=seed)
    recording = driven(base, item)
    return {**judged(item, recording, base), **touched(recording)}


def draw(data: Data, folder: Path) -> list[Path]:
    """Figs. 12 and 13, and all runs."""
    if is_missing(data):
        return []
    rows = data["rows"]
    shown = {(r["test"], r["controller"]): r["curves"] for r in rows if r["curves"] is not None}
    goals, boundary = ({c: shown[test, c] for c in PAIR} for test in ("goals", "boundary"))
    switches = np.cumsum(data["goal_times_s"])[:-1]
    margin = rows[0]["margin_m"] * MM_PER_M
    return [
        save(
            folder / "fig12_goals.png",
            (10.0, 8.0),
            lambda f: draw_goals(f, "Four goals, on physics", goals, switches),
        ),
        save(folder / "fig13_boundary.png", (10.0, 4.6), lambda f: draw_held(f, boundary, margin)),
        save(folder / "all_runs.png", (10.0, 4.6), lambda f: draw_all(f, rows)),
    ]


HARDWARE_PHYSICS = Experiment(
    name="hardware_physics",
    title="Like the hardware, on physics (Figs. 12, 13)",
    section="IV",
    run=run,
    draw=draw,
)
