"""`sinuous bench qp`: the controller's solver beside others, on the QPs that it meets."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from time import process_time_ns

import numpy as np

from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.loop import NS_PER_S
from sinuous.bench.machine import machine, require, versions
from sinuous.bench.qp_figure import draw
from sinuous.bench.qp_participant import OURS, Answer, Solver
from sinuous.bench.qp_problems import KeptProblem, collect
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.scene import STEPS, describe, stress_scene
from sinuous.view.units import MS_PER_S

HORIZONS, QUICK_HORIZONS = (2, 5, 10, 20), (2,)
EVERY, QUICK_STEPS, DISKS = 3, 40, 30
REPEATED = 3  # the least of so many counts: what else the machine does is no solver's fault
FEASIBLE = 1e-6  # what the best answer may break hard rows by [largest steps of an actuator]

COLUMNS = (
    Column(key="solver", title="solver"),
    Column(key="horizon", title="N"),
    Column(key="problems", title="QPs"),
    Column(key="median_ms", title="median", form=".3f"),
    Column(key="p99_ms", title="p99", form=".3f"),
    Column(key="max_ms", title="max", form=".3f"),
    Column(key="own_median_ms", title="own median", form=".3f"),
    Column(key="own_p99_ms", title="own p99", form=".3f"),
    Column(key="failures", title="failed"),
    Column(key="cost_gap", title="cost", form=".1e"),
    Column(key="row_error", title="rows", form=".1e"),
)
RATIO_COLUMNS = (
    Column(key="peer", title="peer"),
    Column(key="horizon", title="N"),
    Column(key="median", title="median", form=".2f"),
    Column(key="p99", title="p99", form=".2f"),
    Column(key="own_median", title="own median", form=".2f"),
    Column(key="own_p99", title="own p99", form=".2f"),
)
NOTES = (
    "Processor time in ms of setting up and solving, one thread, the least of three; matrices in "
    "the form each solver likes are made before and not timed.",
    '"own": by the solver\'s own wall clock, without Python; sinuous has none, its one compiled '
    'call counts. "cost": most that the cost exceeds the best of all, by 1 + |best|; "rows": '
    "most that a hard row is broken by, in largest steps of an actuator.",
)


@dataclass(frozen=True, kw_only=True)
class Solved:
    """One answer: its time by our clock and by the solver's own [s], what it costs and breaks."""

    answer: Answer
    time: float
    own: float
    cost: float
    error: float


def run(quick: bool, observe: Observe) -> Result:
    """Solve the same problems with all solvers, taking turns."""
    for module in ("daqp", "piqp"):
        require(module, "qp")
    from sinuous.bench.qp_solvers import SOLVERS  # needs the peers

    steps, horizons = (QUICK_STEPS, QUICK_HORIZONS) if quick else (STEPS, HORIZONS)
    rows = list[Row]()
    for number, horizon in enumerate(horizons):
        observe(f"N = {horizon}", number, len(horizons))
        problems = list(collect(stress_scene(DISKS, steps), horizon, EVERY))
        _solve(problems[0], SOLVERS)  # code is loaded
        answers = [_solve(problem, SOLVERS) for problem in problems]
        rows += _rows(answers, horizon, problems)
    observe("done", len(horizons), len(horizons))
    return Result(
        what="qp",
        tables=(
            Table(name="rows", title="first QPs of steps", columns=COLUMNS, rows=rows),
            Table(
                name="ratios",
                title="time of a peer by that of sinuous",
                columns=RATIO_COLUMNS,
                rows=ratios(rows),
            ),
        ),
        about={
            "solvers": {solver.name: solver.settings for solver in SOLVERS},
            "scene": describe(steps),
            "settings": {"every_so_many_steps": EVERY, "disks": DISKS, "least_of": REPEATED},
            "versions": versions(),
            "machine": machine(),
        },
        notes=NOTES,
    )


def _solve(problem: KeptProblem, solvers: Sequence[Solver]) -> dict[str, Solved]:
    tasks = {solver.name: solver.prepare(problem) for solver in solvers}
    times, own = dict.fromkeys(tasks, np.inf), dict.fromkeys(tasks, np.inf)
    answers = dict[str, Answer]()
    for _ in range(REPEATED):
        for name, task in tasks.items():
            began = process_time_ns()
            answers[name] = task()
            times[name] = min(times[name], (process_time_ns() - began) / NS_PER_S)
            own[name] = min(own[name], answers[name].own)
    return {
        name: Solved(
            answer=answer,
            time=times[name],
            own=own[name] if np.isfinite(own[name]) else times[name],
            cost=problem.cost(answer.y),
            error=problem.error(answer.y),
        )
        for name, answer in answers.items()
    }


def _rows(
    answers: Sequence[Mapping[str, Solved]], horizon: int, problems: Sequence[KeptProblem]
) -> list[Row]:
    """One row per solver."""
    best = np.array([_best(each) for each in answers])
    sizes = np.array([len(problem.stage) for problem in problems])
    rows = list[Row]()
    for name in answers[0]:
        own = [each[name] for each in answers]
        time, inside = np.array([[s.time, s.own] for s in own]).T * MS_PER_S
        gap = (np.array([s.cost for s in own]) - best) / (1.0 + np.abs(best))
        rows.append(
            {
                "solver": name,
                "horizon": horizon,
                "problems": len(own),
                "variables": len(problems[0].dense.f),
                "rows_median": float(np.median(sizes)),
                "rows_max": int(sizes.max()),
                "median_ms": float(np.median(time)),
                "p99_ms": float(np.percentile(time, 99)),
                "max_ms": float(time.max()),
                "own_median_ms": float(np.median(inside)),
                "own_p99_ms": float(np.percentile(inside, 99)),
                "failures": sum(not s.answer.solved for s in own),
                "cost_gap": float(gap.max()),
                "row_error": max(s.error for s in own),
            }
        )
    return rows


def _best(answers: Mapping[str, Solved]) -> float:
    """Least cost of those that keep the hard rows."""
    return min(s.cost for s in answers.values() if s.answer.solved and s.error < FEASIBLE)


def ratios(rows: Sequence[Row]) -> list[Row]:
    """Times of each peer by ours at the same horizon."""
    keys = ("median", "p99", "own_median", "own_p99")
    ours = {row["horizon"]: row for row in rows if row["solver"] == OURS}
    found = list[Row]()
    for row in rows:
        if row["solver"] != OURS:
            base = ours[row["horizon"]]
            found.append(
                {
                    "peer": row["solver"],
                    "horizon": row["horizon"],
                    **{key: _by(row, base, f"{key}_ms") for key in keys},
                }
            )
    return found


def _by(row: Row, base: Row, key: str) -> float:
    above, below = row[key], base[key]
    assert isinstance(above, float)
    assert isinstance(below, float)
    return above / below


QP = Benchmark(run=run, draw=draw)
