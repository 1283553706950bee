"""The second half of a control step: descend, filter, and say what was decided."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel
from sinuous.control.step import plan
from sinuous.control.step.clock import seconds
from sinuous.control.step.data import CONTACTS, Contacts, Model, Work
from sinuous.control.step.interior import OUT_OF_TIME
from sinuous.control.step.limits import limited
from sinuous.control.step.look import least_bend_slack, least_slack, look
from sinuous.control.step.merit import descend
from sinuous.control.step.plan import Prepared, Solved
from sinuous.control.step.rows import FIRST, LAST
from sinuous.control.step.safety import accept

# Multipliers below this share of the largest are rounding.
INACTIVE = 1e-6


class Outcome(NamedTuple):
    """What a step decides.

    Arguments:
        c: configuration to move to (n,)
        plan: predicted configurations, shifted by one step (N, n)
        contacts: of the shifted plan
        points, clearance: of the body at c (S, 3), (S,) [m]; the latter exact or a lower bound
        slack: least of walls and bends at c, or a lower bound if positive [m]
        share: of the planned step that is taken
        tests: shares that the filter looked at
        halvings: of the plan's change, to descend
        in_time: whether the budget was enough
        change: of the actuator lengths (P,) [m]
        tip_moved, tip_error: how far the step moves the tip, and what is left to the target [m]
        what, which, triangle, strength: rows the plan leans on (A,)
    """

    c: Array
    plan: Array
    contacts: Contacts
    points: Array
    clearance: Array
    slack: float
    share: float
    tests: int
    halvings: int
    in_time: bool
    change: Array
    tip_moved: float
    tip_error: float
    what: IntArray
    which: IntArray
    triangle: IntArray
    strength: Array


@kernel
def decide(
    model: Model,
    work: Work,
    prepared: Prepared,
    solved: Solved,
    target: Array,
    extra_H: Array,
    extra_f: Array,
) -> Outcome:
    """Descend to a lower exact cost, and take as much of the first step as is safe."""
    leaning = Contacts(
        np.zeros(work.old.c.shape[0], np.int64),
        np.zeros((work.old.c.shape[0], CONTACTS), np.int64),
        np.zeros((work.old.c.shape[0], CONTACTS), np.int64),
        np.zeros((work.old.c.shape[0], CONTACTS, 3)),
    )
    halvings = 0
    if prepared.built:
        plan.lean(work, prepared.hard, solved, leaning)
    if solved.whole:
        halvings = descend(
            model, work, leaning, target, extra_H, extra_f, solved.used, prepared.deadline
        )
    share, tests = accept(model, work, prepared.last)
    in_time = solved.whole and solved.status != OUT_OF_TIME
    if np.isfinite(prepared.last):
        in_time = in_time and seconds() <= prepared.last
    return _outcome(model, work, leaning, target, share, solved.rows, tests, halvings, in_time)


@kernel
def _outcome(
    model: Model,
    work: Work,
    leaning: Contacts,
    target: Array,
    share: float,
    count: int,
    tests: int,
    halvings: int,
    in_time: bool,
) -> Outcome:
    start, new, end = work.start.c[0], work.found.c, work.end.c[0]
    N, n = new.shape
    # The whole plan shrinks with the step, so that it stays reachable (notes B17).
    after = np.empty((N, n))
    for i in range(N):
        ahead = min(i + 1, N - 1)
        for j in range(n):
            after[i, j] = start[j] + share * (new[ahead, j] - start[j])
    shifted = Contacts(
        np.empty_like(leaning.number),
        np.empty_like(leaning.point),
        np.empty_like(leaning.slot),
        np.empty_like(leaning.push),
    )
    for i in range(N):
        ahead = min(i + 1, N - 1)
        shifted.number[i] = leaning.number[ahead]
        shifted.point[i], shifted.slot[i] = leaning.point[ahead], leaning.slot[ahead]
        shifted.push[i] = leaning.push[ahead]
    slack = min(least_slack(model.body, work.end, 0), least_bend_slack(model.bends, end))
    what, index, triangle, strength = _active(model, work, count)
    moved, error, last = 0.0, 0.0, work.end.points.shape[1] - 1
    for d in range(3):
        tip = work.end.points[0, last, d]
        moved += (tip - work.start.points[0, last, d]) ** 2
        error += (tip - target[d]) ** 2
    change = np.zeros(model.limits.slowest.size)
    for k in range(change.size):
        change[k] = limited(model.limits, k, end) - limited(model.limits, k, start)
    return Outcome(
        end.copy(), after, shifted, work.end.points[0].copy(), work.end.clearance[0].copy(),
        slack, share, tests, halvings,
        in_time, change, np.sqrt(moved), np.sqrt(error), what, index, triangle, strength,
    )  # fmt: skip


@kernel
def _active(model: Model, work: Work, count: int) -> tuple[IntArray, IntArray, IntArray, Array]:
    """Rows with a multiplier; limits of the trust region are none of the robot's."""
    meaning, strength = work.problem.meaning, work.problem.strength
    most, number = 0.0, 0
    for k in range(count):
        most = max(most, strength[k])
    for k in range(count):
        if strength[k] > INACTIVE * most and meaning.index[k] >= 0:
            work.scratch.number[number] = k
            number += 1
    what, index = np.empty(number, np.int64), np.empty(number, np.int64)
    triangle, value = np.empty(number, np.int64), np.empty(number)
    for m in range(number):
        k = work.scratch.number[m]
        what[m], index[m], value[m] = meaning.what[k], meaning.index[k], strength[k]
        slot = meaning.slot[k]
        triangle[m] = model.body.zone.triangle[slot] if slot >= 0 else -1
    return what, index, triangle, value


class FirstProblem(NamedTuple):
    """The first QP of a step, see `data.Problem`; the arrays are the scratch's own."""

    H: Array
    f: Array
    E: Array
    a: Array
    place: IntArray
    bound: Array
    what: IntArray
    which: IntArray
    total: int


@kernel
def first_problem(work: Work, count: int) -> FirstProblem:
    """What `prepare` built."""
    problem, rows, meaning = work.problem, work.problem.rows, work.problem.meaning
    for k in range(count):
        for j in range(rows.a.shape[1]):
            if j < rows.place[k, FIRST] or j >= rows.place[k, LAST]:
                rows.a[k, j] = 0.0
    return FirstProblem(
        problem.H, problem.f, problem.E, rows.a, rows.place, rows.bound, meaning.what,
        meaning.index, count,
    )  # fmt: skip


@kernel
def filtered(model: Model, work: Work, c: Array, goal: Array) -> tuple[Array, float]:
    """How far the straight way from c to the goal is safe: where it ends, and which share."""
    scratch = work.scratch
    work.start.c[0, :] = c
    work.found.c[0, :] = goal
    seen, room = np.zeros((0, 3)), np.zeros(0)
    look(model.body, work.start, 0, 0.0, seen, room, scratch)
    look(model.body, work.found, 0, 0.0, seen, room, scratch)
    share, _ = accept(model, work, np.inf)
    return work.end.c[0].copy(), share
