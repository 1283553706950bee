"""What the iterating solvers share: the chain's joints, what is left to do, and its derivative.

The reduced task brings A_N to its place with the joints 1 to N-1 (3 rows). The whole task brings
the tip to its place and the last tube into its direction with all joints (5 rows); the direction
counts as the way of the tube's end [m].
"""

from math import cos, sin, sqrt
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner, kernel
from sinuous.control.geometric_ik_kernels import BASE, Arm, Frame, Vector, aim, from_first_joint

REDUCED_ROWS, WHOLE_ROWS = 3, 5


class Scratch(NamedTuple):
    """Arrays of one solution with K joints and m rows, lengths counted from A_1."""

    p: Array  # A_1 to the end of link K (K + 1, 3) [m]
    axes: Array  # of both angles of every joint, in the base frame (K, 2, 3)
    e: Array  # what is left to do (m,) [m]
    J: Array  # its derivative, with the sign changed (m, 2 K)
    W: Array  # (m, m)
    f: Array  # (m,)
    values: Array  # eigenvalues of W (m,)
    spare: Array  # (m,)


@inner
def first_column(arm: Arm, c: Array) -> int:
    """Of the joints' angles."""
    return c.size - 2 * arm.lean.size


@inner
def forward(arm: Arm, c: Array, joints: int, p: Array, axes: Array) -> Frame:
    """Joint centres and axes of the first joints; returns the frame of their last link."""
    frame, column = BASE, first_column(arm, c)
    for i in range(3):
        p[0, i] = 0.0
    for k in range(joints):
        for s in range(2):
            turns_about_z = (arm.lean[k] == 0) == (s == 0)
            axis = frame[2] if turns_about_z else frame[0]
            for i in range(3):
                axes[k, s, i] = axis[i]
            frame = _turned(frame, turns_about_z, c[column + 2 * k + s])
        length = arm.link if k < arm.lean.size - 1 else arm.last
        for i in range(3):
            p[k + 1, i] = p[k, i] + length * frame[1][i]
    return frame


@inner
def _turned(frame: Frame, about_z: bool, angle: float) -> Frame:
    x, y, z = frame
    cosine, sine = cos(angle), sin(angle)
    if about_z:
        return _mix(x, y, cosine, sine), _mix(y, x, cosine, -sine), z
    return x, _mix(y, z, cosine, sine), _mix(z, y, cosine, -sine)


@inner
def _mix(u: Vector, v: Vector, a: float, b: float) -> Vector:
    return a * u[0] + b * v[0], a * u[1] + b * v[1], a * u[2] + b * v[2]


@inner
def goal_of(arm: Arm, target: Array, scratch: Scratch) -> Vector:
    """Where the end of the last link that is moved has to be, from A_1 [m]."""
    x, y, z = from_first_joint(arm, target)
    return (x, y + arm.last, z) if scratch.e.size > REDUCED_ROWS else (x, y, z)


@inner
def left_to_do(arm: Arm, goal: Vector, frame: Frame, scratch: Scratch) -> float:
    """Write e (m,); return its squared length [m^2]."""
    e, last = scratch.e, scratch.p.shape[0] - 1
    for i in range(3):
        e[i] = goal[i] - scratch.p[last, i]
    if e.size > REDUCED_ROWS:
        e[3], e[4] = -arm.last * frame[1][0], -arm.last * frame[1][2]
    square = 0.0
    for i in range(e.size):
        square += e[i] * e[i]
    return square


@inner
def differentiate(arm: Arm, frame: Frame, scratch: Scratch) -> None:
    """Write J (m, 2 K), the analytic derivative, and W = J J'."""
    p, axes, J = scratch.p, scratch.axes, scratch.J
    joints = p.shape[0] - 1
    y = frame[1]
    for k in range(joints):
        rx, ry, rz = p[joints, 0] - p[k, 0], p[joints, 1] - p[k, 1], p[joints, 2] - p[k, 2]
        for s in range(2):
            ax, ay, az = axes[k, s, 0], axes[k, s, 1], axes[k, s, 2]
            column = 2 * k + s
            J[0, column] = ay * rz - az * ry
            J[1, column] = az * rx - ax * rz
            J[2, column] = ax * ry - ay * rx
            if J.shape[0] > REDUCED_ROWS:
                J[3, column] = arm.last * (ay * y[2] - az * y[1])
                J[4, column] = arm.last * (ax * y[1] - ay * y[0])
    for a in range(J.shape[0]):
        for b in range(a + 1):
            total = 0.0
            for i in range(J.shape[1]):
                total += J[a, i] * J[b, i]
            scratch.W[a, b] = total
            scratch.W[b, a] = total


@inner
def move(arm: Arm, scratch: Scratch, most: float, c: Array) -> None:
    """Change the angles by J' f, shortened so that none changes by more than `most` [rad]."""
    J, f, column = scratch.J, scratch.f, first_column(arm, c)
    largest = most
    for i in range(J.shape[1]):
        change = 0.0
        for a in range(f.size):
            change += J[a, i] * f[a]
        largest = max(largest, abs(change))
    for i in range(J.shape[1]):
        for a in range(f.size):
            c[column + i] += J[a, i] * f[a] * (most / largest)


@inner
def straighten_last(arm: Arm, frame: Frame, scratch: Scratch, c: Array) -> None:
    """Make the last tube parallel to y, unless that was part of the task."""
    if scratch.e.size == REDUCED_ROWS:
        aim(arm, arm.lean.size - 1, (0.0, 1.0, 0.0), frame, c)


@inner
def solve_damped(W: Array, e: Array, damping: float, f: Array) -> None:
    """(W + damping I) f = e by Cholesky's factors, which replace the lower half of W."""
    for i in range(f.size):
        W[i, i] += damping
        total = e[i]
        for k in range(i):
            value = W[i, k]
            for m in range(k):
                value -= W[i, m] * W[k, m]
            W[i, k] = value / W[k, k]
            W[i, i] -= W[i, k] * W[i, k]
            total -= W[i, k] * f[k]
        W[i, i] = sqrt(W[i, i])
        f[i] = total / W[i, i]
    for i in range(f.size - 1, -1, -1):
        for k in range(i + 1, f.size):
            f[i] -= W[k, i] * f[k]
        f[i] /= W[i, i]


@kernel
def new_scratch(arm: Arm, whole: bool) -> Scratch:
    """Allocate for the whole or the reduced task."""
    joints, rows = (arm.lean.size, WHOLE_ROWS) if whole else (arm.lean.size - 1, REDUCED_ROWS)
    return Scratch(
        np.empty((joints + 1, 3)),
        np.empty((joints, 2, 3)),
        np.empty(rows),
        np.empty((rows, 2 * joints)),
        np.empty((rows, rows)),
        np.empty(rows),
        np.empty(rows),
        np.empty(rows),
    )
