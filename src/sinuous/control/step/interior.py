"""A primal-dual interior-point method for the QP of one step, compiled and without allocation.

    minimise    sum_i 1/2 y_i' H_i y_i + f_i' y_i + 1/2 v_i' E v_i,   v_i = y_i - y_{i-1}, y_0 = 0
    subject to  lower_k <= a_k w_k <= upper_k,   w_k = y_i or v_i of the row's stage

A row with a finite price is soft: its lower side may be violated by s >= 0 at price s.  The
stages couple neighbours only, so every Newton system is block tridiagonal and the work grows
linearly with the horizon.

Source: Mehrotra, On the implementation of a primal-dual interior point method, SIAM J. Optim.
2 (1992); Rao, Wright and Rawlings, Application of interior-point methods to model predictive
control, JOTA 99 (1998).
"""

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel
from sinuous.control.step import blocks, newton
from sinuous.control.step.clock import seconds
from sinuous.control.step.rows import (
    KIND,
    LAST,
    LOWER,
    PRICE,
    STAGE,
    UPPER,
    Iterate,
    Pairs,
    Rows,
    new_iterate,
    new_pairs,
)

SOLVED, UNFINISHED, NOT_FINITE, OUT_OF_TIME = 0, 1, 2, 3

ITERATIONS = 40  # gives up after so many; ten suffice as a rule
RESIDUAL = 1e-9  # of the rows [actuator steps]
STATIONARY = 1e-7  # of the gradient, relative to its size at the start and the multipliers
ROUNDED = 1e-5  # the same where it falls no more
GAP = 1e-8  # mean product of slack and multiplier, in the same units
TO_BOUNDARY, CLOSEST = 0.99, 0.999  # share of the way to the boundary that is taken
ENOUGH = 0.3  # of that mean is aimed at; less would only spoil the numbers
PATIENCE, CALM = 20, 0.2  # after so many, products fall to this share at most and uncorrected
STUCK, CENTRE = 0.5, 0.9  # a shorter share is none: even the products out first, to this much


@kernel
def solve(
    H: Array,
    E: Array,
    f: Array,
    rows: Rows,
    count: int,
    pairs: Pairs,
    it: Iterate,
    deadline: float,
) -> tuple[int, int]:
    """Solve from a cold start; returns how it ended and the iterations.

    Arguments:
        H: (N, n, n), positive semi-definite
        E: (n, n), positive definite
        f: (N, n)
        rows, count: the conditions
        pairs: hold the multipliers afterwards
        it: y holds the solution afterwards
        deadline: on `clock.seconds`, infinite for none
    """
    # What is handed to the parts below are arrays: reading them out of a record costs something.
    a, place, bound, now, move, xi = rows.a, rows.place, rows.bound, pairs.now, pairs.way, pairs.xi
    y, dy, gradient, at, way, row = it.y, it.dy, it.gradient, it.at, it.way, it.row
    S, D, C = it.S, it.D, it.C
    size, sides = newton.start(f, bound, count, now, y, row)
    before = np.inf
    for iteration in range(ITERATIONS):
        worst = newton.gradient(H, E, f, a, place, bound, count, now, y, at, way, gradient)
        error, total, strongest = newton.residual(bound, count, now, row)
        mu, scale = total / sides, size + strongest
        if not np.isfinite(worst + error + mu):
            return NOT_FINITE, iteration
        if error <= RESIDUAL and mu <= GAP * scale:
            # Many violated rows leave rounding in the gradient that no iteration removes.
            stalled = worst >= 0.5 * before and worst <= ROUNDED * scale
            if worst <= STATIONARY * scale or stalled:
                return SOLVED, iteration
        before = worst
        if np.isfinite(deadline) and seconds() > deadline:
            return OUT_OF_TIME, iteration
        newton.matrix(H, E, a, place, bound, count, now, row, S, D, C)
        blocks.factor(D, C)
        newton.aim(count, now, move, xi, 0.0, 0.0)
        newton.direction(a, place, bound, count, now, move, xi, row, gradient, way, D, C, dy)
        share = newton.share(count, now, move)
        after = newton.products_after(count, now, move, share) / sides
        # A predictor that gets nowhere says little about the products: correct it by as much less.
        aim, correction = max(after * (after / mu) ** 2, ENOUGH * GAP * scale), share
        if iteration >= PATIENCE:
            aim, correction = max(aim, CALM * mu), 0.0
        newton.aim(count, now, move, xi, aim, correction)
        newton.direction(a, place, bound, count, now, move, xi, row, gradient, way, D, C, dy)
        share = newton.share(count, now, move)
        if share < STUCK:
            newton.aim(count, now, move, xi, CENTRE * mu, 0.0)
            newton.direction(a, place, bound, count, now, move, xi, row, gradient, way, D, C, dy)
            share = newton.share(count, now, move)
        keep = max(TO_BOUNDARY, min(CLOSEST, 1.0 - mu / scale))
        newton.move(a, place, count, now, move, way, row, dy, y, min(1.0, keep * share))
    return UNFINISHED, ITERATIONS


@kernel
def solve_alone(
    H: Array,
    E: Array,
    f: Array,
    a: Array,
    lower: Array,
    upper: Array,
    price: Array,
    stage: IntArray,
    kind: IntArray,
) -> tuple[int, int, Array, Array]:
    """Solve one problem with records of its own; arguments as in `solve` and `Rows`.

    Returns how it ended, the iterations, y (N, n), and the multipliers of both sides (m, 2).
    """
    N, n, m = f.shape[0], f.shape[1], lower.size
    rows = Rows(a, np.zeros((m, 4), np.int64), np.zeros((m, 3)))
    for k in range(m):
        rows.place[k, LAST], rows.place[k, STAGE], rows.place[k, KIND] = n, stage[k], kind[k]
        rows.bound[k, LOWER], rows.bound[k, UPPER] = lower[k], upper[k]
        rows.bound[k, PRICE] = price[k]
    pairs, it = new_pairs(m), new_iterate(m, N, n)
    status, iterations = solve(H, E, f, rows, m, pairs, it, np.inf)
    multipliers = np.zeros((m, 2))
    for k in range(m):
        multipliers[k, 0] = pairs.now[k, 1]
        multipliers[k, 1] = 0.0 if np.isfinite(price[k]) else pairs.now[k, 3]
    return status, iterations, it.y, multipliers
