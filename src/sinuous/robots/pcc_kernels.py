"""Compiled kinematics of a chain of constant-curvature and straight sections.

A section bends by the vector theta = (theta_x, theta_y) over its arc length gamma: it
curves towards (theta_x, theta_y) in the local xy plane, by |theta| in total.  With
w = |u theta|^2, at the fraction u of the arc,

    p(u) = gamma u (C u theta_x, C u theta_y, S),   R(u) = I + S [o] + C [o]^2,

where o = u (-theta_y, theta_x, 0), S = sin a / a, C = (1 - cos a) / a^2, a^2 = w.  All
coefficients are power series in w, so position and Jacobian are smooth at the straight
shape, where the usual (curvature, plane) coordinates are singular.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import kernel

CURVATURE_STEP = 1e-5  # of a coordinate [rad or m], for differences of the Jacobian
SERIES_BELOW = 0.5  # below this w eight series terms reach machine precision


class Chain(NamedTuple):
    """The sections of a robot and where on them its points lie."""

    theta_column: IntArray  # (M,) first of two columns of the configuration, -1: straight
    gamma_column: IntArray  # (M,) column of the length, -1: fixed
    fixed_length: Array  # (M,) [m]
    direction: Array  # (M, 3) of a straight section, in its own frame
    section: IntArray  # (S,) section of each point
    fraction: Array  # (S,) fraction of that section's arc


@kernel
def coefficients(w: float) -> tuple[float, float, float, float]:
    """S, C, D = (1 - S) / w and E = (1/2 - C) / w as smooth functions of w = a^2."""
    if w < SERIES_BELOW:
        s, c, d, e = 0.0, 0.0, 0.0, 0.0
        term = 1.0  # (-w)^k / (2k)!
        for k in range(9):
            a, b = 2.0 * k + 1.0, 2.0 * k + 2.0
            s += term / a
            c += term / (a * b)
            d += term / (a * b * (b + 1.0))
            e += term / (a * b * (b + 1.0) * (b + 2.0))
            term *= -w / (a * b)
        return s, c, d, e
    a = np.sqrt(w)
    s = np.sin(a) / a
    half = np.sin(0.5 * a)
    c = 2.0 * half * half / w
    return s, c, (1.0 - s) / w, (0.5 - c) / w


@kernel
def section_bend(chain: Chain, m: int, c: Array) -> tuple[float, float, float]:
    """Bend vector [rad] and length [m] of section m."""
    theta_x, theta_y = 0.0, 0.0
    if chain.theta_column[m] >= 0:
        theta_x = float(c[chain.theta_column[m]])
        theta_y = float(c[chain.theta_column[m] + 1])
    gamma = float(chain.fixed_length[m])
    if chain.gamma_column[m] >= 0:
        gamma = float(c[chain.gamma_column[m]])
    return theta_x, theta_y, gamma


@kernel
def section_point(chain: Chain, m: int, u: float, c: Array, out: Array) -> None:
    """Position (3,) at the fraction u of section m in the frame where the section starts."""
    theta_x, theta_y, gamma = section_bend(chain, m, c)
    if chain.theta_column[m] < 0:
        for i in range(3):
            out[i] = u * gamma * chain.direction[m, i]
        return
    s, k, _, _ = coefficients(u * u * (theta_x * theta_x + theta_y * theta_y))
    out[0] = gamma * u * u * k * theta_x
    out[1] = gamma * u * u * k * theta_y
    out[2] = gamma * u * s


@kernel
def section_rotation(theta_x: float, theta_y: float, out: Array) -> None:
    """Rotation (3, 3) from the start to the end of a section."""
    s, k, _, _ = coefficients(theta_x * theta_x + theta_y * theta_y)
    out[0, 0] = 1.0 - k * theta_x * theta_x
    out[0, 1] = -k * theta_x * theta_y
    out[1, 0] = out[0, 1]
    out[1, 1] = 1.0 - k * theta_y * theta_y
    out[0, 2] = s * theta_x
    out[1, 2] = s * theta_y
    out[2, 0] = -out[0, 2]
    out[2, 1] = -out[1, 2]
    out[2, 2] = 1.0 - k * (theta_x * theta_x + theta_y * theta_y)


@kernel
def frames(chain: Chain, T_w_b: Array, c: Array, R: Array, p: Array) -> None:
    """Frames at the start of every section and after the last: R (M+1, 3, 3), p (M+1, 3)."""
    local, turn = np.empty(3), np.empty((3, 3))
    for i in range(3):
        p[0, i] = T_w_b[i, 3]
        for j in range(3):
            R[0, i, j] = T_w_b[i, j]
    for m in range(chain.theta_column.size):
        section_point(chain, m, 1.0, c, local)
        theta_x, theta_y, _ = section_bend(chain, m, c)
        section_rotation(theta_x, theta_y, turn)
        for i in range(3):
            p[m + 1, i] = p[m, i]
            for k in range(3):
                p[m + 1, i] += R[m, i, k] * local[k]
            for j in range(3):
                R[m + 1, i, j] = 0.0
                for k in range(3):
                    R[m + 1, i, j] += R[m, i, k] * turn[k, j]


@kernel
def points(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Points (S, 3) of one configuration (n,) in the world frame."""
    sections = chain.theta_column.size
    R, p, local = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3)), np.empty(3)
    frames(chain, T_w_b, c, R, p)
    for s in range(chain.section.size):
        m = chain.section[s]
        section_point(chain, m, chain.fraction[s], c, local)
        for i in range(3):
            out[s, i] = p[m, i]
            for k in range(3):
                out[s, i] += R[m, i, k] * local[k]


