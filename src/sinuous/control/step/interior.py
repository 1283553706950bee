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
from sinuous.compiled import inner, kernel
from sinuous.control.step import blocks
from sinuous.control.step.clock import seconds
from sinuous.records import record

SOLVED, UNFINISHED, NOT_FINITE, OUT_OF_TIME = 0, 1, 2, 3

ITERATIONS = 40  # gives up after so many; ten suffice as a rule
RESIDUAL = 1e-9  # of the rows [actuator steps]
STATIONARY = 1e-7  # of the gradient, relative to its size at the start and the multipliers
ROUNDED = 1e-5  # the same where it falls no more
GAP = 1e-8  # mean product of slack and multiplier, in the same units
TO_BOUNDARY, CLOSEST = 0.995, 0.9999  # share of the way to the boundary that is taken
ENOUGH = 0.3  # of that mean is aimed at; less would only spoil the numbers
STUCK, CENTRE = 0.5, 0.9  # a shorter share is none: even the products out first, to this much
FIRST_SLACK = 0.06  # least slack that a row starts with [actuator steps]
FIRST_PRODUCT = 0.15  # of slack and multiplier at the start, per unit of the gradient

STATE, INCREMENT = 0, 1  # what a row acts on: y or v of its stage


@record
class Rows:
    """Rows of the QP; the first so many count.

    Arguments:
        a: coefficients (m, n)
        place: FIRST and one past the LAST coefficient that is not zero, STAGE, and KIND: whether
            the row acts on y (STATE) or v (INCREMENT) of its stage (m, 4)
        bound: LOWER and UPPER, infinite where there is no condition, and the PRICE of a violation
            of the lower side, infinite for a hard row; a soft row has no upper side (m, 3)
    """

    a: Array
    place: IntArray
    bound: Array


FIRST, LAST, STAGE, KIND = 0, 1, 2, 3
LOWER, UPPER, PRICE = 0, 1, 2


@record
class Pairs:
    """Slacks and multipliers of m rows.

    They belong to the lower and the upper side of a row; in a soft row the second pair is the
    violation and what is left of the price.

    Arguments:
        now: slack and multiplier of the first pair, then of the second (m, 4)
        way: their direction (m, 4)
        xi: what the two products are to change by (m, 2)
    """

    now: Array
    way: Array
    xi: Array


@record
class Iterate:
    """Where the method is, and its scratch; N stages of n variables.

    Arguments:
        y, dy, gradient: (N, n)
        at, way: y and v, dy and dv (2, N, n)
        row: value of every row, and the reciprocals of its slacks in the Newton matrix (m, 3)
        S: weighted squares of the rows of both kinds (2, N, n, n)
        D, C: the Newton matrix (N, n, n)
    """

    y: Array
    dy: Array
    gradient: Array
    at: Array
    way: Array
    row: Array
    S: Array
    D: Array
    C: Array


VALUE, PER_LOW, PER_HIGH = 0, 1, 2


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
    size, sides = _start(f, bound, count, now, y, row)
    before = np.inf
    for iteration in range(ITERATIONS):
        worst = _gradient(H, E, f, a, place, bound, count, now, y, at, way, gradient)
        error, total, strongest = _residual(bound, count, now, row)
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
        _newton_matrix(H, E, a, place, bound, count, now, row, S, D, C)
        blocks.factor(D, C)
        _aim(count, now, move, xi, 0.0, 0.0)
        _direction(a, place, bound, count, now, move, xi, row, gradient, way, D, C, dy)
        share = _share(count, now, move)
        after = _products_after(count, now, move, share) / sides
        # A predictor that gets nowhere says little about the products: correct it by as much less.
        aim = max(after * (after / mu) ** 2, ENOUGH * GAP * scale)
        _aim(count, now, move, xi, aim, share)
        _direction(a, place, bound, count, now, move, xi, row, gradient, way, D, C, dy)
        share = _share(count, now, move)
        if share < STUCK:
            _aim(count, now, move, xi, CENTRE * mu, 0.0)
            _direction(a, place, bound, count, now, move, xi, row, gradient, way, D, C, dy)
            share = _share(count, now, move)
        keep = max(TO_BOUNDARY, min(CLOSEST, 1.0 - mu / scale))
        _move(a, place, count, now, move, way, row, dy, y, min(1.0, keep * share))
    return UNFINISHED, ITERATIONS


