"""The safety filter: how much of a planned step is safe, on the exact mesh, also on the way.

A step is accepted if its least slack is at least min(0, least slack where it starts): then
standing still is always allowed and no step makes a bad state worse (notes B8).
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.clock import seconds
from sinuous.control.step.data import Limits, Model, Work
from sinuous.control.step.limits import limited
from sinuous.control.step.look import copy, least_bend_slack, least_slack, look
from sinuous.geometry.grid import at_least, at_least_from_afar, cell_of, exact
from sinuous.geometry.segment import is_clear
from sinuous.robots import chain_kernels, chain_second

# Slack that a recovering body may lose for a moment on its way to a better shape [m].
WOBBLE = 1e-4

ATTEMPTS = 16  # at shortening a step before the robot stands still
ROUNDING = 1e-9  # share by which a step is shortened further than its limits ask
PIECES = 16  # most pieces that a way is cut into, a power of two
SHORT = 0.002  # chords up to this are judged exactly before they are cut any more [m]
FLAT = 1e-6  # a bow that is not worth cutting a way for [m]


@kernel
def accept(model: Model, work: Work, deadline: float) -> tuple[float, int]:
    """Largest tested share of the way from the start to the first new stage that is safe.

    Both have been looked at.  `work.end` is filled with the shape it leads to; also returns how
    many shares were tested.
    """
    start, goal, end, body = work.start, work.found, work.end, model.body
    wall, bend = floors(model, work)
    share = 1.0
    for attempt in range(ATTEMPTS):
        if np.isfinite(deadline) and seconds() > deadline:
            break
        if attempt == 0:
            end.c[0, :] = goal.c[0]
        else:
            for j in range(end.c.shape[1]):
                end.c[0, j] = start.c[0, j] + share * (goal.c[0, j] - start.c[0, j])
        allowed = _lengths_share(model.limits, start.c[0], end.c[0])
        if allowed == 1.0:
            if attempt == 0:
                copy(goal, end, 0)
            else:
                _look(model, work)
            allowed = _tip_share(model.limits, start.points[0], end.points[0])
        if allowed < 1.0:
            share *= allowed * (1.0 - ROUNDING)
        elif (
            least_slack(body, end, 0) >= wall
            and least_bend_slack(model.bends, end.c[0]) >= bend
            and _way_is_safe(model, work, wall, deadline)
        ):
            return share, attempt + 1
        else:
            share *= 0.5
    end.c[0, :] = start.c[0]
    _look(model, work)
    return 0.0, ATTEMPTS


@kernel
def _look(model: Model, work: Work) -> None:
    """Look at the end, near the start."""
    start, end = work.start, work.end
    look(model.body, end, 0, 0.0, start.points[0], start.clearance[0], work.scratch)


@kernel
def floors(model: Model, work: Work) -> tuple[float, float]:
    """Least slack that a step may end with, of walls and of bends, given where it starts."""
    wall = min(0.0, least_slack(model.body, work.start, 0))
    return wall, min(0.0, least_bend_slack(model.bends, work.start.c[0]))


@kernel
def _lengths_share(limits: Limits, start: Array, end: Array) -> float:
    """Largest share of a step that actuator rates and lengths allow."""
    share = 1.0
    for k in range(limits.low.size):
        now = limited(limits, k, start)
        change = limited(limits, k, end) - now
        if k < limits.fastest.size:
            if share * change > limits.fastest[k]:
                share = limits.fastest[k] / change
            if share * change < limits.slowest[k]:
                share = limits.slowest[k] / change
        # Whoever is beyond a limit already may not go further, whoever is not may go up to it.
        if share * change > max(limits.high[k] - now, 0.0):
            share = max(limits.high[k] - now, 0.0) / change
        if share * change < min(limits.low[k] - now, 0.0):
            share = min(limits.low[k] - now, 0.0) / change
    return share


@kernel
def _tip_share(limits: Limits, start: Array, end: Array) -> float:
    if not np.isfinite(limits.tip_step):
        return 1.0
    last, moved = start.shape[0] - 1, 0.0
    for d in range(3):
        moved += (end[last, d] - start[last, d]) ** 2
    moved = np.sqrt(moved)
    return min(1.0, limits.tip_step / moved) if moved > 0.0 else 1.0


@kernel
def _way_is_safe(model: Model, work: Work, floor: float, deadline: float) -> bool:
    """Whether every shape on the straight way in c keeps its floor, walls and bends.

    Between two shapes a body point strays from its chord by no more than its acceleration
    allows; the chord itself is judged exactly where bounds do not settle it.  Bend slack is
    concave in c, so it is least at one of the ends.
    """
    body, start, end, way = model.body, work.start, work.end, work.way
    allowed = floor - WOBBLE if floor < 0.0 else floor
    delta, bound = work.scratch.row, work.scratch.amount
    for j in range(delta.size):
        delta[j] = end.c[0, j] - start.c[0, j]
    chain_second.acceleration_bound(body.chain, start.c[0], delta, bound)
    way.ready[:] = False
    for s in range(body.required.size):
        if not body.movable[s]:
            continue
        need, bow, chord = body.required[s] + allowed, bound[s] / 8.0, 0.0
        for d in range(3):
            chord += (end.points[0, s, d] - start.points[0, s, d]) ** 2
        both = start.clearance[0, s] + end.clearance[0, s]
        if 0.5 * (both - np.sqrt(chord)) - bow >= need:
            continue
        if np.isfinite(deadline) and seconds() > deadline:
            return False
        _mark_ends(work, s)
        if not _point_is_safe(model, work, s, need, bow):
            return False
    return True


@kernel
def _mark_ends(work: Work, s: int) -> None:
    """Copy both ends of the way of point s to where its pieces are."""
    way, start, end = work.way, work.start, work.end
    for d in range(3):
        way.points[0, s, d] = start.points[0, s, d]
        way.points[PIECES, s, d] = end.points[0, s, d]
    way.clearance[0], way.clearance[PIECES] = start.clearance[0, s], end.clearance[0, s]


@kernel
def _point_is_safe(model: Model, work: Work, s: int, need: float, bow: float) -> bool:
    """Judge the way of one body point, cutting it into pieces where it has to be.

    Clearance changes no faster than the point moves: at x on a chord it is at least what one end
    has less the way from there, so the mean of both.  Short pieces that this does not settle are
    judged exactly, against every triangle around, if the point is on the free side.
    """
    way, stack, top = work.way, work.way.pieces, 1
    free = need > 0.0 and way.clearance[0] > 0.0
    stack[0, 0], stack[0, 1] = 0, PIECES
    while top > 0:
        top -= 1
        first, last = stack[top, 0], stack[top, 1]
        bend = bow * ((last - first) / PIECES) ** 2
        chord = 0.0
        for d in range(3):
            chord += (way.points[last, s, d] - way.points[first, s, d]) ** 2
        chord = np.sqrt(chord)
        room = 0.5 * (way.clearance[first] + way.clearance[last] - chord) - bend
        if room >= need:
            continue
        if free and (chord <= SHORT or last - first == 1):
            ends = min(way.clearance[first], way.clearance[last])
            if (bend <= 0.5 * (ends - need) or bend <= FLAT) and _chord_is_clear(
                model, work, s, first, last, need + bend
            ):
                continue
        if last - first == 1:
            return False
        middle = (first + last) // 2
        _place(model, work, middle)
        _measure(model, work, s, middle, need)
        if way.clearance[middle] < need:
            return False
        stack[top, 0], stack[top, 1] = first, middle
        stack[top + 1, 0], stack[top + 1, 1] = middle, last
        top += 2
    return True


@kernel
def _chord_is_clear(
    model: Model, work: Work, s: int, first: int, last: int, distance: float
) -> bool:
    a, b = work.way.points[first, s], work.way.points[last, s]
    return is_clear(
        model.body.zone, a[0], a[1], a[2], b[0], b[1], b[2], distance, work.scratch.stack
    )


@kernel
def _measure(model: Model, work: Work, s: int, k: int, need: float) -> None:
    """Clearance of body point s after k pieces: a lower bound if that is enough, else exact."""
    body, way, scratch = model.body, work.way, work.scratch
    x, y, z = way.points[k, s, 0], way.points[k, s, 1], way.points[k, s, 2]
    cell = cell_of(body.grid, x, y, z)
    bound = at_least(body.grid, cell, x, y, z)
    if 0.0 <= bound < need:
        bound = max(bound, at_least_from_afar(body.grid, cell, x, y, z))
    if bound < need:
        bound = exact(body.zone, body.grid, cell, x, y, z, scratch.stack, scratch.keys)[0]
    way.clearance[k] = bound


@kernel
def _place(model: Model, work: Work, k: int) -> None:
    """Fill the points of the body after k of all pieces of the way."""
    body, start, end, way, scratch = model.body, work.start, work.end, work.way, work.scratch
    if way.ready[k]:
        return
    way.ready[k] = True
    for j in range(way.c.size):
        way.c[j] = start.c[0, j] + k / PIECES * (end.c[0, j] - start.c[0, j])
    chain_kernels.frames(body.chain, body.T_w_b, way.c, scratch.R, scratch.p)
    chain_kernels.points_of(body.chain, way.c, scratch.R, scratch.p, way.points[k])
