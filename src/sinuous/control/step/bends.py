"""Curvature of bend limits that the costs push against.

A limit on a bend is round, its row in the QP straight.  Where the costs push hard against it,
the step along the tangent is too long: the next one comes back, and the plan hops for ever.
"""

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.data import Model, Scratch
from sinuous.control.step.look import bend_slack
from sinuous.robots.bending import bend, bend_gradient, bend_hessian

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
    bends, scale, n = model.bends, model.scale, c.size
    normal = scratch.row
    for j in range(bends.column.size):
        column, is_joint = bends.column[j], bends.is_joint[j]
        x, y = float(c[column]), float(c[column + 1])
        if bend(is_joint, x, y) < STRAIGHT or bend_slack(bends, j, c) > NEAR:
            continue
        _slope(model, j, c, scratch.other[0], normal)
        along, square = 0.0, 0.0
        for r in range(n):
            along += f[r] * normal[r]
            square += normal[r] ** 2
        push = max(along / square, 0.0)
        xx, xy, yy = bend_hessian(is_joint, x, y)
        weight = push * bends.pitch[j] * scale.step**2
        for r in range(n):
            first, second = scale.inverse[column, r], scale.inverse[column + 1, r]
            by_x, by_y = xx * first + xy * second, xy * first + yy * second
            for k in range(n):
                one, other = scale.inverse[column, k], scale.inverse[column + 1, k]
                H[r, k] += weight * (by_x * one + by_y * other)


@kernel
def _slope(model: Model, j: int, c: Array, slope: Array, normal: Array) -> None:
    """Derivative of the slack (n,) by c, and in y."""
    bends, scale, n = model.bends, model.scale, c.size
    column, pitch = bends.column[j], bends.pitch[j]
    x, y = bend_gradient(bends.is_joint[j], float(c[column]), float(c[column + 1]))
    for k in range(n):
        slope[k] = pitch * bends.slope[j, k]
    slope[column] -= pitch * x
    slope[column + 1] -= pitch * y
    for r in range(n):
        total = 0.0
        for k in range(n):
            total += slope[k] * scale.inverse[k, r]
        normal[r] = scale.step * total
