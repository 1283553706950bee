"""The conditions of the QP of one step, and where its solver is: records of arrays."""

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel
from sinuous.records import record

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
