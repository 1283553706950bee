"""Dead ends: which targets a controller reaches by the steps it looks ahead, and what they cost.

The plan is local and the robot a rate-limited integrator. Where no small motion brings the tip
closer, staying is a stationary plan of every horizon: each of its stages is at a local minimum
of the same tip error. A longer horizon can only change on which side of an edge the robot
arrives, not free it; the experiment measures both.
"""

from typing import Any

import numpy as np

from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.horizons.figures import draw
from sinuous.papers.hachen2025.horizons.runs import (
    PASSAGES,
    Course,
    cost,
    drive,
    guided,
    settle,
)
from sinuous.papers.hachen2025.horizons.scenes import (
    MAP_HORIZONS,
    map_scene,
    passages,
    plates,
    posts,
    shown_scenario,
)
from sinuous.papers.hachen2025.horizons.verdicts import REACHED
from sinuous.papers.sketch import sketch
from sinuous.papers.workers import Workers
from sinuous.session import run as run_session

SEED = 7
PRINTED_RATE, FAST_RATE, COARSE_RATE = 30.0, 100.0, 10.0  # [Hz]
HORIZONS = (1, 2, 3, 5, 10, 20, 30)
BY_RATE: dict[float, tuple[int, ...]] = {
    PRINTED_RATE: HORIZONS,
    FAST_RATE: (2, 5, 10, 20),
    COARSE_RATE: (2, 3, 5, 10),
}
SHORT, LONG = 2, (10, 20)  # who gets stuck, and who then tries to get out from there


PLATES, QUICK_PLATES = (16, 3), (2, 1)  # scenes, and targets in each
OPEN = {"three posts": posts, "rough passage": passages}  # where every target can be reached
OPEN_COUNTS, QUICK_OPEN_COUNTS = (6, 2), (1, 1)
SETTLING, QUICK_SETTLING = 6.0, 2.0  # how long those are driven [s]

MAP_ROWS, QUICK_MAP_ROWS = 9, 2
SHOWN = (2, 20)
HELD, QUICK_HELD = 1.0, 0.1  # how long each target is held where time is measured [s]

Item = tuple[int, int, float]
OpenItem = tuple[str, int, int, float]


def run(workers: Workers, quick: bool) -> Data:
    """All scenes with all horizons, one scene in detail, and the time of a step."""
    scenes, targets = QUICK_PLATES if quick else PLATES
    items: list[Item] = [
        (number, targets, rate)
        for rate in ((PRINTED_RATE,) if quick else BY_RATE)
        for number in range(scenes)
    ]
    attempted = workers.map("targets behind a plate with a hole", attempts, items)
    scenes, targets = QUICK_OPEN_COUNTS if quick else OPEN_COUNTS
    duration = QUICK_SETTLING if quick else SETTLING
    others: list[OpenItem] = [
        (family, number, targets, duration) for family in OPEN for number in range(scenes)
    ]
    settled = workers.map("posts and passages", settling, others)
    count = QUICK_MAP_ROWS if quick else MAP_ROWS
    mapped = workers.map("one plate", map_row, [(row, count) for row in range(count)])
    return {
        "horizons": list(HORIZONS),
        "attempts": [row for rows in attempted for row in rows],
        "settling": [row for rows in settled for row in rows],
        "map_horizons": list(MAP_HORIZONS),
        "map": [row for rows in mapped for row in rows],
        "shown": workers.map("a dead end", show, SHOWN),
        "cost": costs(workers, quick),
    }


def attempts(item: Item) -> list[dict[str, Any]]:
    """Every horizon of a rate towards every target behind one plate."""
    number, count, rate = item
    scene, dt = plates(SEED, number, count), 1.0 / rate
    rows = list[dict[str, Any]]()
    for target in scene.targets:
        ends = {N: drive(scene.controller(N, dt), scene.start, target) for N in BY_RATE[rate]}
        row = {
            "scene": number,
            "rate_hz": rate,
            "target_m": target.tolist(),
            "horizons": list(ends),
            "error_m": [end.error for end in ends.values()],
            "time_s": [end.time for end in ends.values()],
        }
        if rate == PRINTED_RATE:
            row["guided_error_m"] = guided(scene, target)
            if ends[SHORT].error > REACHED:
                again = [drive(scene.controller(N, dt), ends[SHORT].c, target) for N in LONG]
                row["from_dead_end_horizons"] = list(LONG)
                row["from_dead_end_error_m"] = [end.error for end in again]
        rows.append(row)
    return rows


def settling(item: OpenItem) -> list[dict[str, Any]]:
    """How every horizon comes to rest where all targets can be reached."""
    family, number, count, duration = item
    scene, dt = OPEN[family](SEED, number, count), 1.0 / PRINTED_RATE
    return [
        {
            "family": family,
            "scene": number,
            "target_m": target.tolist(),
            "horizon": N,
            **settle(scene.controller(N, dt), scene.start, target, duration),
        }
        for target in scene.targets
        for N in HORIZONS
    ]


def map_row(item: tuple[int, int]) -> list[dict[str, Any]]:
    """Which horizons reach the targets of one row (of so many) behind one plate."""
    row, count = item
    scene, dt = map_scene(row, count), 1.0 / PRINTED_RATE
    return [
        {
            "target_m": target.tolist(),
            "error_m": [
                drive(scene.controller(N, dt), scene.start, target).error for N in MAP_HORIZONS
            ],
        }
        for target in scene.targets
    ]


def show(horizon: int) -> dict[str, Any]:
    """The shapes of a run to a target that only long horizons reach."""
    recording = run_session(shown_scenario(horizon)).recording
    error = np.linalg.norm(recording.nominal_tip - recording.target, axis=1)
    return {"horizon": horizon, "error_m": float(error[-1]), "sketch": sketch(recording)}


def costs(workers: Workers, quick: bool) -> list[dict[str, Any]]:
    """The time of a step by horizon at 100 Hz, in this process while the others rest."""
    courses = [Course.through(name) for name in (PASSAGES[:1] if quick else PASSAGES)]
    if not quick:
        courses += [Course.of(make(SEED, 0, 2)) for make in (plates, *OPEN.values())]
    held = QUICK_HELD if quick else HELD
    rows = list[dict[str, Any]]()
    for done, horizon in enumerate(HORIZONS):
        workers.observe("time of a step", done, len(HORIZONS))
        rows.append(cost(courses, horizon, 1.0 / FAST_RATE, held))
    workers.observe("time of a step", len(HORIZONS), len(HORIZONS))
    return rows


HORIZONS_EXPERIMENT = Experiment(
    name="horizons",
    title="Longer horizons and dead ends",
    section="III-F",
    run=run,
    draw=draw,
)
