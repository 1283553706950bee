"""Second-order model of the costs at one predicted stage, in y.

The Hessian is that of the Lagrangian: the curvature of the kinematics under the pull on the tip
and the push of the walls is included, and that of bend limits.  Without it a target far outside
the walls makes the step oscillate, because the pull is then large in directions in which the
tip's Jacobian has no gain.  The posture counts in the tip's null space, which turns as the body
moves: its curvature is that of the kinematics under the force at the tip that would hold the
body in its posture.  Without it the body trembles around a posture that is far from home.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.bends import add_bend_curvature
from sinuous.control.step.data import Contacts, Model, Motion, Problem, Scratch, Shape
from sinuous.control.step.eigen import decompose
from sinuous.robots import chain_kernels, chain_second

# Damping of the tip's null space [m^2 of tip per m^2 of actuator]: far below the smallest
# squared gain at which a direction of the tip is still worth steering (1 %).
NULL_SPACE_DAMPING = 1e-5

# Eigenvalues of a stage's scaled Hessian are kept above this share of the largest.
CONVEX = 1e-9


@kernel
def linearise(
    model: Model,
    old: Shape,
    motion: Motion,
    contacts: Contacts,
    problem: Problem,
    i: int,
    target: Array,
    scratch: Scratch,
) -> None:
    """Write derivatives of the kinematics, Hessian and gradient of stage i."""
    body, aims, scale = model.body, model.aims, model.scale
    c, n, last = old.c[i], old.c.shape[1], body.required.size - 1
    R, p, ends, spins = motion.R[i], motion.p[i], motion.ends[i], motion.spins[i]
    chain_kernels.chain_derivative(body.chain, body.T_w_b, c, R, p, ends, spins)
    chain_kernels.point_jacobian(body.chain, last, c, R, p, ends, spins, scratch.J)
    tip, free, H, f = motion.tip[i], motion.free[i], problem.H[i], problem.f[i]
    _to_y(scratch.J, scale.inverse, scale.step, tip)
    _project(tip, scale.step, free, scratch.small)

    number, pull = 1, scratch.small[3]
    scratch.number[0] = last
    for d in range(3):
        error = old.points[i, last, d] - target[d]
        scratch.force[0, d] = 2.0 * aims.tip * error
    for d in range(3):
        pull[d] = scratch.force[0, d]
    if aims.posture > 0.0:
        _hold_posture(model, c, tip, scratch)
    for k in range(contacts.number[i]):
        scratch.number[number] = contacts.point[i, k]
        for d in range(3):
            scratch.force[number, d] = -contacts.push[i, k, d]
        number += 1
    chain_second.curvature(
        body.chain, c, R, p, ends, spins, scratch.number, scratch.force, number, scratch.second,
        scratch.square,
    )  # fmt: skip
    _congruence(scratch.square, scale.inverse, scale.step, scratch.other, H)

    for r in range(n):
        f[r] = 0.0
        for d in range(3):
            f[r] += tip[d, r] * pull[d]
        for j in range(n):
            H[r, j] += scale.Q[r, j]
            for d in range(3):
                H[r, j] += 2.0 * aims.tip * tip[d, r] * tip[d, j]
    if aims.posture > 0.0:
        _posture(model, c, free, H, f, scratch)
    _quadratic(model, c, f, scratch)
    add_bend_curvature(model, c, f, H, scratch)
    make_convex(H, scratch.square, scratch.row, scratch.other[0])


@kernel
def _to_y(J: Array, inverse: Array, step: float, out: Array) -> None:
    """out = s J M^-1."""
    for d in range(J.shape[0]):
        for j in range(J.shape[1]):
            total = 0.0
            for k in range(J.shape[1]):
                total += J[d, k] * inverse[k, j]
            out[d, j] = step * total


@kernel
def _congruence(H: Array, inverse: Array, step: float, other: Array, out: Array) -> None:
    """out = s^2 M^-T H M^-1."""
    n = H.shape[0]
    for r in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += H[r, k] * inverse[k, j]
            other[r, j] = total
    for r in range(n):
        for j in range(n):
            total = 0.0
            for k in range(n):
                total += inverse[k, r] * other[k, j]
            out[r, j] = step * step * total


@kernel
def _project(tip: Array, step: float, out: Array, inverse: Array) -> None:
    """out = I - J' inverse J, with inverse = (J J' + damping)^-1 in its first three rows, and the
    tip's Jacobian J by actuator metres times the step."""
    n, s2 = tip.shape[1], step * step
    a, b, c, d, e, g = 0.0, 0.0, 0.0, 0.0, 0.0, 0.0
    for j in range(n):
        x, y, z = tip[0, j], tip[1, j], tip[2, j]
        a, b, c = a + x * x, b + x * y, c + x * z
        d, e, g = d + y * y, e + y * z, g + z * z
    a, d, g = a + s2 * NULL_SPACE_DAMPING, d + s2 * NULL_SPACE_DAMPING, g + s2 * NULL_SPACE_DAMPING
    # The inverse of the symmetric matrix [a b c; b d e; c e g].
    A, B, C = d * g - e * e, c * e - b * g, b * e - c * d
    D, E, G = a * g - c * c, b * c - a * e, a * d - b * b
    det = a * A + b * B + c * C
    inverse[0, 0], inverse[0, 1], inverse[0, 2] = A / det, B / det, C / det
    inverse[1, 0], inverse[1, 1], inverse[1, 2] = B / det, D / det, E / det
    inverse[2, 0], inverse[2, 1], inverse[2, 2] = C / det, E / det, G / det
    for r in range(n):
        u, v, w = 0.0, 0.0, 0.0
        for d in range(3):
            u += inverse[0, d] * tip[d, r]
            v += inverse[1, d] * tip[d, r]
            w += inverse[2, d] * tip[d, r]
        for j in range(n):
            out[r, j] = -(u * tip[0, j] + v * tip[1, j] + w * tip[2, j])
        out[r, r] += 1.0


