"""Second derivatives of the points of a chain: under held forces, and along a straight way.

Notation as in `chain_kernels`.
"""

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner
from sinuous.robots.arc_series import second_coefficients
from sinuous.robots.chain_kernels import ARC, HINGE, STRAIGHT, Chain, axis, bend

# Where in the scratch of `curvature` its sums begin, vectors in the world frame.
FORCE = 0  # sum of the forces beyond the section
MOMENT = 3  # (3, 3) sum of f q' with q from the section's end to the point
C0, C1, C2 = 12, 15, 18  # sum of u^2 C f and its derivatives by w
S0, S1, S2 = 21, 24, 27  # sum of u S f and its derivatives by w
TORQUE = 30  # (3, 3) sum of (derivative of the point) x f, a row for every coordinate
SCRATCH = 39


@inner
def scratch_size(sections: int, coordinates: int) -> int:
    """Length of the scratch of `curvature`: the same for all robots."""
    return SCRATCH


@inner
def curvature(
    chain: Chain,
    c: Array,
    R: Array,
    p: Array,
    ends: Array,
    spins: Array,
    points: IntArray,
    forces: Array,
    count: int,
    scratch: Array,
    out: Array,
) -> None:
    """Symmetric derivative (n, n) of sum_k J_k' f_k with the forces held, analytic.

    It is the Hessian of the sum of f_k . p_k.  From the tip to the base, every section needs
    the force F and the moment matrix of what lies beyond it: for itself it then bears a point
    at its end with the force F, its own points, and sum f' R(theta) q.  A bend of a proximal
    section turns all that: its mixed derivative is spin . sum (derivative of the point) x f.
    A length of a proximal section only shifts it, without mixed derivative.

    Arguments:
        R, p, ends, spins: of `chain_derivative`
        points, forces: (K,) and (K, 3), of which the first `count` act; points may repeat
        scratch: (`scratch_size`,)
    """
    for j in range(out.shape[0]):
        for k in range(out.shape[1]):
            out[j, k] = 0.0
    for i in range(SCRATCH):
        scratch[i] = 0.0
    for m in range(chain.theta_column.size - 1, -1, -1):
        _gather(chain, m, c, points, forces, count, scratch)
        if chain.turns[m] == ARC:
            _own_block(chain, m, c, R, scratch, out)
        elif chain.turns[m] == HINGE:
            _hinge_block(chain, m, spins, scratch, out)
        _torques(chain, m, c, R, spins, scratch)
        _mixed_blocks(chain, m, spins, scratch, out)
        _carry(chain, m, c, R, scratch)


@inner
def _gather(
    chain: Chain, m: int, c: Array, points: IntArray, forces: Array, count: int, scratch: Array
) -> None:
    """Sum up what acts on section m: the force at its end, and those at its own points."""
    theta_x, theta_y, _ = bend(chain, m, c)
    w = theta_x * theta_x + theta_y * theta_y
    for i in range(C0, TORQUE):
        scratch[i] = 0.0
    _add(1.0, w, scratch[FORCE], scratch[FORCE + 1], scratch[FORCE + 2], scratch)
    for k in range(count):
        if chain.section[points[k]] == m:
            x, y, z = forces[k, 0], forces[k, 1], forces[k, 2]
            _add(float(chain.fraction[points[k]]), w, x, y, z, scratch)
            scratch[FORCE] += x
            scratch[FORCE + 1] += y
            scratch[FORCE + 2] += z


@inner
def _add(u: float, w: float, x: float, y: float, z: float, scratch: Array) -> None:
    v = u * u
    s, k, s1, k1, s2, k2 = second_coefficients(v * w)
    s, s1, s2 = u * s, u * v * s1, u * v * v * s2
    k, k1, k2 = v * k, v * v * k1, v * v * v * k2
    for i in range(3):
        f = x if i == 0 else (y if i == 1 else z)
        scratch[C0 + i] += k * f
        scratch[C1 + i] += k1 * f
        scratch[C2 + i] += k2 * f
        scratch[S0 + i] += s * f
        scratch[S1 + i] += s1 * f
        scratch[S2 + i] += s2 * f


