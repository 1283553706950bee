"""Hard rows of the QP: what actuators, and the tip, can do."""

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel
from sinuous.control.step.data import (
    RATE_LIMIT,
    STATE_LIMIT,
    TIP_SPEED,
    Meaning,
    Model,
    Motion,
    Problem,
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


@kernel
def hard_rows(model: Model, start: Array, old: Shape, motion: Motion, problem: Problem) -> int:
    """Limits of every stage and of the increment that leads to it; returns their number."""
    limits, scale, rows, meaning = model.limits, model.scale, problem.rows, problem.meaning
    K, P, n, count = limits.low.size, limits.slowest.size, start.size, 0
    step = scale.step
    for i in range(old.c.shape[0]):
        for k in range(K):
            now, predicted = limits.b[k], limits.b[k]
            for j in range(n):
                now += limits.A[k, j] * start[j]
                predicted += limits.A[k, j] * old.c[i, j]
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
                _write_limit(rows, meaning, count, limits.scaled, limits.first, limits.last, k)
                rows.bound[count, LOWER], rows.bound[count, UPPER] = low / step, high / step
                rows.place[count, STAGE], rows.place[count, KIND] = i, STATE
                near = low > -limits.trust or high < limits.trust
                meaning.what[count], meaning.index[count] = STATE_LIMIT, k if near else -1
                count += 1
        for k in range(P):
            moved = 0.0
            for j in range(n):
                before = old.c[i - 1, j] if i > 0 else start[j]
                moved += limits.A[k, j] * (old.c[i, j] - before)
            _write_limit(rows, meaning, count, limits.scaled, limits.first, limits.last, k)
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
                        before = old.c[i - 1, m] if i > 0 else start[m]
                        moved += motion.tip[i, d, j] * scale.metric[j, m] * (old.c[i, m] - before)
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
def _write_limit(
    rows: Rows, meaning: Meaning, count: int, scaled: Array, first: IntArray, last: IntArray, k: int
) -> None:
    for j in range(first[k], last[k]):
        rows.a[count, j] = scaled[k, j]
    rows.place[count, FIRST], rows.place[count, LAST] = first[k], last[k]
