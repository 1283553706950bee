"""`sinuous bench tails`: very many steps in random passages, and why the slowest were slow."""

import heapq
from dataclasses import dataclass, field
from time import perf_counter_ns, process_time_ns

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.benchmark import Benchmark, Observe
from sinuous.bench.loop import NS_PER_S, no_garbage_collection
from sinuous.bench.machine import machine, versions
from sinuous.bench.random_scenes import random_scenes
from sinuous.bench.result import Column, Result, Row, Table
from sinuous.bench.scene import Scene
from sinuous.bench.swift import SwiftJudge
from sinuous.bench.tails_figure import draw
from sinuous.control.mpc import MPCState, ShapeConstrainedMPC
from sinuous.control.report import Status
from sinuous.control.step import plan
from sinuous.control.step.step import decide
from sinuous.control.terms import total_quadratics
from sinuous.view.units import MM_PER_M, MS_PER_S

SCENES, STEPS, SEED = 100, 1000, 1
QUICK_SCENES, QUICK_STEPS = 2, 40
WORST, REPLAYS = 20, 50
BUDGET = 0.3e-3  # [s]
LATE = 0.5e-3  # no step with that budget should take longer [s]
SETTINGS = ((2, None), (2, BUDGET), (5, None))
AGAIN = 15  # repetitions of a step that took too long in spite of its budget
NOISE = 20_000  # repetitions of one and the same step
ROUNDING = 1e-12  # a margin broken by less is rounding [m]


@dataclass(frozen=True, kw_only=True, order=True)
class Slow:
    """One of the slowest steps, with all that it takes to repeat it; ordered by time."""

    cpu: float  # [s]
    scene: int
    step: int
    mpc: ShapeConstrainedMPC = field(compare=False)
    state: MPCState = field(compare=False)
    target: Array = field(compare=False)


@dataclass(kw_only=True)
class Tally:
    """What is kept of very many steps."""

    cpu: list[float] = field(default_factory=list[float])
    error: list[float] = field(default_factory=list[float])
    room: float = np.inf
    violations: int = 0
    failures: int = 0
    out_of_time: int = 0
    shortened: int = 0
    late: int = 0
    late_again: int = 0
    slowest: list[Slow] = field(default_factory=list[Slow])


def run(quick: bool, observe: Observe) -> Result:
    """Drive through all passages with every setting."""
    scenes, steps = (QUICK_SCENES, QUICK_STEPS) if quick else (SCENES, STEPS)
    rows, worst, times = list[Row](), list[Row](), dict[str, object]()
    for number, (horizon, budget) in enumerate(SETTINGS):
        tally = Tally()
        for index, scene in enumerate(random_scenes(SEED, scenes, steps)):
            done = number * scenes + index
            observe(f"N = {horizon}, budget {_ms(budget)}", done, scenes * len(SETTINGS))
            _drive(scene, index, horizon, budget, tally)
        rows.append(_row(horizon, budget, tally))
        times[f"N = {horizon}, budget {_ms(budget)}"] = _quantiles(np.array(tally.cpu))
        if budget is None:
            slowest = sorted(tally.slowest, reverse=True)
            worst += [_explain(horizon, slow) for slow in slowest]
    observe("clock", scenes * len(SETTINGS), scenes * len(SETTINGS))
    return Result(
        what="tails",
        tables=(
            Table(name="rows", title="all steps", columns=COLUMNS, rows=rows),
            Table(
                name="worst",
                title=f"the slowest {WORST} steps without a budget, and where their time goes",
                columns=WORST_COLUMNS,
                rows=worst,
            ),
        ),
        about={
            "quantiles": times,
            "clock_noise": _noise(200 if quick else NOISE),
            "scenes": scenes,
            "steps_each": steps,
            "seed": SEED,
            "versions": versions(),
            "machine": machine(),
        },
        notes=NOTES,
    )


def _ms(budget: float | None) -> str:
    return "none" if budget is None else f"{budget * MS_PER_S:g} ms"


