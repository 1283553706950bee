"""Curvature of bend limits that the costs push against.

A limit on |theta| is round, its row in the QP straight.  Where the costs push hard against it,
the step along the tangent is too long: the next one comes back, and the plan hops for ever.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.data import Model, Scratch
from sinuous.control.step.look import bend_slack

# Limits with less cable travel left than this are leaned on [m].
NEAR = 1e-4

# Bends below this have no side worth naming [rad].
STRAIGHT = 1e-3


@kernel
def add_bend_curvature(model: Model, c: Array, f: Array, H: Array, scratch: Scratch) -> None:
    """Add -push d2(slack)/dy2 of every bend limit that c leans on, push being its multiplier.

    The multiplier is what explains the gradient f of the costs best if this limit is alone.

    Arguments:
        c: configuration (n,)
        f, H: gradient (n,) and Hessian (n, n) of the costs, in y
    """
    bends, n = model.bends, c.size
    normal, side = scratch.row, scratch.other[1]
    for j in range(bends.theta.size):
        theta, pitch = bends.theta[j], bends.pitch[j]
        bend = float(np.sqrt(c[theta] ** 2 + c[theta + 1] ** 2))
        if bend < STRAIGHT or bend_slack(bends, j, c) > NEAR:
            continue
        _derivatives(model, j, c, bend, scratch.other[0], normal, side)
        along, square = 0.0, 0.0
        for r in range(n):
            along += f[r] * normal[r]
            square += normal[r] ** 2
        push = max(along / square, 0.0)
        for r in range(n):
            for k in range(n):
                H[r, k] += push * pitch / bend * side[r] * side[k]


@kernel
def _derivatives(
    model: Model, j: int, c: Array, bend: float, slope: Array, normal: Array, side: Array
) -> None:
    """In y: of the slack, and of the bend vector's turn at constant bend.

    Arguments:
        slope, normal, side: scratch, and where they go (n,)
    """
    bends, scale, n = model.bends, model.scale, c.size
    theta, pitch = bends.theta[j], bends.pitch[j]
    x, y = c[theta] / bend, c[theta + 1] / bend
    for k in range(n):
        slope[k] = pitch * bends.slope[j, k]
    slope[theta] -= pitch * x
    slope[theta + 1] -= pitch * y
    for r in range(n):
        total = 0.0
        for k in range(n):
            total += slope[k] * scale.inverse[k, r]
        normal[r] = scale.step * total
        turn = x * scale.inverse[theta + 1, r] - y * scale.inverse[theta, r]
        side[r] = scale.step * turn
