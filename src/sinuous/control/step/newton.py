"""The parts of an iteration of `interior`: residuals, Newton's matrix and direction, step."""

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner
from sinuous.control.step import blocks
from sinuous.control.step.rows import (
    FIRST,
    KIND,
    LAST,
    LOWER,
    PER_HIGH,
    PER_LOW,
    PRICE,
    STAGE,
    UPPER,
    VALUE,
)

FIRST_SLACK = 0.06  # least slack that a row starts with [actuator steps]
FIRST_PRODUCT = 0.15  # of slack and multiplier at the start, per unit of the gradient


@inner
def start(
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
def gradient(
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
def residual(bound: Array, count: int, now: Array, row: Array) -> tuple[float, float, float]:
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
def matrix(
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
def aim(count: int, now: Array, move: Array, xi: Array, mu: float, correction: float) -> None:
    """Aim at products of mu, and correct for a share of what the last direction adds to them."""
    for k in range(count):
        xi[k, 0] = mu - now[k, 0] * now[k, 1]
        xi[k, 1] = mu - now[k, 2] * now[k, 3]
        if correction > 0.0:
            xi[k, 0] -= correction * move[k, 0] * move[k, 1]
            xi[k, 1] -= correction * move[k, 2] * move[k, 3]


@inner
def direction(
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
def share(count: int, now: Array, move: Array) -> float:
    """Largest share of the direction that keeps slacks and multipliers from turning negative."""
    share = 1.0
    for k in range(count):
        for j in range(4):
            if now[k, j] + share * move[k, j] < 0.0:
                share = -now[k, j] / move[k, j]
    return share


@inner
def products_after(count: int, now: Array, move: Array, share: float) -> float:
    """Sum of the products after a share of the direction."""
    total = 0.0
    for k in range(count):
        total += (now[k, 0] + share * move[k, 0]) * (now[k, 1] + share * move[k, 1])
        total += (now[k, 2] + share * move[k, 2]) * (now[k, 3] + share * move[k, 3])
    return total


@inner
def move(
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
