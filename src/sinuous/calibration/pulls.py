"""Single-cable pulls tell which motor is which cable, which way it pulls, and where the base is."""

from dataclasses import dataclass

import numpy as np
from scipy.optimize import linear_sum_assignment

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.calibration.recording import Recording
from sinuous.errors import InputError
from sinuous.robots.pcc import PccRobot

# Share of the largest motor motion by which one motor has to stand out from the others.
STANDS_OUT = 0.2
# Rows of a pull whose tip has moved by at least this share of the farthest show its direction.
FAR = 0.3
# Motion of the tip, as a share of the length, within which it is nearly across the axis.
NEAR = 0.35
FEWEST_ROWS = 3
# What a cable is recognised by: direction of the tip [rad], and its motion by that of the motor.
DIRECTION_SPREAD, GAIN_SPREAD = np.deg2rad(15.0), 0.15
# Says which of two numberings to take that fit equally well.
IN_ORDER = 0.01
# Share of the largest reading that all motors but one exceed while one cable is pulled.
LET_GO = 0.6


@dataclass(frozen=True, kw_only=True, eq=False)
class Identified:
    """Which motor is which cable, and where the base is, roughly.

    Arguments:
        motors: column of the recording that pulls each cable (C,)
        directions: +1 if larger readings of that motor pull (C,)
        T_t_b: pose of the base in the tracker's frame (4, 4)
        mismatch: root mean square of the angle between the cables as they pull and those of the
            robot file [rad]; nan without pulls
    """

    motors: IntArray
    directions: Array
    T_t_b: Array
    mismatch: float

    def pulls(self, recording: Recording) -> Array:
        """By how much the motors pull the robot's cables (T, C) [m]."""
        return recording.readings[:, self.motors] * self.directions


@dataclass(frozen=True, kw_only=True, eq=False)
class _Response:
    """How the tip answers one motor."""

    direction: float  # of the motor: +1 or -1
    way: Array  # where the tip goes (3,) [m]
    gain: float  # tip motion by motor motion


def are_pulls(recording: Recording) -> BoolArray:
    """Rows (T,) of movements during which all cables but one are let go."""
    size = np.abs(recording.readings)
    second = np.sort(size, axis=1)[:, 1]
    row = second > LET_GO * float(np.max(size))
    share = np.bincount(recording.patterns, weights=row) / np.bincount(recording.patterns)
    return np.asarray(share[recording.patterns] > 0.5)


def middle(points: Array) -> Array:
    """Point (3,) with the least sum of distances to points (T, 3), by Weiszfeld's iteration."""
    out = np.median(points, axis=0)
    for _ in range(50):
        weight = 1.0 / np.maximum(np.linalg.norm(points - out, axis=1), 1e-6)
        out = weight @ points / np.sum(weight)
    return np.asarray(out)


def body_axis(tips: Array, rest: Array, length: float) -> Array:
    """Direction (3,) from base to tip of the straight robot, from how its tip moves.

    Near the straight shape the tip moves across the axis; far from it, back towards the base.
    """
    away = tips - rest
    near = np.linalg.norm(away, axis=1) < NEAR * length
    axis = np.linalg.svd(away[near] - away[near].mean(axis=0), full_matrices=False)[2][2]
    return np.asarray(-axis if float(np.mean(away @ axis)) > 0.0 else axis)


