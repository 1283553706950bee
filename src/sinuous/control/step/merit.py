"""Taking as much of a new plan as lowers the exact cost."""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.clock import seconds
from sinuous.control.step.cuts import BEND_RESERVE
from sinuous.control.step.data import BEND, Contacts, Model, Shape, Work
from sinuous.control.step.look import bend_slack, look

# What a metre beyond a wall or a bend limit costs when plans are compared, in units of the
# strongest push.
PRICE = 3.0

# Halvings of a change of the plan before it is taken as it is.
BACKTRACKS = 6


@kernel
def descend(
    model: Model,
    work: Work,
    contacts: Contacts,
    target: Array,
    extra_H: Array,
    extra_f: Array,
    used: int,
    deadline: float,
) -> int:
    """Shorten the change from the old to the new stages until it lowers the exact cost.

    Without it the plan can hop for ever between two sets of active walls (a limit cycle of
    millimetres where three walls meet at the tip).  Returns how often it was halved.

    Arguments:
        used: rows of the last QP
    """
    price = PRICE * _strongest_push(work, contacts, used)
    before = merit(model, work, work.old, target, price, extra_H, extra_f)
    old, new = work.old, work.found
    for halved in range(BACKTRACKS):
        if merit(model, work, new, target, price, extra_H, extra_f) <= before:
            return halved
        if np.isfinite(deadline) and seconds() > deadline:
            return halved
        for i in range(new.c.shape[0]):
            for j in range(new.c.shape[1]):
                new.c[i, j] = old.c[i, j] + 0.5 * (new.c[i, j] - old.c[i, j])
            look(
                model.body, new, i, model.rules.reserve, old.points[i], old.clearance[i],
                work.scratch,
            )  # fmt: skip
    return BACKTRACKS


@kernel
def _strongest_push(work: Work, contacts: Contacts, used: int) -> float:
    """Of a wall or a bend limit in the last QP [cost / m]."""
    walls, strongest = 0.0, 0.0
    for i in range(contacts.number.size):
        for k in range(contacts.number[i]):
            push = contacts.push[i, k]
            walls = max(walls, push[0] ** 2 + push[1] ** 2 + push[2] ** 2)
    for k in range(used):
        if work.problem.meaning.what[k] == BEND:
            strongest = max(strongest, work.problem.strength[k])
    return float(max(strongest, np.sqrt(walls)))


@kernel
def merit(
    model: Model,
    work: Work,
    shape: Shape,
    target: Array,
    price: float,
    extra_H: Array,
    extra_f: Array,
) -> float:
    """Exact cost of the stages, plus the price of every metre beyond a shape constraint.

    Further costs count by their quadratic model.
    """
    aims, body, bends = model.aims, model.body, model.bends
    N, n, last, total = shape.c.shape[0], shape.c.shape[1], body.required.size - 1, 0.0
    for i in range(N):
        c = shape.c[i]
        for d in range(3):
            total += aims.tip * (shape.points[i, last, d] - target[d]) ** 2
        total += _state_cost(model, work.motion.free[i], c, work.scratch.row)
        for r in range(n):
            pull = 0.0
            for j in range(n):
                moved = c[j] - (shape.c[i - 1, j] if i > 0 else work.start.c[0, j])
                pull += aims.E[r, j] * moved
            total += 0.5 * pull * (c[r] - (shape.c[i - 1, r] if i > 0 else work.start.c[0, r]))
        if extra_H.shape[0] == N:
            for r in range(n):
                pull = extra_f[i, r]
                for j in range(n):
                    pull += 0.5 * extra_H[i, r, j] * (c[j] - work.old.c[i, j])
                total += pull * (c[r] - work.old.c[i, r])
        for s in range(body.required.size):
            room = shape.clearance[i, s] - body.required[s] - model.rules.reserve
            if room < 0.0:
                total -= price * room
        for j in range(bends.column.size):
            total += price * max(BEND_RESERVE - bend_slack(bends, j, c), 0.0)
    return total


@kernel
def _state_cost(model: Model, free: Array, c: Array, row: Array) -> float:
    """Posture and quadratic cost of one configuration."""
    aims, metric, n, total = model.aims, model.scale.metric, c.size, 0.0
    for r in range(n):
        row[r], pull = 0.0, aims.q[r]
        for j in range(n):
            row[r] += metric[r, j] * (c[j] - aims.home[j])
            pull += 0.5 * aims.Q[r, j] * c[j]
        total += pull * c[r]
    if aims.posture > 0.0:
        for r in range(n):
            pulled = 0.0
            for j in range(n):
                pulled += free[r, j] * row[j]
            total += aims.posture * pulled * pulled
    return total
