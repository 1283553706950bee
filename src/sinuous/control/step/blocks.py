"""Factor and solve symmetric block-tridiagonal systems: one block per stage of the horizon."""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner

# A pivot below this share of its block's largest entry is lifted to it: the direction has no
# curvature but rounding, and must not become a division by zero.
PIVOT = 1e-13


@inner
def factor(D: Array, C: Array) -> None:
    """Factor in place: D becomes L of every block, its diagonal reciprocal; C becomes L^-1 C.

    Arguments:
        D: diagonal blocks (N, n, n), the lower triangles are read
        C: C[i] couples stage i - 1 with stage i (N, n, n); C[0] is not used
    """
    N, n = D.shape[0], D.shape[1]
    for i in range(N):
        if i > 0:
            for r in range(n):
                for k in range(r):
                    for j in range(n):
                        C[i, r, j] -= D[i - 1, r, k] * C[i, k, j]
                for j in range(n):
                    C[i, r, j] *= D[i - 1, r, r]
            for k in range(n):
                for r in range(n):
                    for j in range(r + 1):
                        D[i, r, j] -= C[i, k, r] * C[i, k, j]
        _cholesky(D, i)


@inner
def _cholesky(D: Array, i: int) -> None:
    n, largest = D.shape[1], 0.0
    for r in range(n):
        largest = max(largest, abs(D[i, r, r]))
    floor = PIVOT * largest + 1e-300
    for r in range(n):
        for j in range(r):
            total = D[i, r, j]
            for k in range(j):
                total -= D[i, r, k] * D[i, j, k]
            D[i, r, j] = total * D[i, j, j]
        total = D[i, r, r]
        for k in range(r):
            total -= D[i, r, k] * D[i, r, k]
        D[i, r, r] = 1.0 / np.sqrt(max(total, floor))


@inner
def solve(L: Array, C: Array, x: Array) -> None:
    """Solve in place for the right-hand side x (N, n), with what `factor` left."""
    N, n = x.shape
    for i in range(N):
        for r in range(n):
            total = x[i, r]
            if i > 0:
                for k in range(n):
                    total -= C[i, k, r] * x[i - 1, k]
            for k in range(r):
                total -= L[i, r, k] * x[i, k]
            x[i, r] = total * L[i, r, r]
    for i in range(N - 1, -1, -1):
        if i + 1 < N:
            for r in range(n):
                total = x[i, r]
                for k in range(n):
                    total -= C[i + 1, r, k] * x[i + 1, k]
                x[i, r] = total
        for r in range(n - 1, -1, -1):
            total = x[i, r]
            for k in range(r + 1, n):
                total -= L[i, k, r] * x[i, k]
            x[i, r] = total * L[i, r, r]