def identify(pulls: Recording, robot: PccRobot) -> Identified:
    """Return which motor is which cable.

    Raises:
        InputError: if some motor never pulls alone
    """
    rest = middle(pulls.tips)
    active = _active(pulls)
    responses = [_response(pulls, active == m, m, rest) for m in range(len(pulls.motors))]
    length = sum(segment.home_length for segment in robot.segments)
    axis = body_axis(pulls.tips, rest, length)
    across = _across(axis)
    seen = np.array([np.arctan2(r.way @ across[1], r.way @ across[0]) for r in responses])
    gains = np.log([response.gain for response in responses])
    angles, expected = cable_angles(robot), np.log(expected_gains(robot))
    # A robot with its base turned by the angle between cables is the same robot with other
    # numbers: of those take the one in the order of the columns.
    other = IN_ORDER * (np.arange(len(seen))[:, None] != np.arange(len(seen)))
    turn, columns, cost = 0.0, np.arange(len(seen)), np.inf
    for candidate in np.deg2rad(np.arange(0.0, 360.0, 1.0)):
        off = _wrapped(seen[:, None] - angles - candidate) / DIRECTION_SPREAD
        ratio = gains[:, None] - expected - np.mean(gains) + np.mean(expected)
        table = off**2 + (ratio / GAIN_SPREAD) ** 2 + other
        rows, cables = linear_sum_assignment(table)
        if (total := float(table[rows, cables].sum())) < cost:
            turn, columns, cost = float(candidate), np.argsort(cables), total
    off = _wrapped(seen[columns] - angles - turn)
    return Identified(
        motors=columns,
        directions=np.array([responses[m].direction for m in columns]),
        T_t_b=base_pose(axis, turn, rest, length),
        mismatch=float(np.sqrt(np.mean((off - np.mean(off)) ** 2))),
    )


def cable_angles(robot: PccRobot) -> Array:
    """Angles (C,) [rad] of all cables."""
    return np.concatenate([segment.cable_angles for segment in robot.segments])


def expected_gains(robot: PccRobot) -> Array:
    """Tip motion by cable motion (C,) if one cable bends all it passes by one curvature."""
    lengths = np.array([segment.home_length for segment in robot.segments])
    ends = np.cumsum(lengths)
    levers = lengths * (ends[-1] - ends + 0.5 * lengths)
    gain = np.cumsum(levers) / ends
    return np.concatenate(
        [gain[j] / np.array(segment.pitch_radii) for j, segment in enumerate(robot.segments)]
    )


def base_pose(axis: Array, turn: float, rest: Array, length: float) -> Array:
    """Pose (4, 4) of a base whose axis points to a tip at rest, turned about it by `turn` [rad]."""
    x, y = _across(axis)
    T = np.eye(4)
    T[:3, 0] = np.cos(turn) * x + np.sin(turn) * y
    T[:3, 1] = np.cos(turn) * y - np.sin(turn) * x
    T[:3, 2], T[:3, 3] = axis, rest - length * axis
    return T


def _across(axis: Array) -> tuple[Array, Array]:
    """Two directions that make a right-handed frame with an axis."""
    x = np.eye(3)[int(np.argmin(np.abs(axis)))]
    x = x - (x @ axis) * axis
    x = x / np.linalg.norm(x)
    return x, np.asarray(np.cross(axis, x), dtype=float)


def _wrapped(angle: Array) -> Array:
    return np.asarray((angle + np.pi) % (2.0 * np.pi) - np.pi)


def _active(pulls: Recording) -> IntArray:
    """Motor (T,) that alone is away from where it is let go, -1: none.

    Most of the time every motor is let go, so its median says where that is.
    """
    apart = np.abs(pulls.readings - np.median(pulls.readings, axis=0))
    others = np.sort(apart, axis=1)[:, -2]
    alone = np.max(apart, axis=1) - others > STANDS_OUT * float(np.max(apart))
    return np.asarray(np.where(alone, np.argmax(apart, axis=1), -1))


def _response(pulls: Recording, rows: BoolArray, motor: int, rest: Array) -> _Response:
    if np.count_nonzero(rows) < FEWEST_ROWS:
        raise InputError(
            file=pulls.file,
            field=f"column {pulls.motors[motor]}",
            expected="rows in which this motor alone pulls, and all others let go",
            found=f"{np.count_nonzero(rows)} such rows",
            remedy="Record every cable alone, or leave --pulls out: motors are then taken to be "
            "in the order of the robot's cables.",
        )
    reading, away = pulls.readings[rows, motor], pulls.tips[rows] - rest
    moved = np.linalg.norm(away, axis=1)
    direction = 1.0 if np.mean((reading - reading.mean()) * (moved - moved.mean())) >= 0.0 else -1.0
    far = moved >= FAR * np.max(moved)
    way, taut = away[far].mean(axis=0), direction * reading[far]
    spread = taut - taut.mean()
    slope = float(spread @ (away[far] @ way)) / float(np.linalg.norm(way))
    gain = slope / max(float(spread @ spread), 1e-12)
    return _Response(direction=direction, way=way, gain=max(gain, 1e-3))