@kernel
def _hold_posture(model: Model, c: Array, tip: Array, scratch: Scratch) -> None:
    """Take the force that would hold the posture from the one at the tip, for its curvature.

    It is mu = (J J' + damping)^-1 J g with the gradient g of the posture without projection.
    """
    aims, scale, n = model.aims, model.scale, c.size
    inverse, along = scratch.small, scratch.small[4]
    for d in range(3):
        along[d] = 0.0
    for r in range(n):
        total = 0.0
        for j in range(n):
            total += scale.metric[r, j] * (c[j] - aims.home[j])
        for d in range(3):
            along[d] += 2.0 * aims.posture * scale.step * tip[d, r] * total
    for d in range(3):
        for e in range(3):
            scratch.force[0, d] -= inverse[d, e] * along[e]


@kernel
def _posture(model: Model, c: Array, free: Array, H: Array, f: Array, scratch: Scratch) -> None:
    """Add weight |P M (c - home)|^2 with P the null space of the tip."""
    aims, scale, n = model.aims, model.scale, c.size
    for r in range(n):
        total = 0.0
        for j in range(n):
            total += scale.metric[r, j] * (c[j] - aims.home[j])
        scratch.row[r] = total
    pulled = scratch.other[0]
    for r in range(n):
        total = 0.0
        for j in range(n):
            total += free[r, j] * scratch.row[j]
        pulled[r] = total
    weight = 2.0 * aims.posture * scale.step
    for r in range(n):
        for j in range(n):
            f[r] += weight * free[j, r] * pulled[j]
    weight *= scale.step
    for k in range(n):
        for r in range(n):
            for j in range(n):
                H[r, j] += weight * free[k, r] * free[k, j]


@kernel
def _quadratic(model: Model, c: Array, f: Array, scratch: Scratch) -> None:
    """Add the gradient of 1/2 c' Q c + q' c."""
    aims, scale, n = model.aims, model.scale, c.size
    for r in range(n):
        total = aims.q[r]
        for j in range(n):
            total += aims.Q[r, j] * c[j]
        scratch.row[r] = total
    for r in range(n):
        for j in range(n):
            f[r] += scale.step * scale.inverse[j, r] * scratch.row[j]


@kernel
def make_convex(H: Array, scratch: Array, values: Array, spare: Array) -> None:
    """Replace H by the nearest matrix without negative curvature, if it has any.

    Arguments:
        H: (n, n)
        scratch, values, spare: (n, n), (n,), (n,)
    """
    n, largest = H.shape[0], 0.0
    for r in range(n):
        largest = max(largest, abs(H[r, r]))
    floor, definite = CONVEX * largest, True
    for r in range(n):
        for j in range(r + 1):
            total = H[r, j]
            for k in range(j):
                total -= scratch[r, k] * scratch[j, k]
            if j < r:
                scratch[r, j] = total / scratch[j, j]
            elif total <= floor:
                definite = False
            else:
                scratch[r, r] = np.sqrt(total)
        if not definite:
            break
    if definite:
        return
    for r in range(n):
        for j in range(n):
            scratch[r, j] = 0.5 * (H[r, j] + H[j, r])
    if not decompose(scratch, values, spare):
        return  # not finite; the solver will say so
    largest = 0.0
    for k in range(n):
        largest = max(largest, abs(values[k]))
    for r in range(n):
        for j in range(r + 1):
            total = 0.0
            for k in range(n):
                total += scratch[r, k] * max(values[k], CONVEX * largest) * scratch[j, k]
            H[r, j], H[j, r] = total, total
