"""Eigenvalues and eigenvectors of small symmetric matrices, compiled and without allocation.

For the ten or so coordinates of a stage this takes half of what LAPACK takes by the time it is
called.  Householder reflections make the matrix tridiagonal, QL iterations with implicit shifts
make it diagonal.

Source: Golub and Van Loan, Matrix Computations (2013), 8.3.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner

SWEEPS = 60  # of QL for one eigenvalue; two or three suffice


@inner
def decompose(V: Array, d: Array, e: Array) -> bool:
    """Replace the symmetric matrix V (n, n) by its eigenvectors, columns; eigenvalues d (n,).

    Arguments:
        e: scratch (n,)

    Returns whether it converged; numbers that are not finite do not.
    """
    _tridiagonal(V, d, e)
    return _diagonal(V, d, e)


@inner
def _tridiagonal(V: Array, d: Array, e: Array) -> None:
    """V' A V = tridiagonal with diagonal d and subdiagonal e[1:], A given in V."""
    n = d.size
    for i in range(n - 1, 0, -1):
        # Reflect row i, left of the diagonal, onto its last entry; d holds the reflector.
        h = 0.0
        for k in range(i - 1):
            h += V[i, k] * V[i, k]
        last = V[i, i - 1]
        if h == 0.0:
            e[i], d[i] = last, 0.0
            continue
        g = np.sqrt(h + last * last)
        g = -g if last > 0.0 else g
        e[i] = g
        V[i, i - 1] = last - g
        h = h + last * last - last * g  # half the squared length of the reflector
        d[i] = h
        total = 0.0
        for j in range(i):
            V[j, i] = V[i, j] / h  # kept for the transformation
            g = 0.0
            for k in range(j + 1):
                g += V[j, k] * V[i, k]
            for k in range(j + 1, i):
                g += V[k, j] * V[i, k]
            e[j] = g / h
            total += e[j] * V[i, j]
        half = total / (h + h)
        for j in range(i):
            u = V[i, j]
            e[j] -= half * u
            for k in range(j + 1):
                V[j, k] -= u * e[k] + e[j] * V[i, k]
    d[0], e[0] = 0.0, 0.0
    for i in range(n):
        if d[i] != 0.0:
            for j in range(i):
                g = 0.0
                for k in range(i):
                    g += V[i, k] * V[k, j]
                for k in range(i):
                    V[k, j] -= g * V[k, i]
        d[i] = V[i, i]
        V[i, i] = 1.0
        for k in range(i):
            V[i, k], V[k, i] = 0.0, 0.0


@inner
def _diagonal(V: Array, d: Array, e: Array) -> bool:
    n = d.size
    for i in range(1, n):
        e[i - 1] = e[i]
    e[n - 1] = 0.0
    for first in range(n):
        for sweep in range(SWEEPS + 1):
            m = first
            while m < n - 1:
                near = abs(d[m]) + abs(d[m + 1])
                if abs(e[m]) <= 1e-16 * near:
                    break
                m += 1
            if m == first:
                break
            if sweep == SWEEPS:
                return False
            # The eigenvalue of the leading two by two block that is nearer to its corner.
            g = (d[first + 1] - d[first]) / (2.0 * e[first])
            r = np.sqrt(g * g + 1.0)
            g = d[m] - d[first] + e[first] / (g + (r if g >= 0.0 else -r))
            s, c, p = 1.0, 1.0, 0.0
            for i in range(m - 1, first - 1, -1):
                f, b = s * e[i], c * e[i]
                r = np.sqrt(f * f + g * g)
                e[i + 1] = r
                if r == 0.0:
                    d[i + 1] -= p
                    e[m] = 0.0
                    break
                s, c = f / r, g / r
                g = d[i + 1] - p
                r = (d[i] - g) * s + 2.0 * c * b
                p = s * r
                d[i + 1] = g + p
                g = c * r - b
                for k in range(n):
                    f = V[k, i + 1]
                    V[k, i + 1] = s * V[k, i] + c * f
                    V[k, i] = c * V[k, i] - s * f
            else:
                d[first] -= p
                e[first] = g
                e[m] = 0.0
    return True
