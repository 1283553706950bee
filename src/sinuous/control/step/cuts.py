"""Soft rows of the QP: planes and tangents that stand in for the shape of the body.

The distance to one triangle is convex, so its tangent plane never promises more room than there
is.  The distance to a mesh is not: one plane per point misses the other walls (notes B8).  So
the cuts start from each point's nearest triangle; the solution is checked against the whole
mesh, and the triangles it violates join as planes taken at the old point.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.data import (
    BEND,
    WALL,
    Contacts,
    Model,
    Motion,
    Problem,
    Scratch,
    Shape,
)
from sinuous.control.step.look import bend_slack
from sinuous.control.step.rows import FIRST, KIND, LAST, LOWER, STAGE, STATE, UPPER
from sinuous.geometry.bvh import plane
from sinuous.robots import chain_kernels
from sinuous.robots.bending import bend, bend_gradient

# Planes of one stage that join at a time, the tightest first: without a bound a body deep in the
# wall would stall the solver.
MOST = 24

# Walls that yield less than this per unit of every coordinate cannot be steered away from.
IMMOVABLE = 1e-6

# Bend limits with less cable travel left than this get a row from the start [m]; every row is
# kept so much short of its limit, because the tangent allows too much (notes B10).
NEAR_BEND, BEND_RESERVE = 0.002, 1e-5

STRAIGHT = 1e-9  # bends below this have no direction worth naming [rad]


@kernel
def first_cuts(
    model: Model,
    old: Shape,
    motion: Motion,
    contacts: Contacts,
    problem: Problem,
    count: int,
    scratch: Scratch,
) -> int:
    """Cuts around the predicted stages, those for the last plan's contacts among them.

    Returns the number of rows there are now.
    """
    body, rules = model.body, model.rules
    for i in range(old.c.shape[0]):
        for j in range(model.bends.column.size):
            if bend_slack(model.bends, j, old.c[i]) < NEAR_BEND:
                count = _add_bend(model, problem, count, i, j, old.c[i], scratch)
        number = 0
        for s in range(body.required.size):
            room = old.clearance[i, s] - body.required[s] - rules.reserve
            if body.movable[s] and old.exact[i, s] and room < rules.near:
                scratch.number[number], scratch.amount[number] = s, room
                number += 1
        for k in range(_tightest(scratch, number)):
            s = scratch.number[k]
            count = _add_plane(model, old, motion, problem, count, i, s, old.slot[i, s], scratch)
        for k in range(contacts.number[i]):
            s, slot = contacts.point[i, k], contacts.slot[i, k]
            if not old.exact[i, s] or old.slot[i, s] != slot:
                count = _add_plane(model, old, motion, problem, count, i, s, slot, scratch)
    return count


@kernel
def violated_cuts(
    model: Model,
    old: Shape,
    new: Shape,
    motion: Motion,
    problem: Problem,
    hard: int,
    count: int,
    y: Array,
    scratch: Scratch,
    tolerance: float,
) -> tuple[int, int]:
    """Cut off what the new stages violate; returns the rows there are now and what was cut.

    Where a row itself holds and only the curvature of the kinematics is to blame, its slack is
    lowered by what linearisation missed (a second-order correction).
    """
    body, rules, changed = model.body, model.rules, 0
    for i in range(old.c.shape[0]):
        allowed = tolerance if i == 0 else max(tolerance, rules.late)
        for j in range(model.bends.column.size):
            left = bend_slack(model.bends, j, new.c[i])
            if left < BEND_RESERVE - min(allowed, 0.5 * BEND_RESERVE):
                k = _find(problem, hard, count, i, BEND, j, -1)
                if k < 0:
                    k = count
                    count = _add_bend(model, problem, count, i, j, old.c[i], scratch)
                if k < count:
                    _lower(model, problem, k, y, left - BEND_RESERVE)
                    changed += 1
        number = 0
        for s in range(body.required.size):
            room = new.clearance[i, s] - body.required[s] - rules.reserve
            if body.movable[s] and new.exact[i, s] and room < -allowed:
                scratch.number[number], scratch.amount[number] = s, room
                number += 1
        for m in range(_tightest(scratch, number)):
            s, room = scratch.number[m], scratch.amount[m]
            k = _find(problem, hard, count, i, WALL, s, new.slot[i, s])
            if k < 0:
                k = count
                slot = new.slot[i, s]
                count = _add_plane(model, old, motion, problem, count, i, s, slot, scratch)
            if k < count:
                _lower(model, problem, k, y, room)
                changed += 1
    return count, changed


@kernel
def _tightest(scratch: Scratch, number: int) -> int:
    """Bring the least amounts to the front and return how many of them are to be used."""
    use = min(number, MOST)
    if number > MOST:
        for k in range(use):
            least = k
            for m in range(k + 1, number):
                if scratch.amount[m] < scratch.amount[least]:
                    least = m
            amount, index = scratch.amount[k], scratch.number[k]
            scratch.amount[k], scratch.number[k] = scratch.amount[least], scratch.number[least]
            scratch.amount[least], scratch.number[least] = amount, index
    return use


@kernel
def _find(problem: Problem, hard: int, count: int, i: int, what: int, index: int, slot: int) -> int:
    """The soft row of a stage with this meaning, -1 if there is none."""
    meaning, place = problem.meaning, problem.rows.place
    for k in range(hard, count):
        same = meaning.what[k] == what and meaning.index[k] == index and meaning.slot[k] == slot
        if same and place[k, STAGE] == i:
            return k
    return -1


@kernel
def _lower(model: Model, problem: Problem, k: int, y: Array, exact: float) -> None:
    """Lower the slack of row k to what it really was at y, if it promised more [m]."""
    rows, promised = problem.rows, -problem.rows.bound[k, LOWER]
    for j in range(y.shape[1]):
        promised += rows.a[k, j] * y[rows.place[k, STAGE], j]
    unit = model.scale.step * problem.meaning.size[k]
    rows.bound[k, LOWER] += max(promised - exact / unit, 0.0)


@kernel
def _add_plane(
    model: Model,
    old: Shape,
    motion: Motion,
    problem: Problem,
    count: int,
    i: int,
    s: int,
    slot: int,
    scratch: Scratch,
) -> int:
    """Add the plane of one triangle seen from body point s at stage i."""
    body, own = model.body, old.exact[i, s] and old.slot[i, s] == slot
    if own:
        # The nearest triangle of a point carries the sign and gradient of the zone itself.
        d = old.clearance[i, s]
        nx, ny, nz = old.gradient[i, s, 0], old.gradient[i, s, 1], old.gradient[i, s, 2]
    elif old.clearance[i, s] < 0.0:
        return count  # from outside, only the nearest wall shows the way back in
    else:
        x, y, z = old.points[i, s, 0], old.points[i, s, 1], old.points[i, s, 2]
        d, nx, ny, nz = plane(body.zone, slot, x, y, z)
    c, J, row = old.c[i], scratch.J, scratch.row
    chain_kernels.point_jacobian(
        body.chain, s, c, motion.R[i], motion.p[i], motion.ends[i], motion.spins[i], J
    )
    largest = 0.0
    for j in range(c.size):
        row[j] = nx * J[0, j] + ny * J[1, j] + nz * J[2, j]
        largest = max(largest, abs(row[j]))
    if largest <= IMMOVABLE:
        return count
    slack = d - body.required[s] - model.rules.reserve
    return _add(model, problem, count, i, row, slack, WALL, s, slot, nx, ny, nz)


@kernel
def _add_bend(
    model: Model, problem: Problem, count: int, i: int, j: int, c: Array, scratch: Scratch
) -> int:
    """Add the tangent of bend limit j at stage i."""
    bends, row = model.bends, scratch.row
    column, pitch = bends.column[j], bends.pitch[j]
    gx, gy = bend_gradient(bends.is_joint[j], float(c[column]), float(c[column + 1]))
    for k in range(c.size):
        row[k] = pitch * bends.slope[j, k]
    if bend(bends.is_joint[j], float(c[column]), float(c[column + 1])) > STRAIGHT:
        row[column] -= pitch * gx
        row[column + 1] -= pitch * gy
    largest = 0.0
    for k in range(c.size):
        largest = max(largest, abs(row[k]))
    if largest == 0.0:
        return count  # a straight segment of fixed length can bend any way
    slack = bend_slack(bends, j, c) - BEND_RESERVE
    return _add(model, problem, count, i, row, slack, BEND, j, -1, 0.0, 0.0, 0.0)


@kernel
def _add(
    model: Model,
    problem: Problem,
    count: int,
    i: int,
    row: Array,
    slack: float,
    what: int,
    index: int,
    slot: int,
    nx: float,
    ny: float,
    nz: float,
) -> int:
    """Add the soft row slack + row delta >= 0, scaled to norm one."""
    rows, meaning, inverse = problem.rows, problem.meaning, model.scale.inverse
    n, total = row.size, 0.0
    if count >= rows.bound.shape[0]:
        return count
    for j in range(n):
        value = 0.0
        for k in range(n):
            value += row[k] * inverse[k, j]
        rows.a[count, j] = value
        total += value * value
    size = np.sqrt(total)
    for j in range(n):
        rows.a[count, j] /= size
    rows.place[count, FIRST], rows.place[count, LAST] = 0, n
    rows.bound[count, LOWER], rows.bound[count, UPPER] = -slack / (model.scale.step * size), np.inf
    rows.place[count, STAGE], rows.place[count, KIND] = i, STATE
    meaning.what[count], meaning.index[count], meaning.slot[count] = what, index, slot
    meaning.normal[count, 0], meaning.normal[count, 1], meaning.normal[count, 2] = nx, ny, nz
    meaning.size[count] = size
    return count + 1
