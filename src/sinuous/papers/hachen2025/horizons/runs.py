"""Runs towards one target: until the tip comes no closer, or for a time to see the body settle."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from time import perf_counter, process_time
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.loop import no_garbage_collection
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.papers.hachen2025.horizons.scenes import DeadEnd
from sinuous.papers.hachen2025.runs import scenario

ARRIVED = 1e-5  # a tip so close that going on would show nothing new [m]
CLOSER = 2e-5  # a tip that does not come closer by that [m] ...
PATIENCE = 1.0  # ... in so long [s] goes nowhere
LONGEST = 15.0  # that a run takes [s]

GUIDE, GUIDE_DT = 5, 1 / 30  # horizon and time step of the run along way-points

STILL = 1e-3  # a body whose points all move slower than this [m/s] has settled
REST = 1.0  # the last part of a run that shows how calm the inputs are [s]

PASSAGES = ("winding_tube", "inverted_u")  # of III-D, the tightest scenes here


@dataclass(frozen=True, kw_only=True, eq=False)
class End:
    """Where a run ended.

    Arguments:
        c: configuration (n,)
        error: of the tip [m]
        time: until the tip was there, or came no closer [s]
    """

    c: Array
    error: float
    time: float


def drive(mpc: ShapeConstrainedMPC, start: Array, target: Array) -> End:
    """Go from rest at start (n,) towards target (3,) [m] until the tip comes no closer."""
    state, best, since, error, time = mpc.init(start), np.inf, 0.0, np.inf, 0.0
    while error > ARRIVED and time - since < PATIENCE and time < LONGEST:
        state, command = mpc.step(state, target)
        time += mpc.dt
        error = float(np.linalg.norm(command.report.points[-1] - target))
        if error < best - CLOSER:
            best, since = error, time
    return End(c=state.c, error=error, time=since)


def guided(scene: DeadEnd, target: Array) -> float:
    """Tip error [m] of a run along the scene's way-points: proof that a way exists."""
    mpc, c = scene.controller(GUIDE, GUIDE_DT), scene.start
    for place in scene.via:
        c = drive(mpc, c, place).c
    return drive(mpc, c, target).error


def settle(
    mpc: ShapeConstrainedMPC, start: Array, target: Array, duration: float
) -> dict[str, float]:
    """How a run of a duration [s] towards target (3,) [m] comes to rest."""
    state, points, rates = mpc.init(start), list[Array](), list[Array]()
    for _ in range(round(duration / mpc.dt)):
        state, command = mpc.step(state, target)
        points.append(command.report.points)
        rates.append(command.rates)
    speeds = np.linalg.norm(np.diff(points, axis=0), axis=2).max(axis=1) / mpc.dt
    moving = np.flatnonzero(speeds > STILL)
    last = np.array(rates[-round(REST / mpc.dt) :])
    return {
        "error_m": float(np.linalg.norm(points[-1][-1] - target)),
        "settled_s": float(moving[-1] + 2) * mpc.dt if len(moving) else 0.0,
        "rate_change_at_rest_m_s": float(np.abs(np.diff(last, axis=0)).max(axis=1).mean()),
    }


@dataclass(frozen=True, kw_only=True, eq=False)
class Course:
    """What is driven while time is measured.

    Arguments:
        mpc: whose horizon and time step are replaced
        start: configuration (n,)
        targets: one after the other (K, 3) [m]
    """

    mpc: ShapeConstrainedMPC
    start: Array
    targets: Array

    @classmethod
    def through(cls, name: str) -> "Course":
        """A passage of III-D along its way-points."""
        found = scenario(name)
        targets = np.array([leg.at(0.0) for leg in found.path])
        return cls(mpc=found.mpc, start=found.first_configuration, targets=targets)

    @classmethod
    def of(cls, scene: DeadEnd) -> "Course":
        """A scene with all of its targets."""
        return cls(mpc=scene.controller(1, 1.0), start=scene.start, targets=scene.targets)


def cost(courses: Sequence[Course], horizon: int, dt: float, held: float) -> dict[str, Any]:
    """Time of the steps of one horizon, each target held for so long [s]."""
    wall, cpu = list[float](), list[float]()
    for course in courses:
        mpc = replace(course.mpc, horizon=horizon, dt=dt)
        state = mpc.init(course.start)
        mpc.step(state, course.targets[0])  # loads what is compiled
        with no_garbage_collection():
            for target in np.repeat(course.targets, round(held / dt), axis=0):
                began, busy = perf_counter(), process_time()
                state, _ = mpc.step(state, target)
                cpu.append(process_time() - busy)
                wall.append(perf_counter() - began)
    return {
        "horizon": horizon,
        "steps": len(wall),
        "median_s": float(np.median(wall)),
        "p99_s": float(np.percentile(wall, 99)),
        "max_s": float(np.max(wall)),
        "cpu_median_s": float(np.median(cpu)),
        "cpu_p99_s": float(np.percentile(cpu, 99)),
        "cpu_max_s": float(np.max(cpu)),
    }
