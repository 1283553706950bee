"""The quadratic program of a step as plain matrices: to print it, or to solve it elsewhere."""

from dataclasses import dataclass
from typing import Self

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.control.step import rows
from sinuous.control.step.step import FirstProblem


@dataclass(frozen=True, kw_only=True, eq=False)
class DenseProblem:
    """minimise 1/2 y'H y + f'y with lower <= A y <= upper.

    y are changes of the actuators from their prediction, stage by stage, counted in the largest
    step.  The lower side of a row with a finite price may be violated by s at the cost price s.

    Arguments:
        H, f: (N n, N n), (N n,)
        A: (m, N n)
        lower, upper, price: (m,)
        what, index: what the rows stand for, see `step.data.Meaning` (m,)
    """

    H: Array
    f: Array
    A: Array
    lower: Array
    upper: Array
    price: Array
    what: IntArray
    index: IntArray

    @classmethod
    def of(cls, first: FirstProblem) -> Self:
        """Spread out the structured problem."""
        N, n = first.f.shape
        increments = np.eye(N * n) - np.eye(N * n, k=-n)
        H = increments.T @ np.kron(np.eye(N), first.E) @ increments
        for i in range(N):
            H[i * n : (i + 1) * n, i * n : (i + 1) * n] += first.H[i]
        count = first.total
        A = np.zeros((count, N, n))
        for k in range(count):
            i = first.place[k, rows.STAGE]
            A[k, i] = first.a[k]
            if first.place[k, rows.KIND] == rows.INCREMENT and i > 0:
                A[k, i - 1] = -first.a[k]
        return cls(
            H=H,
            f=first.f.ravel().copy(),
            A=A.reshape(count, N * n),
            lower=first.bound[:count, rows.LOWER].copy(),
            upper=first.bound[:count, rows.UPPER].copy(),
            price=first.bound[:count, rows.PRICE].copy(),
            what=first.what[:count].copy(),
            index=first.which[:count].copy(),
        )
