"""Hard rows of the QP: what actuators, and the tip, can do."""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.data import (
    RATE_LIMIT,
    STATE_LIMIT,
    TIP_SPEED,
    Limits,
    Model,
    Motion,
    Problem,
    Scratch,
    Shape,
)
from sinuous.control.step.rows import (
    FIRST,
    INCREMENT,
    KIND,
    LAST,
    LOWER,
    PRICE,
    STAGE,
    STATE,
    UPPER,
    Rows,
)
from sinuous.robots.routing import length_gradient, length_of


@kernel
def limited(limits: Limits, k: int, c: Array) -> float:
    """Value of limit k at one configuration (n,): a length, or a coordinate."""
    P = limits.slowest.size
    return length_of(limits.routing, k, c) if k < P else float(c[limits.own[k - P]])


@kernel
def hard_rows(
    model: Model, start: Array, old: Shape, motion: Motion, problem: Problem, scratch: Scratch
) -> int:
    """Limits of every stage and of the increment that leads to it; returns their number."""
    limits, scale, rows, meaning = model.limits, model.scale, problem.rows, problem.meaning
    K, P, n, count = limits.low.size, limits.slowest.size, start.size, 0
    step = scale.step
    for i in range(old.c.shape[0]):
        for k in range(K):
            now, predicted = limited(limits, k, start), limited(limits, k, old.c[i])
            # A prediction that is out of limits by rounding must not make this infeasible.
            low, high = min(limits.low[k] - predicted, 0.0), max(limits.high[k] - predicted, 0.0)
            if k < P:
                # What the rates cannot reach by then is no condition.
                if now + (i + 1) * limits.slowest[k] >= limits.low[k]:
                    low = -np.inf
                if now + (i + 1) * limits.fastest[k] <= limits.high[k]:
                    high = np.inf
                low, high = max(low, -limits.trust), min(high, limits.trust)
            if np.isfinite(low) or np.isfinite(high):
                _write_limit(model, rows, count, k, old.c[i], scratch.row)
                rows.bound[count, LOWER], rows.bound[count, UPPER] = low / step, high / step
                rows.place[count, STAGE], rows.place[count, KIND] = i, STATE
                near = low > -limits.trust or high < limits.trust
                meaning.what[count], meaning.index[count] = STATE_LIMIT, k if near else -1
                count += 1
        for k in range(P):
            before = old.c[i - 1] if i > 0 else start
            moved = limited(limits, k, old.c[i]) - limited(limits, k, before)
            _write_limit(model, rows, count, k, old.c[i], scratch.row)
            # The prediction itself stays allowed when it is out of limits by rounding.
            rows.bound[count, LOWER] = min(limits.slowest[k] - moved, 0.0) / step
            rows.bound[count, UPPER] = max(limits.fastest[k] - moved, 0.0) / step
            rows.place[count, STAGE], rows.place[count, KIND] = i, INCREMENT
            meaning.what[count], meaning.index[count] = RATE_LIMIT, k
            count += 1
        if np.isfinite(limits.tip_step):
            for d in range(3):
                moved = 0.0
                for j in range(n):
                    for m in range(n):
                        since = old.c[i - 1, m] if i > 0 else start[m]
                        moved += motion.tip[i, d, j] * scale.metric[j, m] * (old.c[i, m] - since)
                for j in range(n):
                    rows.a[count, j] = motion.tip[i, d, j] / step
                rows.place[count, FIRST], rows.place[count, LAST] = 0, n
                moved /= step
                rows.bound[count, LOWER] = min(-limits.tip_step - moved, 0.0) / step
                rows.bound[count, UPPER] = max(limits.tip_step - moved, 0.0) / step
                rows.place[count, STAGE], rows.place[count, KIND] = i, INCREMENT
                meaning.what[count], meaning.index[count] = TIP_SPEED, d
                count += 1
    for k in range(count):
        rows.bound[k, PRICE] = np.inf
        meaning.slot[k], meaning.size[k] = -1, 1.0
    return count


@kernel
def _write_limit(model: Model, rows: Rows, count: int, k: int, c: Array, row: Array) -> None:
    """Write the derivative of limit k at c, in y; it is everywhere the same but for joints."""
    limits, scale = model.limits, model.scale
    first, last = limits.first[k], limits.last[k]
    if limits.routing.column.size == 0 or k >= limits.slowest.size:
        for j in range(first, last):
            rows.a[count, j] = limits.scaled[k, j]
    else:
        length_gradient(limits.routing, k, c, row)
        for j in range(first, last):
            total = 0.0
            for m in range(row.size):
                total += row[m] * scale.inverse[m, j]
            rows.a[count, j] = total
    rows.place[count, FIRST], rows.place[count, LAST] = first, last
