"""One plan over the horizon: linearise, solve, look at the exact mesh, add what is violated."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step import interior
from sinuous.control.step.clock import seconds
from sinuous.control.step.cuts import first_cuts, violated_cuts
from sinuous.control.step.data import (
    WALL,
    Contacts,
    Model,
    Shape,
    Work,
)
from sinuous.control.step.interior import OUT_OF_TIME, SOLVED, UNFINISHED
from sinuous.control.step.limits import hard_rows
from sinuous.control.step.linearise import linearise
from sinuous.control.step.look import copy, least_bend_slack, least_slack, look
from sinuous.control.step.rows import PRICE, STAGE

# A soft row costs this many times the largest cost gradient per unit of violation. It must
# exceed the row's multiplier for the penalty to be exact; in closed loops those stay below 3.
PENALTY = 100.0

# A body that is beyond a limit anyway violates planes in every round: the filter judges its
# step, and more rounds would not change that.
ROUNDS_BEYOND = 2

# Shares of a budget after which the plan, and after which the filter has to stop.
PLAN_SHARE, FILTER_SHARE = 0.5, 0.75

# A plan may come this much closer than its reserve before it is corrected [m].
TOLERANCE = 1e-6


class Prepared(NamedTuple):
    """The first QP of a step.

    Arguments:
        hard, rows: number of hard rows, and of all
        size: cost that counts as one
        inside: whether the start keeps the margin and the bend limits
        built: whether there was time for all of it
        deadline, last: when the plan, and when the filter has to stop, on `clock.seconds`
    """

    hard: int
    rows: int
    size: float
    inside: bool
    built: bool
    deadline: float
    last: float


class Solved(NamedTuple):
    """How the rounds of solving went.

    Arguments:
        status: how the last QP ended, see `interior`
        qps, iterations: solved, and how many iterations that took
        rows: there are now; those from `used` on joined after the last QP
        planes: soft ones among them
        whole: whether there was time to look at all new stages, and not only at the first
    """

    status: int
    qps: int
    iterations: int
    rows: int
    used: int
    planes: int
    whole: bool


@kernel
def prepare(
    model: Model,
    work: Work,
    c: Array,
    seen: Array,
    room: Array,
    predicted: Array,
    contacts: Contacts,
    target: Array,
    extra_H: Array,
    extra_f: Array,
    budget: float,
) -> Prepared:
    """Build the QP around the predicted stages, with its first cuts.

    Arguments:
        work: scratch, see `memory`; one step at a time may use it
        c: configuration to start from (n,)
        seen, room: what is known about clearances nearby, see `look`
        predicted: configurations 1..N (N, n)
        contacts: walls they lean on
        target: (3,) [m]
        extra_H, extra_f: Hessian and gradient by c of further costs (N, n, n), (N, n), or empty
        budget: processor time to use [s], infinite for no limit
    """
    began = seconds() if np.isfinite(budget) else 0.0
    start, scratch = work.start, work.scratch
    start.c[0, :] = c
    work.old.c[:] = predicted
    look(model.body, start, 0, 0.0, seen, room, scratch)
    inside = (
        least_slack(model.body, start, 0) >= 0.0
        and least_bend_slack(model.bends, start.c[0]) >= 0.0
    )
    deadline, last = began + PLAN_SHARE * budget, began + FILTER_SHARE * budget
    if not _stages(model, work, contacts, target, deadline):
        return Prepared(0, 0, 1.0, inside, False, deadline, last)
    hard, count, size = _build(model, work, contacts, extra_H, extra_f)
    return Prepared(hard, count, size, inside, True, deadline, last)


@kernel
def _stages(model: Model, work: Work, contacts: Contacts, target: Array, deadline: float) -> bool:
    """Look at the predicted stages and linearise them; false if there was no time for all."""
    old, extra = work.old, model.rules.reserve + model.rules.near
    for i in range(old.c.shape[0]):
        if i > 0 and np.isfinite(deadline) and seconds() > deadline:
            return False
        # Each stage is near the one before it.
        seen = work.start.points[0] if i == 0 else old.points[i - 1]
        room = work.start.clearance[0] if i == 0 else old.clearance[i - 1]
        look(model.body, old, i, extra, seen, room, work.scratch)
        linearise(model, old, work.motion, contacts, work.problem, i, target, work.scratch)
    return True


@kernel
def _build(
    model: Model, work: Work, contacts: Contacts, extra_H: Array, extra_f: Array
) -> tuple[int, int, float]:
    """Add up costs and rows; returns the hard rows, all rows and the cost that counts as one."""
    old, problem, scratch = work.old, work.problem, work.scratch
    H, f, rows, meaning = problem.H, problem.f, problem.rows, problem.meaning
    N, n, scale = old.c.shape[0], old.c.shape[1], model.scale
    if extra_H.shape[0] == N:
        _add_extra(model, work, extra_H, extra_f)
    _add_effort(model, work)
    trace, largest = 0.0, 0.0
    for i in range(N):
        for j in range(n):
            trace += H[i, j, j] + scale.E[j, j] * (2.0 if i + 1 < N else 1.0)
            largest = max(largest, abs(f[i, j]))
    size = trace / (N * n)
    for i in range(N):
        for r in range(n):
            f[i, r] /= size
            for j in range(n):
                H[i, r, j] /= size
    for r in range(n):
        for j in range(n):
            work.problem.E[r, j] = scale.E[r, j] / size
    hard = hard_rows(model, work.start.c[0], old, work.motion, problem, work.scratch)
    count = first_cuts(model, old, work.motion, contacts, problem, hard, scratch)
    rows.bound[hard:, PRICE] = PENALTY * (1.0 + largest / size)
    for k in range(count):
        meaning.value[k] = size / (scale.step * meaning.size[k])
    return hard, count, size


@kernel
def _add_extra(model: Model, work: Work, extra_H: Array, extra_f: Array) -> None:
    """Add costs that were given by c."""
    from_c, s, n = model.scale.inverse, model.scale.step, model.scale.inverse.shape[0]
    for i in range(extra_H.shape[0]):
        work.problem.H[i] += s * s * (from_c.T @ extra_H[i] @ from_c)
        for r in range(n):
            for j in range(n):
                work.problem.f[i, r] += s * from_c[j, r] * extra_f[i, j]


@kernel
def _add_effort(model: Model, work: Work) -> None:
    """Add the gradient of the increments' cost at the prediction."""
    E, inverse, s = model.aims.E, model.scale.inverse, model.scale.step
    c, start, f = work.old.c, work.start.c[0], work.problem.f
    N, n = c.shape
    for i in range(N):
        for r in range(n):
            total = 0.0
            for j in range(n):
                total += E[r, j] * (c[i, j] - (c[i - 1, j] if i > 0 else start[j]))
            work.scratch.row[r] = total
        for r in range(n):
            pull = 0.0
            for j in range(n):
                pull += s * inverse[j, r] * work.scratch.row[j]
            f[i, r] += pull
            if i > 0:
                f[i - 1, r] -= pull


