"""From a reading of some time ago to the body as it is now."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.measurement import Measurement
from sinuous.robots.robot import Robot

HISTORY = 64
"""Steps that are remembered; a reading older than that counts as that old."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Observed:
    """Where the body is now, as far as is known.

    Arguments:
        c: configuration of the encoders' lengths (n,)
        tip: (3,) [m]
        points: guarded body points (S, 3) [m]; (0, 3) if only the tip is measured
    """

    c: Array
    tip: Array
    points: Array

    @property
    def has_shape(self) -> bool:
        """Whether the whole body was measured."""
        return len(self.points) > 0


def remember(past: tuple[Array, ...], c: Array) -> tuple[Array, ...]:
    """The configurations of the last steps, the newest last, with one more."""
    return (*past[1 - HISTORY :], c)


def observe(robot: Robot, measured: Measurement, past: tuple[Array, ...], dt: float) -> Observed:
    """What a reading says about now.

    A reading is late, but encoders are not: what the model says that the body moved since then
    is added, so a delay costs no stability (a Smith predictor).  A coil beyond the tip is taken
    to be as far from the tip as the model says.

    Arguments:
        measured: the newest reading
        past: configurations (n,) by the encoders at the end of each step, that of now the last
        dt: time between them [s]
    """
    now, then = past[-1], _before(past, measured.age / dt)
    moved = robot.points(now) - robot.points(then)
    coil = robot.tip_pose(then)[:3, :3] @ measured.coil
    tip = measured.tip - coil + moved[-1]
    points = measured.points + moved if measured.has_shape else measured.points
    return Observed(c=now, tip=tip, points=points)


def _before(past: tuple[Array, ...], steps: float) -> Array:
    """The configuration some steps ago, between the two that are known."""
    back = min(max(steps, 0.0), len(past) - 1.0)
    whole = int(back)
    share = back - whole
    newer = past[-1 - whole]
    return newer if share == 0.0 else (1.0 - share) * newer + share * past[-2 - whole]


def is_finite(measured: Measurement) -> bool:
    """Whether every number of a measurement that a controller reads is finite."""
    values = (measured.tip, measured.lengths, measured.points, measured.coil)
    return np.isfinite(measured.age) and all(bool(np.all(np.isfinite(v))) for v in values)
