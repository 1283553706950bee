"""III-D, last paragraph: a search for targets at which a controller does not come to rest.

Undisturbed, an exact robot, one target at a time. In free space there are a thousand targets from
all over the workspace, at its edge and beyond it; in the winding tube a hundred from all of its
length ahead of the robot, whether it gets there or not. A tip oscillates if it covers more than
0.5 mm in the last two seconds. That counts a slow approach too, so it is also counted how many go
to and fro.
"""

from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.settling import OSCILLATING, TURNS_BACK, End, end_of
from sinuous.papers.hachen2025.stability.figures import draw
from sinuous.papers.hachen2025.stability.search import TUBE, search
from sinuous.papers.hachen2025.targets import along, anywhere, at_the_edge, beyond
from sinuous.papers.hachen2025.undisturbed import (
    BEST,
    DLS,
    DT,
    FREE,
    MPC,
    drive,
    held,
    place,
    tips,
)
from sinuous.papers.workers import Workers

SEED = 2025
TARGETS = {"anywhere": 500, "at the edge": 250, "beyond the edge": 250, "in the tube": 100}
QUICK_TARGETS = dict.fromkeys(TARGETS, 3)
DURATION, QUICK_DURATION = 8.0, 4.0  # of a run [s]
CHUNK = 20  # targets that a process does at once

IN_FREE_SPACE = ("DLS, printed gains", "DLS, best gains", MPC)
"""Stiffness of the penalty does not matter there."""
IN_THE_TUBE = (*DLS, MPC)

DIGITS = 6  # of the example's metres

Item = tuple[str, str, list[tuple[str, list[float]]], float]


def run(workers: Workers, quick: bool) -> Data:
    """The best gains, then every controller at every target, then the worst case again."""
    count = QUICK_TARGETS if quick else TARGETS
    duration = QUICK_DURATION if quick else DURATION
    found = search(workers, quick)
    items = _items(FREE, IN_FREE_SPACE, _free_targets(count), duration)
    items += _items(TUBE, IN_THE_TUBE, _tube_targets(count), duration)
    rows = [row for rows in workers.map("search for oscillation", ends, items) for row in rows]
    return {
        "duration_s": duration,
        "targets": dict(count),
        "oscillating_above_m": OSCILLATING,
        "turns_back": TURNS_BACK,
        "search": found,
        "best_gains": BEST.plain(),
        "gains": {name: gains.plain() for name, gains in DLS.items()},
        "rows": rows,
        "example": _example(rows, duration),
    }


def ends(item: Item) -> list[dict[str, Any]]:
    """How one controller ends at some targets in one place."""
    name, law, targets, duration = item
    here = place(name)
    controller, rows = here.controller(law), list[dict[str, Any]]()
    for kind, target in targets:
        path = tips(here.robot, drive(controller, here.start, held(np.array(target), duration)))
        end = end_of(path)
        rows.append(
            {
                "place": name,
                "controller": law,
                "kind": kind,
                "target_m": target,
                "extent_m": end.extent,
                "path_m": end.path,
                "tip_error_m": float(np.linalg.norm(path[-1] - target)),
            }
        )
    return rows


def worst(rows: list[dict[str, Any]]) -> dict[str, Any]:
    """The row of the reference controller that turns back most, or else has the longest way."""
    dls = [row for row in rows if row["controller"] != MPC]
    back = [row for row in dls if End(extent=row["extent_m"], path=row["path_m"]).to_and_fro]
    if not back:
        return max(dls, key=lambda row: float(row["path_m"]))
    return max(back, key=lambda row: float(row["path_m"] / row["extent_m"]))


def _example(rows: list[dict[str, Any]], duration: float) -> dict[str, Any]:
    """The worst case with its whole way, beside that of the MPC."""
    row = worst(rows)
    here, ways = place(row["place"]), dict[str, dict[str, Any]]()
    for law in (row["controller"], MPC):
        targets = held(np.array(row["target_m"]), duration)
        way = drive(here.controller(law), here.start, targets)
        last = here.robot.points(way[-round(1.0 / DT) :: 3])
        ways[law] = {
            "tip_m": tips(here.robot, way).round(DIGITS).tolist(),
            "shapes_m": last.round(DIGITS).tolist(),
        }
    return {"place": row["place"], "target_m": row["target_m"], "dt_s": DT, "ways": ways}


def _items(
    name: str, laws: tuple[str, ...], targets: list[tuple[str, list[float]]], duration: float
) -> list[Item]:
    parts = [targets[k : k + CHUNK] for k in range(0, len(targets), CHUNK)]
    return [(name, law, part, duration) for law in laws for part in parts]


def _free_targets(count: dict[str, int]) -> list[tuple[str, list[float]]]:
    robot, rng = place(FREE).robot, np.random.default_rng(SEED)
    kinds = {"anywhere": anywhere, "at the edge": at_the_edge, "beyond the edge": beyond}
    return [
        one for kind, make in kinds.items() for one in _named(kind, make(robot, count[kind], rng))
    ]


def _tube_targets(count: dict[str, int]) -> list[tuple[str, list[float]]]:
    targets = along(place(TUBE), count["in the tube"], np.random.default_rng(SEED))
    return _named("in the tube", targets)


def _named(kind: str, targets: Array) -> list[tuple[str, list[float]]]:
    return [(kind, target.tolist()) for target in targets]


STABILITY = Experiment(
    name="stability",
    title="Does it come to rest, up to the edge of the workspace?",
    section="III-D, Fig. 9",
    run=run,
    draw=draw,
)