@kernel
def section_derivative(chain: Chain, m: int, u: float, c: Array, out: Array) -> None:
    """Derivative (3, 3) of a point of section m by (theta_x, theta_y, gamma), local frame."""
    theta_x, theta_y, gamma = section_bend(chain, m, c)
    out[:, :] = 0.0
    if chain.theta_column[m] < 0:
        for i in range(3):
            out[i, 2] = u * chain.direction[m, i]
        return
    s, k, d, e = coefficients(u * u * (theta_x * theta_x + theta_y * theta_y))
    ds = -(k - d) * u * u  # derivative of S by theta, divided by theta
    dk = (2.0 * e - d) * u * u  # the same of C
    reach = gamma * u * u
    out[0, 0] = reach * (k + dk * theta_x * theta_x)
    out[0, 1] = reach * dk * theta_x * theta_y
    out[1, 0] = out[0, 1]
    out[1, 1] = reach * (k + dk * theta_y * theta_y)
    out[2, 0] = gamma * u * ds * theta_x
    out[2, 1] = gamma * u * ds * theta_y
    out[0, 2] = u * u * k * theta_x
    out[1, 2] = u * u * k * theta_y
    out[2, 2] = u * s


@kernel
def section_spin(theta_x: float, theta_y: float, out: Array) -> None:
    """Angular velocity (3, 2) of a section's end by (theta_x, theta_y): Jl(o) do."""
    _, k, d, _ = coefficients(theta_x * theta_x + theta_y * theta_y)
    # o = (-theta_y, theta_x, 0); Jl = I + C [o] + D [o]^2, columns for do = (0,1,0), (-1,0,0)
    out[0, 0] = -d * theta_x * theta_y
    out[1, 0] = 1.0 - d * theta_y * theta_y
    out[2, 0] = -k * theta_y
    out[0, 1] = -(1.0 - d * theta_x * theta_x)
    out[1, 1] = d * theta_x * theta_y
    out[2, 1] = k * theta_x


@kernel
def chain_derivative(
    chain: Chain, T_w_b: Array, c: Array, R: Array, p: Array, ends: Array, spins: Array
) -> None:
    """Frames, and how the end of every section moves (M, 3, 3) and turns (M, 3, 2), world."""
    local = np.empty((3, 3))
    frames(chain, T_w_b, c, R, p)
    for m in range(chain.theta_column.size):
        section_derivative(chain, m, 1.0, c, local)
        rotate(R[m], local, ends[m])
        theta_x, theta_y, _ = section_bend(chain, m, c)
        section_spin(theta_x, theta_y, local[:, :2])
        rotate(R[m], local[:, :2], spins[m])


