"""How cables run along a robot: their lengths and the derivative, for any chain.

An actuator's length is affine in the configuration, plus one straight stretch for every
universal joint that it crosses, from its hole in the plate before to its hole in the plate after:

    l_k = A_k c + b_k + sum_x |before_x + Rot(e1, q1) Rot(e2, q2) after_x|,

with `before` from the hole to the joint's centre and `after` from there to the next hole (paper A
eq. 5, 6).  Robots of constant-curvature segments cross no joints.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner, kernel


class Routing(NamedTuple):
    """Cables as plain arrays: what compiled controllers read."""

    A: Array  # (P, n)
    b: Array  # (P,) [m]
    first: IntArray  # (P + 1,) cable k has the crossings first[k] to first[k + 1]
    column: IntArray  # (X,) of the joint's first angle; the second follows
    axes: IntArray  # (X, 2) about which coordinate axis each angle turns, 0 to 2
    before: Array  # (X, 3) [m]
    after: Array  # (X, 3) [m]


def affine(A: Array, b: Array) -> Routing:
    """Lengths A c + b [m], without any joint."""
    none = np.zeros((0, 3))
    return Routing(
        A=np.ascontiguousarray(A, dtype=np.float64),
        b=np.ascontiguousarray(b, dtype=np.float64),
        first=np.zeros(len(b) + 1, dtype=np.int64),
        column=np.zeros(0, dtype=np.int64),
        axes=np.zeros((0, 2), dtype=np.int64),
        before=none,
        after=none,
    )


@inner
def crossing(routing: Routing, x: int, c: Array) -> tuple[float, float, float]:
    """Length [m] of a stretch, and its derivatives by the two angles of its joint."""
    first, second = float(c[routing.column[x]]), float(c[routing.column[x] + 1])
    return stretch(routing, x, np.sin(first), np.cos(first), np.sin(second), np.cos(second))


@inner
def stretch(
    routing: Routing, x: int, sine1: float, cosine1: float, sine2: float, cosine2: float
) -> tuple[float, float, float]:
    """The same, given sine and cosine of both angles."""
    first, second = routing.axes[x, 0], routing.axes[x, 1]
    u, v, w = routing.after[x, 0], routing.after[x, 1], routing.after[x, 2]
    u, v, w = turned(second, sine2, cosine2, u, v, w)
    px, py, pz = turned(first, sine1, cosine1, u, v, w)
    sx, sy, sz = routing.before[x, 0] + px, routing.before[x, 1] + py, routing.before[x, 2] + pz
    length = np.sqrt(sx * sx + sy * sy + sz * sz)
    # e1 x p, with p after both turns, and Rot(e1, q1) (e2 x u), with u after the second alone.
    ax, ay, az = _across(first, px, py, pz)
    u, v, w = _across(second, u, v, w)
    bx, by, bz = turned(first, sine1, cosine1, u, v, w)
    inverse = 1.0 / length if length > 0.0 else 0.0
    return (
        length,
        inverse * (sx * ax + sy * ay + sz * az),
        inverse * (sx * bx + sy * by + sz * bz),
    )


@inner
def turned(
    axis: int, sine: float, cosine: float, x: float, y: float, z: float
) -> tuple[float, float, float]:
    """A vector turned about a coordinate axis by an angle of that sine and cosine."""
    if axis == 0:
        return x, cosine * y - sine * z, sine * y + cosine * z
    if axis == 1:
        return cosine * x + sine * z, y, cosine * z - sine * x
    return cosine * x - sine * y, sine * x + cosine * y, z


@inner
def _across(axis: int, x: float, y: float, z: float) -> tuple[float, float, float]:
    """Unit vector of a coordinate axis times a vector."""
    if axis == 0:
        return 0.0, -z, y
    if axis == 1:
        return z, 0.0, -x
    return -y, x, 0.0


@inner
def length_of(routing: Routing, k: int, c: Array) -> float:
    """Length [m] of actuator k at one configuration (n,)."""
    total = float(routing.b[k])
    for j in range(routing.A.shape[1]):
        total += routing.A[k, j] * c[j]
    for x in range(routing.first[k], routing.first[k + 1]):
        total += crossing(routing, x, c)[0]
    return total


@inner
def length_gradient(routing: Routing, k: int, c: Array, out: Array) -> None:
    """Derivative (n,) of the length of actuator k by the configuration."""
    for j in range(routing.A.shape[1]):
        out[j] = routing.A[k, j]
    for x in range(routing.first[k], routing.first[k + 1]):
        _, by_first, by_second = crossing(routing, x, c)
        out[routing.column[x]] += by_first
        out[routing.column[x] + 1] += by_second


@kernel
def all_lengths(routing: Routing, c: Array, out: Array) -> None:
    """Lengths (P,) [m] of all actuators at one configuration (n,); each angle is turned by once."""
    trig, known = np.empty((c.size, 2)), np.zeros(c.size, np.bool_)
    for x in range(routing.column.size):
        for j in range(routing.column[x], routing.column[x] + 2):
            if not known[j]:
                trig[j, 0], trig[j, 1], known[j] = np.sin(c[j]), np.cos(c[j]), True
    for k in range(routing.b.size):
        total = float(routing.b[k])
        for j in range(routing.A.shape[1]):
            total += routing.A[k, j] * c[j]
        for x in range(routing.first[k], routing.first[k + 1]):
            j = routing.column[x]
            total += stretch(routing, x, trig[j, 0], trig[j, 1], trig[j + 1, 0], trig[j + 1, 1])[0]
        out[k] = total


@kernel
def lengths_batch(routing: Routing, c: Array, out: Array) -> None:
    """Lengths (B, P) [m] of configurations (B, n)."""
    for i in range(c.shape[0]):
        all_lengths(routing, c[i], out[i])


@kernel
def jacobian(routing: Routing, c: Array, out: Array) -> None:
    """Derivative (P, n) of the lengths at one configuration (n,)."""
    for k in range(routing.b.size):
        length_gradient(routing, k, c, out[k])