@inner
def _start(
    f: Array, bound: Array, count: int, now: Array, y: Array, row: Array
) -> tuple[float, int]:
    """Stand still with room at every row; returns the size of the gradient, and the sides.

    Sides without a condition have a slack of one and no multiplier, for ever.
    """
    size, sides = 1.0, 1
    for i in range(f.shape[0]):
        for j in range(f.shape[1]):
            y[i, j] = 0.0
            size = max(size, abs(f[i, j]))
    product = FIRST_PRODUCT * size
    for k in range(count):
        low, high, z_low, z_high = 1.0, 1.0, 0.0, 0.0
        lower, upper, price = bound[k, LOWER], bound[k, UPPER], bound[k, PRICE]
        if np.isfinite(price):
            high = max(FIRST_SLACK, lower + FIRST_SLACK)
            low = high - lower
            z_low = min(product / low, 0.5 * price)
            z_high = price - z_low
            sides += 2
        else:
            if np.isfinite(lower):
                low = max(-lower, FIRST_SLACK)
                z_low = product / low
                sides += 1
            if np.isfinite(upper):
                high = max(upper, FIRST_SLACK)
                z_high = product / high
                sides += 1
            if np.isnan(lower) or np.isnan(upper):
                low = np.nan
        now[k, 0], now[k, 1], now[k, 2], now[k, 3] = low, z_low, high, z_high
        row[k, VALUE] = 0.0
    return size, sides


@inner
def _differences(y: Array, out: Array) -> None:
    """out[0] = y, out[1] = its increments from stage to stage."""
    for i in range(y.shape[0]):
        for j in range(y.shape[1]):
            out[0, i, j] = y[i, j]
            out[1, i, j] = y[i, j] - (y[i - 1, j] if i > 0 else 0.0)


@inner
def _collect(parts: Array, out: Array) -> None:
    """Add up what acts on y and on v: the transpose of `_differences`."""
    N = out.shape[0]
    for i in range(N):
        for j in range(out.shape[1]):
            after = parts[1, i + 1, j] if i + 1 < N else 0.0
            out[i, j] += parts[0, i, j] + parts[1, i, j] - after


@inner
def _gradient(
    H: Array,
    E: Array,
    f: Array,
    a: Array,
    place: IntArray,
    bound: Array,
    count: int,
    now: Array,
    y: Array,
    at: Array,
    way: Array,
    gradient: Array,
) -> float:
    """Gradient of the Lagrangian; returns its largest entry, nan if any is not a number."""
    _differences(y, at)
    N, n = gradient.shape
    for i in range(N):
        for r in range(n):
            state, increment = f[i, r], 0.0
            for j in range(n):
                state += H[i, r, j] * at[0, i, j]
                increment += E[r, j] * at[1, i, j]
            way[0, i, r], way[1, i, r] = state, increment
            gradient[i, r] = 0.0
    for k in range(count):
        push = -now[k, 1] if np.isfinite(bound[k, PRICE]) else now[k, 3] - now[k, 1]
        kind, i = place[k, KIND], place[k, STAGE]
        for j in range(place[k, FIRST], place[k, LAST]):
            way[kind, i, j] += push * a[k, j]
    _collect(way, gradient)
    worst, total = 0.0, 0.0
    for i in range(N):
        for r in range(n):
            total += abs(gradient[i, r])
            worst = max(worst, abs(gradient[i, r]))
    return worst if np.isfinite(total) else np.nan