@kernel
def point_jacobian(
    chain: Chain, s: int, c: Array, R: Array, p: Array, ends: Array, spins: Array, out: Array
) -> None:
    """Derivative (3, n) of point s, given the derivative of the chain."""
    m = chain.section[s]
    local, point = np.empty((3, 3)), np.empty(3)
    section_point(chain, m, chain.fraction[s], c, local[0])
    for i in range(3):
        point[i] = p[m, i]
        for k in range(3):
            point[i] += R[m, i, k] * local[0, k]
    out[:, :] = 0.0
    for j in range(m):
        write_columns(chain, j, ends[j], spins[j], point, p[j + 1], out)
    section_derivative(chain, m, chain.fraction[s], c, local)
    write_own_columns(chain, m, R[m], local, out)


@kernel
def points_jacobian(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Derivative (S, 3, n) of the points of one configuration (n,), world frame."""
    sections = chain.theta_column.size
    R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
    ends, spins = np.empty((sections, 3, 3)), np.empty((sections, 3, 2))
    chain_derivative(chain, T_w_b, c, R, p, ends, spins)
    for s in range(chain.section.size):
        point_jacobian(chain, s, c, R, p, ends, spins, out[s])


@kernel
def curvature(chain: Chain, T_w_b: Array, c: Array, forces: Array, out: Array) -> None:
    """Symmetric derivative (n, n) of sum_s J_s' f_s at one configuration, f (S, 3) held."""
    sections, n = chain.theta_column.size, c.size
    R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
    ends, spins = np.empty((sections, 3, 3)), np.empty((sections, 3, 2))
    moved, J = c.copy(), np.empty((3, n))
    out[:, :] = 0.0
    for k in range(n):
        for sign in (-1.0, 1.0):
            moved[k] = c[k] + sign * CURVATURE_STEP
            chain_derivative(chain, T_w_b, moved, R, p, ends, spins)
            for s in range(chain.section.size):
                f = forces[s]
                if f[0] == 0.0 and f[1] == 0.0 and f[2] == 0.0:
                    continue
                point_jacobian(chain, s, moved, R, p, ends, spins, J)
                for j in range(n):
                    pull = J[0, j] * f[0] + J[1, j] * f[1] + J[2, j] * f[2]
                    out[j, k] += sign * pull / (2.0 * CURVATURE_STEP)
        moved[k] = c[k]
    for k in range(n):
        for j in range(k):
            out[j, k] = 0.5 * (out[j, k] + out[k, j])
            out[k, j] = out[j, k]


@kernel
def rotate(R: Array, columns: Array, out: Array) -> None:
    """out = R columns for a few columns of length three."""
    for j in range(columns.shape[1]):
        for i in range(3):
            out[i, j] = R[i, 0] * columns[0, j] + R[i, 1] * columns[1, j] + R[i, 2] * columns[2, j]


@kernel
def write_columns(
    chain: Chain, m: int, end: Array, spin: Array, point: Array, pivot: Array, out: Array
) -> None:
    """Columns of a section that carries the point: its end moves and turns about itself."""
    if chain.theta_column[m] >= 0:
        column = chain.theta_column[m]
        x, y, z = point[0] - pivot[0], point[1] - pivot[1], point[2] - pivot[2]
        for k in range(2):
            out[0, column + k] = end[0, k] + spin[1, k] * z - spin[2, k] * y
            out[1, column + k] = end[1, k] + spin[2, k] * x - spin[0, k] * z
            out[2, column + k] = end[2, k] + spin[0, k] * y - spin[1, k] * x
    if chain.gamma_column[m] >= 0:
        for i in range(3):
            out[i, chain.gamma_column[m]] = end[i, 2]


@kernel
def write_own_columns(chain: Chain, m: int, R: Array, local: Array, out: Array) -> None:
    """Columns of the section on which the point lies."""
    for i in range(3):
        for k in range(3):
            value = R[i, 0] * local[0, k] + R[i, 1] * local[1, k] + R[i, 2] * local[2, k]
            if k < 2 and chain.theta_column[m] >= 0:
                out[i, chain.theta_column[m] + k] = value
            if k == 2 and chain.gamma_column[m] >= 0:
                out[i, chain.gamma_column[m]] = value


@kernel
def points_batch(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Points (B, S, 3) of configurations (B, n)."""
    for b in range(c.shape[0]):
        points(chain, T_w_b, c[b], out[b])


@kernel
def points_jacobian_batch(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Jacobians (B, S, 3, n) of configurations (B, n)."""
    for b in range(c.shape[0]):
        points_jacobian(chain, T_w_b, c[b], out[b])
