"""One solver on many targets: what it answers, how long that takes, and what it is worth."""

from collections.abc import Sequence
from dataclasses import dataclass
from time import process_time_ns
from typing import Self

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.bench.ik_peers.solver import TOLERANCE, IKSolver
from sinuous.bench.loop import NS_PER_S, no_garbage_collection
from sinuous.bench.result import Row
from sinuous.control.geometric_ik import GeometricIK
from sinuous.robots.bending import bends
from sinuous.view.units import MM_PER_M

US_PER_S, UM_PER_M = 1e6, 1e6

# A solution takes less than the clock can tell: it is repeated in compiled code until the clock
# has run for so long, and the least of a few such times counts.
BATCH_NS, MOST_REPEATS, ROUNDS = 100_000, 1024, 3

# What rounding may add to an error that a solver found to be within the tolerance.
ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True, eq=False)
class IKAnswers:
    """What a solver said to targets (T, 3).

    Arguments:
        targets: (T, 3) [m]
        c: configurations (T, n)
        time: processor time of each (T,) [s]
        iterations: (T,)
        follows: whether the target is the next on the path of the one before (T,)
    """

    targets: Array
    c: Array
    time: Array
    iterations: IntArray
    follows: BoolArray

    @classmethod
    def joined(cls, answers: Sequence[Self]) -> Self:
        """Those of several paths."""
        return cls(
            targets=np.concatenate([each.targets for each in answers]),
            c=np.concatenate([each.c for each in answers]),
            time=np.concatenate([each.time for each in answers]),
            iterations=np.concatenate([each.iterations for each in answers]),
            follows=np.concatenate([each.follows for each in answers]),
        )


def ask(
    solver: IKSolver, ik: GeometricIK, targets: Array, start: Array, *, warm: bool
) -> IKAnswers:
    """Solve for every target (T, 3).

    Arguments:
        start: configuration to start from (n,)
        warm: start from the last solution instead, but for the first target
    """
    count = len(targets)
    c, time, iterations = np.empty((count, len(start))), np.empty(count), np.empty(count, np.int64)
    with no_garbage_collection():
        for i, target in enumerate(targets):
            begin = c[i - 1] if warm and i > 0 else start
            time[i], iterations[i] = _measure(solver, ik, target, begin, c[i])
    follows = np.arange(count) > 0
    return IKAnswers(targets=targets, c=c, time=time, iterations=iterations, follows=follows)


def _measure(
    solver: IKSolver, ik: GeometricIK, target: Array, start: Array, c: Array
) -> tuple[float, int]:
    def once(repeats: int) -> tuple[float, int]:
        began = process_time_ns()
        iterations = solver.solve(ik.arm, target, start, c, repeats)
        return (process_time_ns() - began) / repeats, iterations

    repeats = 1
    while repeats < MOST_REPEATS and once(repeats)[0] * repeats < BATCH_NS:
        repeats *= 4
    times, iterations = zip(*(once(repeats) for _ in range(ROUNDS)), strict=True)
    return min(times) / NS_PER_S, iterations[0]


def judge(ik: GeometricIK, answers: IKAnswers) -> Row:
    """Numbers of answers, by the robot's own kinematics."""
    robot = ik.robot
    pose = robot.tip_pose(answers.c)
    error = np.linalg.norm(pose[:, :3, 3] - answers.targets, axis=1)
    across = np.linalg.norm(np.cross(pose[:, :3, 1], robot.T_w_b[:3, 1]), axis=1)
    solved = np.maximum(error, ik.arm.last * across) <= TOLERANCE * (1.0 + ROUNDING)
    bent = bends(robot.bend_limits, answers.c)
    time = answers.time * US_PER_S
    return {
        "targets": len(answers.targets),
        "median_us": float(np.median(time)),
        "p99_us": float(np.percentile(time, 99)),
        "max_us": float(time.max()),
        "solved": float(np.mean(solved)),
        "tip_error_median_um": float(np.median(error[solved])) * UM_PER_M,
        "tip_error_max_um": float(error[solved].max(initial=0.0)) * UM_PER_M,
        "iterations_median": float(np.median(answers.iterations)),
        "iterations_p99": float(np.percentile(answers.iterations, 99)),
        "iterations_max": int(answers.iterations.max()),
        "within_joint_limits": float(np.mean(np.all(bent <= robot.bend_limit, axis=-1))),
        "largest_bend_deg": float(np.degrees(bent.max())),
    }


def joint_motion(answers: IKAnswers) -> Array:
    """Change of every angle by the target's way, step by step (K, n) [rad/m]."""
    change, way = np.diff(answers.c, axis=0), np.diff(answers.targets, axis=0)
    return (change / np.linalg.norm(way, axis=1)[:, None])[answers.follows[1:]]


def smoothness(answers: IKAnswers) -> Row:
    """How smoothly the joints move along the paths."""
    motion = joint_motion(answers) / MM_PER_M
    return {
        "motion_rms_rad_mm": float(np.sqrt(np.mean(np.sum(motion**2, axis=1)))),
        "motion_max_rad_mm": float(np.abs(motion).max()),
    }
