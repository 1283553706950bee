"""Compiled configuration of a jointed robot from the lengths of its cables (paper A eq. 8).

Module by module: what the cables of a module are longer than in the joints before, whose angles
are known by then, they are in its own joint.  Three cables, two angles: least squares by
Gauss-Newton with the analytic derivative (notes A4).
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner, kernel
from sinuous.robots.routing import Routing, stretch

CABLES = 3  # of every module
SMALL = 1e-10  # a step of Gauss-Newton that is shorter is the last one [rad]
MOST_STEPS = 30  # it takes 5 for lengths that agree with each other, 8 where plates touch
LONGEST_STEP = 0.5  # [rad]
# What no joint reaches: lengths that make no sense lead no farther, in either angle [rad].
FARTHEST = 0.5 * np.pi


@kernel
def configurations(routing: Routing, lengths: Array, c: Array, residual: Array) -> None:
    """Configurations (B, n) of lengths (B, P), and what the cables are off by.

    The actuators are the stage, if there is one, and the cables of module 1, 2, ..., those of
    module k through the joints 1 to k.

    Arguments:
        residual: root mean square over the cables of every module (B, N) [m]
    """
    joints = residual.shape[1]
    stage = lengths.shape[1] - CABLES * joints
    trig = np.empty((joints, 4))
    for b in range(lengths.shape[0]):
        for k in range(stage):
            c[b, k] = lengths[b, k]
        for j in range(joints):
            residual[b, j] = _solve(routing, stage + CABLES * j, j, lengths[b], trig, c[b])


@inner
def _solve(routing: Routing, k: int, j: int, lengths: Array, trig: Array, c: Array) -> float:
    """Write the angles of joint j, by cable k and the two after it, and their sines and cosines."""
    l1 = _in_own_joint(routing, k, j, lengths, trig)
    l2 = _in_own_joint(routing, k + 1, j, lengths, trig)
    l3 = _in_own_joint(routing, k + 2, j, lengths, trig)
    x1, x2, x3 = routing.first[k] + j, routing.first[k + 1] + j, routing.first[k + 2] + j
    q, p = 0.0, 0.0
    r1, r2, r3 = 0.0, 0.0, 0.0
    for _ in range(MOST_STEPS):
        s, t, u, v = np.sin(q), np.cos(q), np.sin(p), np.cos(p)
        r1, a1, b1 = stretch(routing, x1, s, t, u, v)
        r2, a2, b2 = stretch(routing, x2, s, t, u, v)
        r3, a3, b3 = stretch(routing, x3, s, t, u, v)
        r1, r2, r3 = l1 - r1, l2 - r2, l3 - r3
        dq, dp = _least_squares(a1, a2, a3, b1, b2, b3, r1, r2, r3)
        q_next = min(max(q + dq, -FARTHEST), FARTHEST)
        p_next = min(max(p + dp, -FARTHEST), FARTHEST)
        moved = abs(q_next - q) + abs(p_next - p)
        q, p = q_next, p_next
        if not moved > SMALL:
            break
    trig[j, 0], trig[j, 1], trig[j, 2], trig[j, 3] = np.sin(q), np.cos(q), np.sin(p), np.cos(p)
    c[routing.column[x1]], c[routing.column[x1] + 1] = q, p
    return np.sqrt((r1 * r1 + r2 * r2 + r3 * r3) / CABLES)


@inner
def _in_own_joint(routing: Routing, k: int, j: int, lengths: Array, trig: Array) -> float:
    """Length [m] of cable k in joint j: the whole one less those in the joints before."""
    rest = lengths[k] - routing.b[k]
    for i in range(j):
        x = routing.first[k] + i
        rest -= stretch(routing, x, trig[i, 0], trig[i, 1], trig[i, 2], trig[i, 3])[0]
    return rest


@inner
def _least_squares(
    a1: float, a2: float, a3: float,
    b1: float, b2: float, b3: float,
    r1: float, r2: float, r3: float,
) -> tuple[float, float]:  # fmt: skip
    """The step (x, y) with a x + b y nearest to r, not longer than allowed."""
    aa, bb, ab = (
        a1 * a1 + a2 * a2 + a3 * a3,
        b1 * b1 + b2 * b2 + b3 * b3,
        a1 * b1 + a2 * b2 + a3 * b3,
    )
    ar, br = a1 * r1 + a2 * r2 + a3 * r3, b1 * r1 + b2 * r2 + b3 * r3
    determinant = aa * bb - ab * ab
    if determinant <= 0.0:  # as no joint within its limits has
        return 0.0, 0.0
    x, y = (bb * ar - ab * br) / determinant, (aa * br - ab * ar) / determinant
    longest = max(abs(x), abs(y))
    share = LONGEST_STEP / longest if longest > LONGEST_STEP else 1.0
    return share * x, share * y
