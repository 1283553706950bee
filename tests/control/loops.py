"""Closed loops of the controller, judged on things the controller does not compute itself."""

from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np

from sinuous.arrays import Array
from sinuous.control.mpc import MPCState, ShapeConstrainedMPC
from sinuous.control.report import Command, Status
from sinuous.robots.pcc import PccRobot

DENSE = 0.25e-3  # the body surface is judged this densely [m]
BETWEEN = (0.25, 0.5, 0.75, 1.0)  # shares of a step at which it is judged
REST = 1e-4  # a body slower than this is at rest [m/s]
REST_STEPS = 10

# Rounding of a rate: lengths of 0.1 m differ in their last bit, over a step of 1/30 s.
RATE_ROUNDING = 1e-12
LENGTH_ROUNDING = 1e-12


@dataclass
class Judged:
    """What a closed loop did."""

    worst_margin: float = np.inf  # least body clearance beyond the margin [m]
    worst_rate: float = 0.0  # largest |rate| in units of its limit
    worst_length: float = np.inf  # least distance to a length limit [m]
    worst_bend: float = np.inf  # least bend slack [m]
    holds: int = 0
    commands: list[Command] = field(default_factory=list[Command])
    moves: list[float] = field(default_factory=list[float])  # of the body, per step [m]


def drive(
    mpc: ShapeConstrainedMPC,
    state: MPCState,
    targets: Iterable[Array],
    *,
    steps: int = 300,
    judged: Judged | None = None,
) -> tuple[MPCState, Judged]:
    """Hold each target until rest or for a number of steps."""
    robot = mpc.robot
    assert isinstance(robot, PccRobot)
    dense, judged = robot.sampled(DENSE), judged or Judged()
    for target in targets:
        still = 0
        for _ in range(steps):
            before = state
            state, command = mpc.step(state, target)
            judge(mpc, dense, before.c, state.c, command, judged)
            still = still + 1 if judged.moves[-1] < REST * mpc.dt else 0
            if still == REST_STEPS:
                break
    return state, judged


def judge(
    mpc: ShapeConstrainedMPC,
    dense: PccRobot,
    start: Array,
    end: Array,
    command: Command,
    judged: Judged,
) -> None:
    """Look at one step: walls on the way, limits, status."""
    way = np.array([start + share * (end - start) for share in BETWEEN])
    clearance = mpc.zone.clearance(dense.points(way)) - dense.radii
    limits = mpc.robot.length_limits
    lengths = mpc.robot.lengths(end)
    judged.worst_margin = min(judged.worst_margin, float(clearance.min()) - mpc.margin)
    used = np.abs(command.rates) / mpc.robot.rate_limits[:, 1]
    judged.worst_rate = max(judged.worst_rate, float(used.max()))
    room = np.minimum(lengths - limits[:, 0], limits[:, 1] - lengths)
    judged.worst_length = min(judged.worst_length, float(room.min()))
    judged.worst_bend = min(judged.worst_bend, float(mpc.robot.bend_slack(end).min()))
    judged.holds += command.report.status is Status.HOLDING
    judged.commands.append(command)
    moved = np.linalg.norm(mpc.robot.points(end) - mpc.robot.points(start), axis=1)
    judged.moves.append(float(moved.max()))


def assert_limits_kept(judged: Judged) -> None:
    """Nothing moved faster, further or more sharply than allowed."""
    assert judged.worst_rate <= 1.0 + RATE_ROUNDING
    assert judged.worst_length >= -LENGTH_ROUNDING
    assert judged.worst_bend >= -LENGTH_ROUNDING
