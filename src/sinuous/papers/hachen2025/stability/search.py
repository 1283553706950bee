"""The best gains of the reference controller, by a search over a grid.

A candidate drives to training targets in free space and in the winding tube. Best is who fails at
the fewest of them; who ends farther than `NEAR` from the target fails, and who goes to and fro.
Among equals the mean cost of a run decides: the time until the tip stays within `NEAR` of its
target, the whole run if it fails, and a second for every millimetre by which the body came closer
to a wall than the margin on its way.
"""

from itertools import product
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.hachen2025.settling import end_of
from sinuous.papers.hachen2025.targets import along, anywhere
from sinuous.papers.hachen2025.undisturbed import (
    BEST,
    DT,
    FREE,
    PRINTED,
    STIFF,
    Gains,
    drive,
    held,
    place,
    tips,
)
from sinuous.papers.workers import Workers

TUBE = "winding_tube"
SEED = 7
COUNT, DURATION = 8, 8.0  # targets in each place, time of a run [s]
QUICK_COUNT, QUICK_DURATION = 1, 4.0
SPREAD = 8  # so many targets are drawn for one that is taken
NEAR = 1e-3  # [m]
SECONDS_PER_METRE = 1e3

GAINS = (0.05, 0.2, 0.5, 1.0)
DAMPINGS = (0.01, 0.1, 1.0)
PENALTIES = (DT, 10.0 * DT, 1.0, 10.0)

Item = tuple[str, Gains, int, float]


def search(workers: Workers, quick: bool) -> list[dict[str, Any]]:
    """Every candidate with what its runs cost [s], the best first."""
    some = (PRINTED, STIFF, BEST)
    every = [Gains(gain=k, damping=c, penalty=h) for k, c, h in product(GAINS, DAMPINGS, PENALTIES)]
    candidates = list(some) if quick else every
    count, duration = (QUICK_COUNT, QUICK_DURATION) if quick else (COUNT, DURATION)
    # The penalty does not matter where there is no wall.
    free = list(dict.fromkeys((one.gain, one.damping) for one in candidates))
    items: list[Item] = [
        (FREE, Gains(gain=k, damping=c, penalty=0.0), count, duration) for k, c in free
    ]
    items += [(TUBE, one, count, duration) for one in candidates]
    results = workers.map("search for the best gains of DLS", judged, items)
    in_free = dict(zip(free, results, strict=False))
    rows = list[dict[str, Any]]()
    for one, tube in zip(candidates, results[len(free) :], strict=True):
        both = (in_free[one.gain, one.damping], tube)
        rows.append(
            {
                **one.plain(),
                "runs": 2 * count,
                "failed": sum(failed for failed, _ in both),
                "cost_s": 0.5 * sum(cost for _, cost in both),
            }
        )
    return sorted(rows, key=lambda row: (row["failed"], row["cost_s"]))


def judged(item: Item) -> tuple[int, float]:
    """How many of one candidate's runs in one place fail, and their mean cost [s]."""
    name, gains, count, duration = item
    here = place(name)
    controller, failed, costs = here.controller(gains), 0, list[float]()
    for target in training(name, count):
        way = drive(controller, here.start, held(target, duration))
        time = settling_time(tips(here.robot, way), target)
        failed += time is None
        missing = max(here.margin - least_clearance(name, way), 0.0)
        costs.append((duration if time is None else time) + SECONDS_PER_METRE * missing)
    return failed, float(np.mean(costs))


def training(name: str, count: int) -> Array:
    """Targets (count, 3) [m]; in a passage they are spread over all of its length."""
    here, rng = place(name), np.random.default_rng(SEED)
    if name == FREE:
        return anywhere(here.robot, count, rng)
    many = along(here, SPREAD * count, rng)
    away = np.linalg.norm(many - here.robot.T_w_b[:3, 3], axis=1)
    return many[np.argsort(away)[SPREAD // 2 :: SPREAD]]


def least_clearance(name: str, way: Array) -> float:
    """Least clearance [m] of the body at guarded points, infinite without walls."""
    here = place(name)
    points = here.robot.points(way)[:, here.robot.movable]
    return float(np.min(here.zone.clearance(points) - here.robot.radii[here.robot.movable]))


def settling_time(path: Array, target: Array) -> float | None:
    """Time [s] until the tip stays at the target; None if it does not, or goes to and fro."""
    away = np.linalg.norm(path - target, axis=1) > NEAR
    if away[-1] or end_of(path).to_and_fro:
        return None
    return DT * (int(np.flatnonzero(away)[-1]) + 1) if np.any(away) else 0.0
