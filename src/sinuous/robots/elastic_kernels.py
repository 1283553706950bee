"""Compiled statics of a robot that elastic cables bend, one motor position after another.

With EI = 1 the bend vectors u (2J,) of J segments make least of

    sum_i u_i^2 / (2 L_i)  +  sum_a k_a max(0, e_a)^2 / 2  +  sum_j f_j |u_j - u_j'|,

where e_a = pull_a - holes_a u is what cable a is stretched by (a slack cable does nothing) and
u' is the bend before: the last sum is Coulomb friction, the variational form of hysteresis.  All
three are convex, so a damped Newton method finds the one minimum.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner, kernel

# Motion [rad] below which friction is elastic: it makes the energy smooth.
_STICTION = 1e-3
# Newton steps below it [rad] end the search; a thousandth of a millimetre at the tip.
_SMALL = 1e-7
_MOST_STEPS = 40
_MOST_HALVINGS = 20
_ARMIJO = 1e-4


class Cables(NamedTuple):
    """What bends and what resists; energies are divided by the bending stiffness EI."""

    holes: Array  # (C, n) by how much a bend shortens the way of each cable [m/rad]
    stiffness: Array  # (C,) of the cables [1/m^3]
    bending: Array  # (n,) of the segments, 1 / length [1/m]
    rest: Array  # (n,) bend without any cable [rad]
    friction: Array  # (J,) moment that holds a segment where it is [1/m]
    play: float  # dead band between motor and cable [m]


@inner
def stretch(cables: Cables, a: int, pull: float, u: Array) -> float:
    """Stretch of one cable [m]; negative: slack."""
    out = pull
    for i in range(u.size):
        out -= float(cables.holes[a, i]) * float(u[i])
    return out


@inner
def _energy(cables: Cables, pull: Array, before: Array, friction: float, u: Array) -> float:
    total = 0.0
    for i in range(u.size):
        total += 0.5 * cables.bending[i] * (u[i] - cables.rest[i]) ** 2
    for a in range(pull.size):
        e = stretch(cables, a, pull[a], u)
        if e > 0.0:
            total += 0.5 * cables.stiffness[a] * e * e
    for j in range(cables.friction.size):
        x, y = u[2 * j] - before[2 * j], u[2 * j + 1] - before[2 * j + 1]
        total += friction * cables.friction[j] * np.sqrt(x * x + y * y + _STICTION**2)
    return total


@inner
def _elastic_terms(cables: Cables, pull: Array, u: Array, gradient: Array, hessian: Array) -> None:
    n = u.size
    for i in range(n):
        gradient[i] = cables.bending[i] * (u[i] - cables.rest[i])
        for k in range(n):
            hessian[i, k] = 0.0
        hessian[i, i] = cables.bending[i]
    for a in range(pull.size):
        e = stretch(cables, a, pull[a], u)
        if e > 0.0:
            for i in range(n):
                force = cables.stiffness[a] * cables.holes[a, i]
                gradient[i] -= force * e
                for k in range(n):
                    hessian[i, k] += force * cables.holes[a, k]


@inner
def _friction_terms(
    cables: Cables, before: Array, friction: float, u: Array, gradient: Array, hessian: Array
) -> None:
    for j in range(cables.friction.size):
        x, y = u[2 * j] - before[2 * j], u[2 * j + 1] - before[2 * j + 1]
        size = np.sqrt(x * x + y * y + _STICTION**2)
        f, x, y = friction * cables.friction[j] / size, x / size, y / size
        gradient[2 * j] += f * x * size
        gradient[2 * j + 1] += f * y * size
        hessian[2 * j, 2 * j] += f * (1.0 - x * x)
        hessian[2 * j + 1, 2 * j + 1] += f * (1.0 - y * y)
        hessian[2 * j, 2 * j + 1] -= f * x * y
        hessian[2 * j + 1, 2 * j] -= f * x * y


@inner
def _forward(A: Array, b: Array) -> None:
    """Overwrite A by its Cholesky factor L, and b by L^-1 b."""
    n = b.size
    for j in range(n):
        for i in range(j, n):
            rest = A[i, j]
            for k in range(j):
                rest -= A[i, k] * A[j, k]
            A[i, j] = np.sqrt(rest) if i == j else rest / A[j, j]
    for i in range(n):
        for k in range(i):
            b[i] -= A[i, k] * b[k]
        b[i] /= A[i, i]


@inner
def _backward(L: Array, b: Array) -> None:
    """Overwrite b by L'^-1 b."""
    n = b.size
    for i in range(n - 1, -1, -1):
        for k in range(i + 1, n):
            b[i] -= L[k, i] * b[k]
        b[i] /= L[i, i]