@inner
def _own_block(chain: Chain, m: int, c: Array, R: Array, scratch: Array, out: Array) -> None:
    """Second derivatives by the coordinates of section m, a bending one.

    They are those of gamma (sum f . (u^2 C theta + u S z)) + S l . theta - C q(theta), whose
    last two terms, with a linear and a quadratic form, are sum f' R(theta) q.
    """
    theta_x, theta_y, gamma = bend(chain, m, c)
    _, k, s1, k1, s2, k2 = second_coefficients(theta_x * theta_x + theta_y * theta_y)
    lx, ly, qx, qxy, qy = _forms(m, R, scratch)
    gx, gy = 2.0 * qx * theta_x + qxy * theta_y, qxy * theta_x + 2.0 * qy * theta_y
    linear, square = lx * theta_x + ly * theta_y, 0.5 * (gx * theta_x + gy * theta_y)
    c1x, c1y = _along(m, 0, R, C1, scratch), _along(m, 1, R, C1, scratch)
    first = c1x * theta_x + c1y * theta_y + _along(m, 2, R, S1, scratch)
    second = _along(m, 0, R, C2, scratch) * theta_x + _along(m, 1, R, C2, scratch) * theta_y
    second += _along(m, 2, R, S2, scratch)
    # h(w) P has the second derivative 4 h'' P theta theta' + 2 h' (P I + theta dP' + dP theta')
    # + h ddP: these are the sums of 4 h'' P, 2 h' P and 2 h' dP.
    both = 4.0 * (gamma * second + s2 * linear - k2 * square)
    even = 2.0 * (gamma * first + s1 * linear - k1 * square)
    hx, hy = 2.0 * (gamma * c1x + s1 * lx - k1 * gx), 2.0 * (gamma * c1y + s1 * ly - k1 * gy)
    column, extends = chain.theta_column[m], chain.gamma_column[m]
    out[column, column] = theta_x * (both * theta_x + 2.0 * hx) + even - 2.0 * k * qx
    out[column + 1, column + 1] = theta_y * (both * theta_y + 2.0 * hy) + even - 2.0 * k * qy
    mixed = both * theta_x * theta_y + theta_x * hy + theta_y * hx - k * qxy
    out[column, column + 1], out[column + 1, column] = mixed, mixed
    if extends >= 0:
        mixed = _along(m, 0, R, C0, scratch) + 2.0 * theta_x * first
        out[column, extends], out[extends, column] = mixed, mixed
        mixed = _along(m, 1, R, C0, scratch) + 2.0 * theta_y * first
        out[column + 1, extends], out[extends, column + 1] = mixed, mixed


@inner
def _hinge_block(chain: Chain, m: int, spins: Array, scratch: Array, out: Array) -> None:
    """Second derivative by the angle of hinge m: sum f . (a x (a x q)) with its axis a."""
    total = -(scratch[MOMENT] + scratch[MOMENT + 4] + scratch[MOMENT + 8])
    for i in range(3):
        for j in range(3):
            total += spins[m, i, 0] * scratch[MOMENT + 3 * i + j] * spins[m, j, 0]
    out[chain.theta_column[m], chain.theta_column[m]] = total


@inner
def _along(m: int, column: int, R: Array, at: int, scratch: Array) -> float:
    """Component of the vector that begins there in the scratch along an axis of section m."""
    x, y, z = scratch[at], scratch[at + 1], scratch[at + 2]
    return R[m, 0, column] * x + R[m, 1, column] * y + R[m, 2, column] * z


@inner
def _forms(m: int, R: Array, scratch: Array) -> tuple[float, float, float, float, float]:
    """Linear form (x, y) and quadratic form (xx, xy, yy) of theta in sum f' R(theta) q.

    With G = sum f q', f in the frame of the section's start and q in that of its end, it is
    S (G_xz - G_zx, G_yz - G_zy) . theta - C ((G_xx + G_zz) theta_x^2 + (G_xy + G_yx) theta_x
    theta_y + (G_yy + G_zz) theta_y^2) and a constant.
    """
    lx, ly, qx, qxy, qy = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(3):
        vx, vy, vz = 0.0, 0.0, 0.0
        for j in range(3):
            moment = scratch[MOMENT + 3 * j + i]
            vx += R[m, j, 0] * moment
            vy += R[m, j, 1] * moment
            vz += R[m, j, 2] * moment
        x, y, z = R[m + 1, i, 0], R[m + 1, i, 1], R[m + 1, i, 2]
        lx, ly = lx + vx * z - vz * x, ly + vy * z - vz * y
        qx, qxy, qy = qx + vx * x + vz * z, qxy + vx * y + vy * x, qy + vy * y + vz * z
    return lx, ly, qx, qxy, qy


