"""2.2.2 and 4: how long the inverse kinematics takes, beside solvers that iterate."""

from time import perf_counter
from typing import Any

import numpy as np

from sinuous.bench.ik_drive import ask, judge
from sinuous.bench.ik_peers.heuristics import HEURISTICS
from sinuous.bench.ik_peers.least_squares import LEAST_SQUARES
from sinuous.bench.ik_peers.ours import OURS
from sinuous.bench.ik_tasks import draw_tasks
from sinuous.control.geometric_ik import CHI
from sinuous.papers.qin2020.kinematics.disc import in_disc
from sinuous.papers.qin2020.runs import inverse

SEED = 8
KEPT = ("median_us", "p99_us", "max_us", "solved", "iterations_median", "iterations_max")


def times(count: int, peers: int) -> dict[str, Any]:
    """Time of a target [s]: many at once, one by one as a loop asks, and of solvers that iterate.

    Arguments:
        count: targets of ours
        peers: targets of the others
    """
    ik, rng = inverse(), np.random.default_rng(SEED)
    targets = ik.on_plane(in_disc(count, ik.radius(CHI), rng), CHI)
    ik.solve(targets[:1])
    began = perf_counter()
    ik.solve(targets)
    at_once = (perf_counter() - began) / count
    one_by_one = np.empty(count)
    for i, target in enumerate(targets):
        began = perf_counter()
        ik.solve_one(target)
        one_by_one[i] = perf_counter() - began
    return {
        "targets": count,
        "at_once_mean_s": at_once,
        "one_by_one_median_s": float(np.median(one_by_one)),
        "one_by_one_p99_s": float(np.percentile(one_by_one, 99)),
        "one_by_one_max_s": float(np.max(one_by_one)),
        "solvers": _solvers(peers),
    }


def _solvers(count: int) -> list[dict[str, Any]]:
    """Processor time by `sinuous bench ik`: targets all over the disc, from the reference pose."""
    ik = inverse()
    tasks = draw_tasks(ik, quick=False)
    rows = list[dict[str, Any]]()
    for solver in (OURS, *LEAST_SQUARES, *HEURISTICS):
        ask(solver, ik, tasks.targets[:1], tasks.start, warm=False)  # code is loaded
        found = judge(ik, ask(solver, ik, tasks.targets[:count], tasks.start, warm=False))
        rows.append({"solver": solver.name, **{key: found[key] for key in KEPT}})
    return rows