def _drive(scene: Scene, index: int, horizon: int, budget: float | None, tally: Tally) -> None:
    """All steps of one passage; the first few warm up and do not count."""
    mpc = ShapeConstrainedMPC(
        scene.robot, scene.zone, margin=scene.margin, dt=scene.dt, horizon=horizon, budget=budget
    )
    judge, state = SwiftJudge(scene=scene), mpc.init(scene.start)
    for target in scene.targets[:3]:
        mpc.step(state, target)
    with no_garbage_collection():
        for step, target in enumerate(scene.targets):
            before, began = state, process_time_ns()
            state, command = mpc.step(state, target)
            cpu = (process_time_ns() - began) / NS_PER_S
            report = command.report
            tally.cpu.append(cpu)
            tally.error.append(float(np.linalg.norm(report.points[-1] - target)))
            room = judge.room(before.c, state.c)
            tally.room = min(tally.room, room)
            tally.violations += room < -ROUNDING
            tally.failures += report.status is Status.HOLDING
            tally.out_of_time += not report.workload.in_time
            tally.shortened += report.step_fraction < 1.0
            if cpu > LATE:
                tally.late += 1
                if budget is not None:
                    tally.late_again += _again(mpc, before, target) > LATE
            slow = Slow(cpu=cpu, scene=index, step=step, mpc=mpc, state=before, target=target)
            if len(tally.slowest) < WORST:
                heapq.heappush(tally.slowest, slow)
            elif slow > tally.slowest[0]:
                heapq.heapreplace(tally.slowest, slow)


def _again(mpc: ShapeConstrainedMPC, state: MPCState, target: Array) -> float:
    """Median time of the same step, repeated [s]: without what the machine did beside it."""
    times = np.empty(AGAIN)
    for k in range(AGAIN):
        began = process_time_ns()
        mpc.step(state, target)
        times[k] = (process_time_ns() - began) / NS_PER_S
    return float(np.median(times))


def _row(horizon: int, budget: float | None, tally: Tally) -> Row:
    cpu, error = np.array(tally.cpu), np.array(tally.error) * MM_PER_M
    return {
        "horizon": horizon,
        "budget_ms": None if budget is None else budget * MS_PER_S,
        "steps": len(cpu),
        **{f"{name}_ms": value for name, value in _quantiles(cpu).items()},
        "over_0.5_ms": tally.late,
        "over_0.5_ms_again": None if budget is None else tally.late_again,
        "violations": tally.violations,
        "failures": tally.failures,
        "out_of_time": tally.out_of_time,
        "shortened": tally.shortened,
        "room_mm": tally.room * MM_PER_M,
        "tip_error_median_mm": float(np.median(error)),
        "tip_error_mean_mm": float(np.mean(error)),
    }


def _quantiles(seconds: Array) -> dict[str, float]:
    """In milliseconds."""
    shares = {"median": 50.0, "p99": 99.0, "p99.9": 99.9, "p99.99": 99.99, "max": 100.0}
    return {name: float(np.percentile(seconds, q)) * MS_PER_S for name, q in shares.items()}


def _explain(horizon: int, slow: Slow) -> Row:
    """Repeat a step many times, each of its phases timed apart."""
    _, command = slow.mpc.step(slow.state, slow.target)
    workload = command.report.workload
    phases = np.median([_phases(slow) for _ in range(REPLAYS)], axis=0) * MS_PER_S
    return {
        "horizon": horizon,
        "scene": slow.scene,
        "step": slow.step,
        "time_ms": slow.cpu * MS_PER_S,
        "again_ms": float(phases.sum()),
        "prepare_ms": float(phases[0]),
        "solve_ms": float(phases[1]),
        "decide_ms": float(phases[2]),
        "qps": workload.qps,
        "iterations": workload.iterations,
        "planes": workload.planes,
        "filter_tests": workload.tests,
        "halvings": workload.halvings,
        "step_fraction": command.report.step_fraction,
    }