@inner
def _torques(chain: Chain, m: int, c: Array, R: Array, spins: Array, scratch: Array) -> None:
    """Sum of (derivative of the point) x f for the coordinates of section m."""
    theta_x, theta_y, gamma = bend(chain, m, c)
    trace = scratch[MOMENT] + scratch[MOMENT + 4] + scratch[MOMENT + 8]
    for i in range(3):
        j, k = (1 if i == 0 else (2 if i == 1 else 0)), (2 if i == 0 else (0 if i == 1 else 1))
        tj = theta_x * R[m, j, 0] + theta_y * R[m, j, 1]
        tk = theta_x * R[m, k, 0] + theta_y * R[m, k, 1]
        zj, zk = axis(chain, m, j, R), axis(chain, m, k, R)
        scratch[TORQUE + 6 + i] = tj * scratch[C0 + k] - tk * scratch[C0 + j]
        scratch[TORQUE + 6 + i] += zj * scratch[S0 + k] - zk * scratch[S0 + j]
        if chain.turns[m] == STRAIGHT:
            continue
        change = tj * scratch[C1 + k] - tk * scratch[C1 + j]
        change += zj * scratch[S1 + k] - zk * scratch[S1 + j]
        for a in range(chain.turns[m]):
            theta = theta_x if a == 0 else theta_y
            arm = R[m, j, a] * scratch[C0 + k] - R[m, k, a] * scratch[C0 + j]
            turn = -trace * spins[m, i, a]
            for b in range(3):
                turn += scratch[MOMENT + 3 * b + i] * spins[m, b, a]
            scratch[TORQUE + 3 * a + i] = gamma * (arm + 2.0 * theta * change) + turn


@inner
def _mixed_blocks(chain: Chain, m: int, spins: Array, scratch: Array, out: Array) -> None:
    """Second derivatives by a coordinate of section m and a turn of one before."""
    for b in range(3):
        own = chain.gamma_column[m] if b == 2 else chain.theta_column[m]
        if own < 0 or chain.turns[m] <= b < 2:
            continue
        own += 0 if b == 2 else b
        x, y, z = (
            scratch[TORQUE + 3 * b + 0],
            scratch[TORQUE + 3 * b + 1],
            scratch[TORQUE + 3 * b + 2],
        )
        for j in range(m):
            column = chain.theta_column[j]
            if column < 0:
                continue
            for a in range(chain.turns[j]):
                value = spins[j, 0, a] * x + spins[j, 1, a] * y + spins[j, 2, a] * z
                out[column + a, own] = value
                out[own, column + a] = value


@inner
def _carry(chain: Chain, m: int, c: Array, R: Array, scratch: Array) -> None:
    """Move the moment matrix from the end of section m to its start."""
    theta_x, theta_y, gamma = bend(chain, m, c)
    for j in range(3):
        theta = gamma * (theta_x * R[m, j, 0] + theta_y * R[m, j, 1])
        along = gamma * axis(chain, m, j, R)
        for i in range(3):
            scratch[MOMENT + 3 * i + j] += scratch[C0 + i] * theta + scratch[S0 + i] * along


@inner
def acceleration_bound(chain: Chain, c: Array, delta: Array, out: Array) -> None:
    """Bound (S,) of |d^2 p / dt^2| [m] of every point on the way c + t delta, t in [0, 1].

    Between t1 and t2 a point strays from its chord by at most bound (t2 - t1)^2 / 8.

    Proof.  A section turns by R = exp([o]) with o linear in t and |o'| = d = |theta'|.  As
    R' is the integral of exp(r [o]) [o'] exp((1 - r) [o]) over r from 0 to 1, |R'| <= d; as
    R'' is twice the integral of such products with two factors [o'] over a triangle of area
    1/2, |R''| <= d^2.  A product of rotations with rates d_k then has a first derivative of at
    most O = sum d_k and a second one of at most O^2.  The arc up to the fraction u is
    e = gamma (integral of R(v theta) z over v from 0 to u), with |R(v theta)'| <= v d.
    So with the largest length g, at one of the ends of the way, and its change h = |gamma'|,

        |e| <= g u,   |e'| <= h u + g d u^2 / 2,   |e''| <= h d u^2 + g d^2 u^3 / 3.

    A hinge turns about a fixed axis, with d the change of its angle and e = 0.
    A point is the sum of R e over the sections that it passes and its own, each turned by R,
    the product of the rotations before, and (R e)'' = R'' e + 2 R' e' + R e''.
    """
    s, passed, turned = 0, 0.0, 0.0
    for m in range(chain.theta_column.size):
        x, y = 0.0, 0.0
        if chain.turns[m] >= HINGE:
            x = delta[chain.theta_column[m]]
        if chain.turns[m] == ARC:
            y = delta[chain.theta_column[m] + 1]
        d, g, h = np.sqrt(x * x + y * y), abs(chain.fixed_length[m]), 0.0
        if chain.gamma_column[m] >= 0:
            gamma, change = c[chain.gamma_column[m]], delta[chain.gamma_column[m]]
            g, h = max(abs(gamma), abs(gamma + change)), abs(change)
        # The bound is passed + a u + b u^2 + e u^3.
        a = turned * (turned * g + 2.0 * h)
        b = d * (turned * g + h)
        e = g * d * d / 3.0
        while s < chain.section.size and chain.section[s] == m:
            u = chain.fraction[s]
            out[s] = passed + u * (a + u * (b + u * e))
            s += 1
        passed += a + b + e
        turned += d
