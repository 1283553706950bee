"""Compiled kinematics of a chain of constant-curvature arcs, straight stretches and hinges.

A section bends by the vector theta = (theta_x, theta_y) over its arc length gamma: it
curves towards (theta_x, theta_y) in the local xy plane, by |theta| in total.  With
w = |theta|^2, at the fraction u of the arc, in the frame where the section starts,

    p(u) = gamma (u^2 C theta + u S z),   R(1) = I + S [o] + C [o]^2,

where o = (-theta_y, theta_x, 0), S = sin a / a and C = (1 - cos a) / a^2 with a^2 = u^2 w.
Both are power series in w (`arc_series`), so position and derivatives are smooth at the
straight shape, where the usual (curvature, plane) coordinates are singular.  A straight
section is the case theta = 0 with its own direction in the place of z.  A hinge has no length
and no points: it turns what follows about its direction by its coordinate.

The kernels that a controller calls write to arrays that it hands over, and allocate nothing.
Frames are R (M+1, 3, 3) and p (M+1, 3), at the start of every section and after the last.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner, kernel
from sinuous.robots.arc_series import SERIES_BELOW, closed, coefficients, series

STRAIGHT, HINGE, ARC = 0, 1, 2  # numbers of turns


class Chain(NamedTuple):
    """The sections of a robot and where on them its points lie, from base to tip."""

    turns: IntArray  # (M,) coordinates that turn its end: arc 2, hinge 1, straight 0
    theta_column: IntArray  # (M,) first of their columns in the configuration, -1: none
    gamma_column: IntArray  # (M,) column of the length, -1: fixed
    fixed_length: Array  # (M,) [m]
    direction: Array  # (M, 3) in which it starts, in its own frame; z of an arc, axis of a hinge
    section: IntArray  # (S,) section of each point, ascending
    fraction: Array  # (S,) fraction of that section's arc


@inner
def bend(chain: Chain, m: int, c: Array) -> tuple[float, float, float]:
    """Bend vector [rad] and length [m] of section m."""
    theta_x, theta_y = 0.0, 0.0
    if chain.turns[m] == ARC:
        theta_x = float(c[chain.theta_column[m]])
        theta_y = float(c[chain.theta_column[m] + 1])
    gamma = float(chain.fixed_length[m])
    if chain.gamma_column[m] >= 0:
        gamma = float(c[chain.gamma_column[m]])
    return theta_x, theta_y, gamma


@inner
def axis(chain: Chain, m: int, i: int, R: Array) -> float:
    """Component i of the direction in which section m starts, in the world frame."""
    x, y, z = chain.direction[m, 0], chain.direction[m, 1], chain.direction[m, 2]
    return R[m, i, 0] * x + R[m, i, 1] * y + R[m, i, 2] * z


@inner
def frames(chain: Chain, T_w_b: Array, c: Array, R: Array, p: Array) -> None:
    """Frames of all sections at one configuration (n,)."""
    _first_frame(T_w_b, R, p)
    for m in range(chain.theta_column.size):
        if chain.turns[m] == HINGE:
            _turned_frame(chain, m, c, R, p)
        else:
            theta_x, theta_y, _ = bend(chain, m, c)
            s, k, _, _ = coefficients(theta_x * theta_x + theta_y * theta_y)
            _next_frame(chain, m, c, s, k, R, p)


@inner
def _first_frame(T_w_b: Array, R: Array, p: Array) -> None:
    for i in range(3):
        p[0, i] = T_w_b[i, 3]
        for j in range(3):
            R[0, i, j] = T_w_b[i, j]


@inner
def _next_frame(chain: Chain, m: int, c: Array, s: float, k: float, R: Array, p: Array) -> None:
    theta_x, theta_y, gamma = bend(chain, m, c)
    cosine = 1.0 - k * (theta_x * theta_x + theta_y * theta_y)
    for i in range(3):
        x, y, z = R[m, i, 0], R[m, i, 1], R[m, i, 2]
        theta = theta_x * x + theta_y * y
        way = k * theta + s * axis(chain, m, i, R)
        p[m + 1, i] = p[m, i] + gamma * way
        R[m + 1, i, 0] = x - theta_x * way
        R[m + 1, i, 1] = y - theta_y * way
        R[m + 1, i, 2] = s * theta + cosine * z


@inner
def _turned_frame(chain: Chain, m: int, c: Array, R: Array, p: Array) -> None:
    """The frame after hinge m: R (cos q I + sin q [e] + (1 - cos q) e e') with its axis e."""
    angle = float(c[chain.theta_column[m]])
    x, y, z = chain.direction[m, 0], chain.direction[m, 1], chain.direction[m, 2]
    sine, cosine = np.sin(angle), np.cos(angle)
    for i in range(3):
        a, b, d = R[m, i, 0], R[m, i, 1], R[m, i, 2]
        along = (1.0 - cosine) * (a * x + b * y + d * z)
        R[m + 1, i, 0] = cosine * a + sine * (b * z - d * y) + along * x
        R[m + 1, i, 1] = cosine * b + sine * (d * x - a * z) + along * y
        R[m + 1, i, 2] = cosine * d + sine * (a * y - b * x) + along * z
        p[m + 1, i] = p[m, i]


@inner
def points_of(chain: Chain, c: Array, R: Array, p: Array, out: Array) -> None:
    """Points (S, 3) in the world frame, given the frames."""
    first = 0
    while first < chain.section.size:
        m, last = chain.section[first], first + 1
        while last < chain.section.size and chain.section[last] == m:
            last += 1
        _section_points(chain, m, first, last, c, R, p, out)
        first = last


@inner
def _section_points(
    chain: Chain, m: int, first: int, last: int, c: Array, R: Array, p: Array, out: Array
) -> None:
    theta_x, theta_y, gamma = bend(chain, m, c)
    w = theta_x * theta_x + theta_y * theta_y
    theta_x, theta_y = gamma * theta_x, gamma * theta_y
    tx = theta_x * R[m, 0, 0] + theta_y * R[m, 0, 1]
    ty = theta_x * R[m, 1, 0] + theta_y * R[m, 1, 1]
    tz = theta_x * R[m, 2, 0] + theta_y * R[m, 2, 1]
    ax, ay, az = axis(chain, m, 0, R), axis(chain, m, 1, R), axis(chain, m, 2, R)
    ax, ay, az = gamma * ax, gamma * ay, gamma * az
    px, py, pz = p[m, 0], p[m, 1], p[m, 2]
    curved = w >= SERIES_BELOW
    for n in range(first, last):
        u = chain.fraction[n]
        v = u * u
        if curved and v * w >= SERIES_BELOW:
            s, k = closed(v * w)
        else:
            s, k = series(v * w)
        s, k = u * s, v * k
        out[n, 0] = px + k * tx + s * ax
        out[n, 1] = py + k * ty + s * ay
        out[n, 2] = pz + k * tz + s * az


@inner
def chain_derivative(
    chain: Chain, T_w_b: Array, c: Array, R: Array, p: Array, ends: Array, spins: Array
) -> None:
    """Frames, and how the end of every section moves (M, 3, 3) and turns (M, 3, 2), world.

    The columns of `ends` belong to (theta_x, theta_y, gamma), those of `spins` to the first
    two; what a section does not have is zero, except that gamma is always there.  A hinge has
    its angle in the place of theta_x.
    """
    _first_frame(T_w_b, R, p)
    for m in range(chain.theta_column.size):
        if chain.turns[m] == HINGE:
            for i in range(3):
                ends[m, i, 0], ends[m, i, 1], ends[m, i, 2] = 0.0, 0.0, 0.0
                spins[m, i, 0], spins[m, i, 1] = axis(chain, m, i, R), 0.0
            _turned_frame(chain, m, c, R, p)
            continue
        theta_x, theta_y, gamma = bend(chain, m, c)
        s, k, d, e = coefficients(theta_x * theta_x + theta_y * theta_y)
        ds, dk = gamma * (d - k), gamma * (2.0 * e - d)
        for i in range(3):
            x, y, z = R[m, i, 0], R[m, i, 1], axis(chain, m, i, R)
            theta = theta_x * x + theta_y * y
            ends[m, i, 2] = k * theta + s * z
            if chain.turns[m] == ARC:
                change, turn = dk * theta + ds * z, d * theta + k * z
                ends[m, i, 0] = gamma * k * x + theta_x * change
                ends[m, i, 1] = gamma * k * y + theta_y * change
                spins[m, i, 0] = y - theta_y * turn
                spins[m, i, 1] = theta_x * turn - x
            else:
                ends[m, i, 0], ends[m, i, 1] = 0.0, 0.0
                spins[m, i, 0], spins[m, i, 1] = 0.0, 0.0
        _next_frame(chain, m, c, s, k, R, p)


@inner
def point_jacobian(
    chain: Chain, s: int, c: Array, R: Array, p: Array, ends: Array, spins: Array, out: Array
) -> None:
    """Derivative (3, n) of point s by the configuration, given the derivative of the chain."""
    for i in range(3):
        for j in range(out.shape[1]):
            out[i, j] = 0.0
    x, y, z = _own_columns(chain, s, c, R, p, out)
    for m in range(chain.section[s]):
        column = chain.theta_column[m]
        if column >= 0:
            rx, ry, rz = x - p[m + 1, 0], y - p[m + 1, 1], z - p[m + 1, 2]
            for k in range(chain.turns[m]):
                sx, sy, sz = spins[m, 0, k], spins[m, 1, k], spins[m, 2, k]
                out[0, column + k] = ends[m, 0, k] + sy * rz - sz * ry
                out[1, column + k] = ends[m, 1, k] + sz * rx - sx * rz
                out[2, column + k] = ends[m, 2, k] + sx * ry - sy * rx
        column = chain.gamma_column[m]
        if column >= 0:
            for i in range(3):
                out[i, column] = ends[m, i, 2]


@inner
def _own_columns(
    chain: Chain, s: int, c: Array, R: Array, p: Array, out: Array
) -> tuple[float, float, float]:
    """Write the columns of the section on which point s lies; return the point."""
    m, u = chain.section[s], chain.fraction[s]
    theta_x, theta_y, gamma = bend(chain, m, c)
    v = u * u
    sine, k, d, e = coefficients(v * (theta_x * theta_x + theta_y * theta_y))
    ds, dk = gamma * v * u * (d - k), gamma * v * v * (2.0 * e - d)
    sine, k = u * sine, v * k
    bends, extends = chain.theta_column[m], chain.gamma_column[m]
    px, py, pz = 0.0, 0.0, 0.0
    for i in range(3):
        x, y, z = R[m, i, 0], R[m, i, 1], axis(chain, m, i, R)
        theta = theta_x * x + theta_y * y
        way = k * theta + sine * z
        if bends >= 0:
            change = dk * theta + ds * z
            out[i, bends] = gamma * k * x + theta_x * change
            out[i, bends + 1] = gamma * k * y + theta_y * change
        if extends >= 0:
            out[i, extends] = way
        px, py, pz = py, pz, p[m, i] + gamma * way
    return px, py, pz


@kernel
def points(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Points (S, 3) of one configuration (n,) in the world frame; allocates the frames."""
    sections = chain.theta_column.size
    R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
    frames(chain, T_w_b, c, R, p)
    points_of(chain, c, R, p, out)


@kernel
def points_batch(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Points (B, S, 3) of configurations (B, n)."""
    for b in range(c.shape[0]):
        points(chain, T_w_b, c[b], out[b])


@kernel
def points_jacobian_batch(chain: Chain, T_w_b: Array, c: Array, out: Array) -> None:
    """Jacobians (B, S, 3, n) of configurations (B, n)."""
    sections = chain.theta_column.size
    R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
    ends, spins = np.empty((sections, 3, 3)), np.empty((sections, 3, 2))
    for b in range(c.shape[0]):
        chain_derivative(chain, T_w_b, c[b], R, p, ends, spins)
        for s in range(chain.section.size):
            point_jacobian(chain, s, c[b], R, p, ends, spins, out[b, s])