def _phases(slow: Slow) -> tuple[float, float, float]:
    """Processor time of linearising, of solving with all its rounds, and of deciding [s]."""
    mpc, state, target = slow.mpc, slow.state, np.asarray(slow.target)
    H, f = total_quadratics((), mpc.robot, state.plan, target)
    model, work = mpc.model, mpc.memory.work
    times = [process_time_ns()]
    prepared = plan.prepare(
        model, work, state.c, state.points, state.clearance, state.plan, state.contacts, target,
        H, f, np.inf,
    )  # fmt: skip
    times.append(process_time_ns())
    solved = plan.solve(model, work, prepared)
    times.append(process_time_ns())
    decide(model, work, prepared, solved, target, H, f)
    times.append(process_time_ns())
    prepare, solve, rest = np.diff(times) / NS_PER_S
    return float(prepare), float(solve), float(rest)


def _noise(repetitions: int) -> dict[str, object]:
    """How much the time of one and the same step varies, and of nothing at all."""
    scene = next(random_scenes(SEED, 1, 1))
    mpc = ShapeConstrainedMPC(scene.robot, scene.zone, margin=scene.margin, dt=scene.dt, horizon=2)
    state = mpc.init(scene.start)
    same, nothing, wall = np.empty(repetitions), np.empty(repetitions), np.empty(repetitions)
    with no_garbage_collection():
        for k in range(repetitions):
            began, clock = process_time_ns(), perf_counter_ns()
            mpc.step(state, scene.targets[0])
            same[k] = (process_time_ns() - began) / NS_PER_S
            wall[k] = (perf_counter_ns() - clock) / NS_PER_S
            began = process_time_ns()
            nothing[k] = (process_time_ns() - began) / NS_PER_S
    return {
        "same_step_cpu_ms": _quantiles(same),
        "same_step_wall_ms": _quantiles(wall),
        "nothing_cpu_ms": _quantiles(nothing),
    }


COLUMNS = (
    Column(key="horizon", title="N"),
    Column(key="budget_ms", title="budget", form=".1f"),
    Column(key="steps", title="steps"),
    Column(key="median_ms", title="median", form=".3f"),
    Column(key="p99_ms", title="p99", form=".3f"),
    Column(key="p99.9_ms", title="p99.9", form=".3f"),
    Column(key="max_ms", title="max", form=".3f"),
    Column(key="over_0.5_ms", title="> 0.5 ms"),
    Column(key="over_0.5_ms_again", title="again"),
    Column(key="violations", title="broken"),
    Column(key="failures", title="failed"),
    Column(key="out_of_time", title="late"),
    Column(key="tip_error_median_mm", title="tip", form=".2f"),
    Column(key="tip_error_mean_mm", title="mean", form=".2f"),
)
WORST_COLUMNS = (
    Column(key="horizon", title="N"),
    Column(key="time_ms", title="time", form=".2f"),
    Column(key="again_ms", title="again", form=".2f"),
    Column(key="prepare_ms", title="prepare", form=".2f"),
    Column(key="solve_ms", title="solve", form=".2f"),
    Column(key="decide_ms", title="decide", form=".2f"),
    Column(key="qps", title="QPs"),
    Column(key="iterations", title="iterations"),
    Column(key="planes", title="planes"),
    Column(key="filter_tests", title="tests"),
    Column(key="halvings", title="halvings"),
)
NOTES = (
    "Processor time in ms, one thread; tip error in mm. One target in three is out of reach.",
    '"broken": steps in which the body surface, every 0.25 mm at five shapes, is closer to a wall '
    'than the margin. "late": the budget ended before the work did.',
    '"again": the same step repeated, median; what is above it was the machine. With a budget: how '
    "many of the steps over 0.5 ms are so again.",
    "The worst case is bounded by 6 QPs of 40 iterations each, 64 planes a stage, and 16 shares "
    "of the step in the filter; a budget bounds it by time.",
)

TAILS = Benchmark(run=run, draw=draw)
