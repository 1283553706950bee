"""Without single pulls: motors in the order of the cables, and the base found by trying."""

import numpy as np

from sinuous.arrays import Array
from sinuous.calibration.parameters import parameters
from sinuous.calibration.problem import Problem, Sequence
from sinuous.calibration.pulls import Identified, base_pose, body_axis
from sinuous.calibration.recording import Recording
from sinuous.robots.pcc import PccRobot

TURNS = np.deg2rad(np.arange(0.0, 360.0, 30.0))


def guess(data: Recording, robot: PccRobot) -> Identified:
    """Try directions of the motors and turns of the base; take what comes nearest."""
    rest = data.tips[np.argmin(np.max(np.abs(data.readings), axis=1))]
    length = sum(segment.home_length for segment in robot.segments)
    axis = body_axis(data.tips, rest, length)
    count = len(data.motors)
    tried = [
        Identified(
            motors=np.arange(count),
            directions=np.full(count, direction),
            T_t_b=base_pose(axis, turn, rest, length),
            mismatch=float("nan"),
        )
        for direction in (1.0, -1.0)
        for turn in TURNS
    ]
    errors = [_error(each, data, robot) for each in tried]
    return tried[int(np.argmin(errors))]


def _error(identified: Identified, data: Recording, robot: PccRobot) -> float:
    sequence = Sequence(
        pulls=identified.pulls(data), tips=data.tips, patterns=data.patterns, own_zeros=False
    )
    problem = Problem(
        robot=robot,
        identified=identified,
        parameters=parameters(robot, own_zeros=False),
        sequences=(sequence,),
    )
    errors: Array = problem.residuals(problem.start)
    return float(np.mean(np.linalg.norm(errors - np.mean(errors, axis=0), axis=1)))