@kernel
def solve(model: Model, work: Work, prepared: Prepared) -> Solved:
    """Solve, look at the exact mesh, add what is violated, and solve again.

    The new stages are in `work.found`; without the time for a QP they are the predicted ones.
    """
    hard, count, size, deadline = prepared.hard, prepared.rows, prepared.size, prepared.deadline
    problem, it, old, new, scratch = work.problem, work.iterate, work.old, work.found, work.scratch
    most = model.rules.rounds if prepared.inside else ROUNDS_BEYOND
    solved, total, used, status, whole = 0, 0, count, UNFINISHED, True
    reserve = model.rules.reserve
    problem.strength[:count] = 0.0
    if not prepared.built:
        new.c[:] = old.c
        copy(old, new, 0)
        return Solved(OUT_OF_TIME, 0, 0, 0, 0, 0, False)
    while solved < most:
        status, iterations = interior.solve(
            problem.H, problem.E, problem.f, problem.rows, count, work.pairs, it, deadline
        )
        total += iterations
        # Out of time in the first QP: what it has is still a guess, and the filter judges it.
        if status == OUT_OF_TIME and total == 0:
            for i in range(old.c.shape[0]):
                copy(old, new, i)
        elif status == SOLVED or (status == OUT_OF_TIME and solved == 0):
            _place(model, old, new, it.y)
            for i in range(old.c.shape[0]):
                if i > 0 and np.isfinite(deadline) and seconds() > deadline:
                    whole = False  # the first stage is all that the filter needs
                    break
                look(model.body, new, i, reserve, old.points[i], old.clearance[i], scratch)
        if status != SOLVED:
            break
        solved += 1
        used = count
        _keep(work, count)
        if not whole:
            break
        count, changed = violated_cuts(
            model, old, new, work.motion, problem, hard, count, it.y, scratch, TOLERANCE
        )
        for k in range(used, count):
            problem.meaning.value[k] = size / (model.scale.step * problem.meaning.size[k])
            work.problem.strength[k] = 0.0
        if changed == 0 or (np.isfinite(deadline) and seconds() > deadline):
            break
    return Solved(status, solved, total, count, used, count - hard, whole)


@kernel
def _place(model: Model, old: Shape, new: Shape, y: Array) -> None:
    """Configurations of the solution: c + s M^-1 y."""
    inverse, step, n = model.scale.inverse, model.scale.step, y.shape[1]
    for i in range(y.shape[0]):
        for r in range(n):
            total = 0.0
            for j in range(n):
                total += inverse[r, j] * y[i, j]
            new.c[i, r] = old.c[i, r] + step * total


@kernel
def _keep(work: Work, count: int) -> None:
    """Keep the multipliers of the QP just solved [cost / m]; below their slack they are none."""
    now, value, bound = work.pairs.now, work.problem.meaning.value, work.problem.rows.bound
    strength = work.problem.strength
    for k in range(count):
        most = now[k, 1] if now[k, 1] > now[k, 0] else 0.0
        if not np.isfinite(bound[k, PRICE]) and now[k, 3] > now[k, 2]:
            most = max(most, now[k, 3])
        strength[k] = most * value[k]


@kernel
def lean(work: Work, hard: int, solved: Solved, contacts: Contacts) -> None:
    """Write which walls the new stages lean on; the strongest are kept if there are too many.

    Planes that joined after the last QP have no push yet, but are remembered for the next step.
    """
    meaning, place, strength = work.problem.meaning, work.problem.rows.place, work.problem.strength
    contacts.number[:] = 0
    for k in range(hard, solved.rows):
        if meaning.what[k] != WALL or (strength[k] <= 0.0 and k < solved.used):
            continue
        i = place[k, STAGE]
        at = contacts.number[i]
        if at == contacts.point.shape[1]:
            at, weakest = -1, strength[k]
            for m in range(contacts.point.shape[1]):
                push = contacts.push[i, m]
                size = np.sqrt(push[0] ** 2 + push[1] ** 2 + push[2] ** 2)
                if size < weakest:
                    at, weakest = m, size
            if at < 0:
                continue
        else:
            contacts.number[i] += 1
        contacts.point[i, at], contacts.slot[i, at] = meaning.index[k], meaning.slot[k]
        for d in range(3):
            contacts.push[i, at, d] = strength[k] * meaning.normal[k, d]