@inner
def _residual(bound: Array, count: int, now: Array, row: Array) -> tuple[float, float, float]:
    """Largest error of a hard row's slack, sum of all products, largest multiplier.

    The sum is not a number if any row is not.
    """
    worst, total, strongest = 0.0, 0.0, 0.0
    for k in range(count):
        total += now[k, 0] * now[k, 1] + now[k, 2] * now[k, 3] + 0.0 * row[k, VALUE]
        strongest = max(strongest, now[k, 1])
        if np.isfinite(bound[k, PRICE]):
            continue
        strongest = max(strongest, now[k, 3])
        if np.isfinite(bound[k, LOWER]):
            worst = max(worst, abs(row[k, VALUE] - bound[k, LOWER] - now[k, 0]))
        if np.isfinite(bound[k, UPPER]):
            worst = max(worst, abs(bound[k, UPPER] - row[k, VALUE] - now[k, 2]))
    return worst, total, strongest


@inner
def _newton_matrix(
    H: Array,
    E: Array,
    a: Array,
    place: IntArray,
    bound: Array,
    count: int,
    now: Array,
    row: Array,
    S: Array,
    D: Array,
    C: Array,
) -> None:
    """Blocks of the Newton matrix, and the reciprocals of the slacks in it.

    A soft row has more slack than it shows: it can be bought.  Its second reciprocal is that of
    what is left of the price.
    """
    N, n = D.shape[0], D.shape[1]
    S[:] = 0.0
    for k in range(count):
        if np.isfinite(bound[k, PRICE]):
            per_high = 1.0 / now[k, 3]
            per_low = 1.0 / (now[k, 0] + now[k, 1] * now[k, 2] * per_high)
            total = now[k, 1] * per_low
        else:
            per_low, per_high = 1.0 / now[k, 0], 1.0 / now[k, 2]
            total = now[k, 1] * per_low + now[k, 3] * per_high
        row[k, PER_LOW], row[k, PER_HIGH] = per_low, per_high
        kind, i, start = place[k, KIND], place[k, STAGE], place[k, FIRST]
        for r in range(start, place[k, LAST]):
            scaled = total * a[k, r]
            for j in range(start, r + 1):
                S[kind, i, r, j] += scaled * a[k, j]
    for i in range(N):
        for r in range(n):
            for j in range(r + 1):
                coupling = E[r, j] + S[1, i, r, j]
                after = E[r, j] + S[1, i + 1, r, j] if i + 1 < N else 0.0
                D[i, r, j] = H[i, r, j] + S[0, i, r, j] + coupling + after
                C[i, r, j] = -coupling
                C[i, j, r] = -coupling


@inner
def _aim(count: int, now: Array, move: Array, xi: Array, mu: float, correction: float) -> None:
    """Aim at products of mu, and correct for a share of what the last direction adds to them."""
    for k in range(count):
        xi[k, 0] = mu - now[k, 0] * now[k, 1]
        xi[k, 1] = mu - now[k, 2] * now[k, 3]
        if correction > 0.0:
            xi[k, 0] -= correction * move[k, 0] * move[k, 1]
            xi[k, 1] -= correction * move[k, 2] * move[k, 3]