@inner
def _newton_step(A: Array, gradient: Array) -> float:
    """Overwrite the gradient g by -A^-1 g; return how fast the energy falls along it, g' A^-1 g.

    A is overwritten as well.
    """
    fall = 0.0
    _forward(A, gradient)
    for i in range(gradient.size):
        fall += gradient[i] * gradient[i]
    _backward(A, gradient)
    for i in range(gradient.size):
        gradient[i] = -gradient[i]
    return fall


@inner
def _line_search(
    cables: Cables, pull: Array, before: Array, friction: float, u: Array, step: Array, fall: float
) -> None:
    """Move u along a step, as far as the energy falls."""
    start, share = _energy(cables, pull, before, friction, u), 1.0
    for i in range(u.size):
        u[i] += step[i]
    for _ in range(_MOST_HALVINGS):
        if _energy(cables, pull, before, friction, u) <= start - _ARMIJO * share * fall:
            break
        share *= 0.5
        for i in range(u.size):
            u[i] -= share * step[i]


@inner
def settle(
    cables: Cables, pull: Array, friction: float, u: Array, before: Array, step: Array, A: Array
) -> float:
    """Bring bends u (n,) to rest for cables pulled by `pull` (C,) [m]; return the last step [rad].

    Arguments:
        friction: a factor, 0 for none
        before, step, A: room for (n,), (n,) and (n, n) numbers
    """
    largest = 0.0
    for i in range(u.size):
        before[i] = u[i]
    for _ in range(_MOST_STEPS):
        _elastic_terms(cables, pull, u, step, A)
        _friction_terms(cables, before, friction, u, step, A)
        fall, largest = _newton_step(A, step), 0.0
        for i in range(u.size):
            largest = max(largest, abs(step[i]))
        if largest < _SMALL:
            break
        _line_search(cables, pull, before, friction, u, step, fall)
    return largest


@kernel
def trace(cables: Cables, pulls: Array, follow: Array, u: Array, out: Array) -> None:
    """Bends (T, n) [rad] while the motors pull by (T, C) [m], one row after another.

    Arguments:
        cables: the model
        pulls: of the motors, from where a cable is just taut on the straight robot [m]
        follow: what the cables follow behind the play (C,) [m]; goes on from here
        u: bends to start from (n,) [rad]; goes on from here
        out: filled
    """
    n = u.size
    before, step, A = np.empty(n), np.empty(n), np.empty((n, n))
    for t in range(pulls.shape[0]):
        for a in range(follow.size):
            low, high = pulls[t, a] - 0.5 * cables.play, pulls[t, a] + 0.5 * cables.play
            follow[a] = min(max(follow[a], low), high)
        settle(cables, follow, 1.0, u, before, step, A)
        for i in range(n):
            out[t, i] = u[i]


@kernel
def relax(cables: Cables, pull: Array, u: Array) -> float:
    """Bring bends u (n,) to where they rest without friction; return the last step [rad]."""
    n = u.size
    return settle(cables, pull, 0.0, u, np.empty(n), np.empty(n), np.empty((n, n)))
