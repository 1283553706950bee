"""Compiled least squares of the shape estimate.

They do what LAPACK could, for matrices so small that its threads would only wait for each other.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner, kernel


@inner
def _forward(L: Array, i: int, b: Array) -> float:
    """Element i of the solution of L x = b, whose elements before i stand in b."""
    value = float(b[i])
    for j in range(i):
        value -= L[i, j] * b[j]
    return value / L[i, i]


@kernel
def newton(H: Array, left: Array, z: Array, L: Array, step: Array) -> None:
    """One step of Gauss-Newton for the least |z|^2 + |left(z)|^2, with d left / dz = -H.

    Solves (I + H'H) step = H' left - z.

    Arguments:
        H: derivative of what is read (m, r), over the standard deviation of each reading
        left: what is read less what should be (m,), likewise
        z: where it is now (r,)
        L: lower Cholesky factor of I + H'H (r, r), written
        step: (r,), written
    """
    m, r = H.shape
    for i in range(r):
        step[i] = -z[i]
        for j in range(i + 1):
            L[i, j] = 1.0 if i == j else 0.0
    for k in range(m):
        for i in range(r):
            step[i] += H[k, i] * left[k]
            for j in range(i + 1):
                L[i, j] += H[k, i] * H[k, j]
    for i in range(r):
        for j in range(i):
            L[i, j] = _forward(L, j, L[i])
            L[i, i] -= L[i, j] ** 2
        L[i, i] = np.sqrt(L[i, i])
    for i in range(r):
        step[i] = _forward(L, i, step)
    for i in range(r - 1, -1, -1):
        step[i] /= L[i, i]
        for j in range(i):
            step[j] -= L[i, j] * step[i]


@kernel
def covariance(L: Array, slope: Array, out: Array) -> None:
    """Covariance (S, 3, 3) of points with the derivative slope (S, 3, r), given the factor L.

    The unknowns have the covariance (L L')^-1, so it is V'V with L V = slope'.
    """
    r = len(L)
    V = np.empty((3, r))
    for s in range(len(slope)):
        for a in range(3):
            for i in range(r):
                V[a, i] = slope[s, a, i]
                V[a, i] = _forward(L, i, V[a])
            for b in range(a + 1):
                product = 0.0
                for i in range(r):
                    product += V[a, i] * V[b, i]
                out[s, a, b], out[s, b, a] = product, product