@inner
def _direction(
    a: Array,
    place: IntArray,
    bound: Array,
    count: int,
    now: Array,
    move: Array,
    xi: Array,
    row: Array,
    gradient: Array,
    way: Array,
    D: Array,
    C: Array,
    dy: Array,
) -> None:
    """Newton direction of y, slacks and multipliers that changes the products by xi."""
    way[:] = 0.0
    for i in range(dy.shape[0]):
        for j in range(dy.shape[1]):
            dy[i, j] = -gradient[i, j]
    for k in range(count):
        per_low, per_high = row[k, PER_LOW], row[k, PER_HIGH]
        if np.isfinite(bound[k, PRICE]):
            push = (xi[k, 0] - now[k, 1] * xi[k, 1] * per_high) * per_low
        else:
            push = 0.0
            if np.isfinite(bound[k, LOWER]):
                error = row[k, VALUE] - bound[k, LOWER] - now[k, 0]
                push += (xi[k, 0] - now[k, 1] * error) * per_low
            if np.isfinite(bound[k, UPPER]):
                error = bound[k, UPPER] - row[k, VALUE] - now[k, 2]
                push -= (xi[k, 1] - now[k, 3] * error) * per_high
        kind, i = place[k, KIND], place[k, STAGE]
        for j in range(place[k, FIRST], place[k, LAST]):
            way[kind, i, j] += push * a[k, j]
    _collect(way, dy)
    blocks.solve(D, C, dy)
    _differences(dy, way)
    for k in range(count):
        kind, i, moved = place[k, KIND], place[k, STAGE], 0.0
        for j in range(place[k, FIRST], place[k, LAST]):
            moved += a[k, j] * way[kind, i, j]
        d_low, dz_low, d_high, dz_high = 0.0, 0.0, 0.0, 0.0
        per_low, per_high = row[k, PER_LOW], row[k, PER_HIGH]
        if np.isfinite(bound[k, PRICE]):
            dz_low = (xi[k, 0] - now[k, 1] * (moved + xi[k, 1] * per_high)) * per_low
            dz_high = -dz_low
            d_high = (xi[k, 1] + now[k, 2] * dz_low) * per_high
            d_low = moved + d_high
        else:
            if np.isfinite(bound[k, LOWER]):
                d_low = moved + row[k, VALUE] - bound[k, LOWER] - now[k, 0]
                dz_low = (xi[k, 0] - now[k, 1] * d_low) * per_low
            if np.isfinite(bound[k, UPPER]):
                d_high = bound[k, UPPER] - row[k, VALUE] - now[k, 2] - moved
                dz_high = (xi[k, 1] - now[k, 3] * d_high) * per_high
        move[k, 0], move[k, 1], move[k, 2], move[k, 3] = d_low, dz_low, d_high, dz_high


@inner
def _share(count: int, now: Array, move: Array) -> float:
    """Largest share of the direction that keeps slacks and multipliers from turning negative."""
    share = 1.0
    for k in range(count):
        for j in range(4):
            if now[k, j] + share * move[k, j] < 0.0:
                share = -now[k, j] / move[k, j]
    return share


@inner
def _products_after(count: int, now: Array, move: Array, share: float) -> float:
    """Sum of the products after a share of the direction."""
    total = 0.0
    for k in range(count):
        total += (now[k, 0] + share * move[k, 0]) * (now[k, 1] + share * move[k, 1])
        total += (now[k, 2] + share * move[k, 2]) * (now[k, 3] + share * move[k, 3])
    return total


@inner
def _move(
    a: Array,
    place: IntArray,
    count: int,
    now: Array,
    move: Array,
    way: Array,
    row: Array,
    dy: Array,
    y: Array,
    share: float,
) -> None:
    for i in range(y.shape[0]):
        for j in range(y.shape[1]):
            y[i, j] += share * dy[i, j]
    for k in range(count):
        kind, i, moved = place[k, KIND], place[k, STAGE], 0.0
        for j in range(place[k, FIRST], place[k, LAST]):
            moved += a[k, j] * way[kind, i, j]
        row[k, VALUE] += share * moved
        for j in range(4):
            now[k, j] += share * move[k, j]


@kernel
def new_iterate(m: int, N: int, n: int) -> Iterate:
    """Scratch for m rows and N stages of n variables."""
    return Iterate(
        np.zeros((N, n)),
        np.zeros((N, n)),
        np.zeros((N, n)),
        np.zeros((2, N, n)),
        np.zeros((2, N, n)),
        np.zeros((m, 3)),
        np.zeros((2, N, n, n)),
        np.zeros((N, n, n)),
        np.zeros((N, n, n)),
    )


@kernel
def new_pairs(m: int) -> Pairs:
    """Slacks and multipliers of m rows."""
    return Pairs(np.zeros((m, 4)), np.zeros((m, 4)), np.zeros((m, 2)))


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
