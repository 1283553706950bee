"""Cyclic coordinate descent, and FABRIK, on the reduced task.

Sources: Wang and Chen, "A combined optimization method for solving the inverse kinematics problem
of mechanical manipulators" (1991); Aristidou and Lasenby, "FABRIK: a fast, iterative solver for
the inverse kinematics problem" (2011).
"""

from math import atan2, sqrt

from sinuous.arrays import Array
from sinuous.bench.ik_peers.solver import TOLERANCE, IKSolver
from sinuous.bench.ik_peers.task import (
    Scratch,
    first_column,
    forward,
    goal_of,
    left_to_do,
    new_scratch,
    straighten_last,
)
from sinuous.compiled import inner, kernel
from sinuous.control.geometric_ik_kernels import BASE, Arm, Vector, aim, straighten

LIMIT = 2000  # sweeps


@kernel
def ccd(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """Every angle in turn, from the last joint to the first, brings A_N as close as it can."""
    scratch, sweep, joints = new_scratch(arm, False), 0, arm.lean.size - 1
    for _ in range(repeats):
        for i in range(c.size):
            c[i] = start[i]
        sweep, goal = 0, goal_of(arm, target, scratch)
        frame = forward(arm, c, joints, scratch.p, scratch.axes)
        square = left_to_do(arm, goal, frame, scratch)
        while square > TOLERANCE * TOLERANCE and sweep < LIMIT:
            _sweep(arm, goal, scratch, c)
            frame = forward(arm, c, joints, scratch.p, scratch.axes)
            square = left_to_do(arm, goal, frame, scratch)
            sweep += 1
        straighten_last(arm, frame, scratch, c)
    return sweep


@inner
def _sweep(arm: Arm, goal: Vector, scratch: Scratch, c: Array) -> None:
    p, axes, column = scratch.p, scratch.axes, first_column(arm, c)
    joints = axes.shape[0]
    x, y, z = p[joints, 0], p[joints, 1], p[joints, 2]
    for k in range(joints - 1, -1, -1):
        wx, wy, wz = goal[0] - p[k, 0], goal[1] - p[k, 1], goal[2] - p[k, 2]
        for s in (1, 0):
            ax, ay, az = axes[k, s, 0], axes[k, s, 1], axes[k, s, 2]
            vx, vy, vz = x - p[k, 0], y - p[k, 1], z - p[k, 2]
            tx, ty, tz = ay * vz - az * vy, az * vx - ax * vz, ax * vy - ay * vx
            along, level = ax * vx + ay * vy + az * vz, ax * wx + ay * wy + az * wz
            sine = tx * wx + ty * wy + tz * wz
            cosine = vx * wx + vy * wy + vz * wz - along * level
            size = sqrt(sine * sine + cosine * cosine)
            if size > 0.0:
                c[column + 2 * k + s] += atan2(sine, cosine)
                sine, cosine = sine / size, cosine / size
                rest = (1.0 - cosine) * along
                x = p[k, 0] + cosine * vx + sine * tx + rest * ax
                y = p[k, 1] + cosine * vy + sine * ty + rest * ay
                z = p[k, 2] + cosine * vz + sine * tz + rest * az


@kernel
def fabrik(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """Joint centres are pulled along by the target, then by the base; angles come at the end."""
    scratch, sweep, joints = new_scratch(arm, False), 0, arm.lean.size - 1
    p = scratch.p
    for _ in range(repeats):
        forward(arm, start, joints, p, scratch.axes)
        sweep, goal = 0, goal_of(arm, target, scratch)
        while _square(p, goal) > TOLERANCE * TOLERANCE and sweep < LIMIT:
            for i in range(3):
                p[joints, i] = goal[i]
            for k in range(joints - 1, -1, -1):
                _pull(p, k, k + 1, arm.link)
            for i in range(3):
                p[0, i] = 0.0
            for k in range(joints):
                _pull(p, k + 1, k, arm.link)
            sweep += 1
        straighten(arm, c)
        frame = BASE
        for k in range(joints):
            x, y, z = p[k + 1, 0] - p[k, 0], p[k + 1, 1] - p[k, 1], p[k + 1, 2] - p[k, 2]
            frame, _ = aim(arm, k, (x / arm.link, y / arm.link, z / arm.link), frame, c)
        straighten_last(arm, frame, scratch, c)
    return sweep


@inner
def _square(p: Array, goal: Vector) -> float:
    last, square = p.shape[0] - 1, 0.0
    for i in range(3):
        square += (goal[i] - p[last, i]) ** 2
    return square


@inner
def _pull(p: Array, moved: int, held: int, length: float) -> None:
    """Put one end of a link at its length from the other, in the direction where it is."""
    x, y, z = p[moved, 0] - p[held, 0], p[moved, 1] - p[held, 1], p[moved, 2] - p[held, 2]
    share = length / sqrt(x * x + y * y + z * z)
    p[moved, 0], p[moved, 1] = p[held, 0] + share * x, p[held, 1] + share * y
    p[moved, 2] = p[held, 2] + share * z


HEURISTICS = (
    IKSolver(name="CCD", solve=ccd, settings=f"reduced task, {LIMIT} sweeps"),
    IKSolver(name="FABRIK", solve=fabrik, settings=f"reduced task, {LIMIT} sweeps"),
)
