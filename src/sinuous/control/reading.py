"""What the multipliers of a plan say: which walls it leans on, and what limits the robot."""

from dataclasses import dataclass, field

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.control.step.data import BEND, RATE_LIMIT, STATE_LIMIT, TIP_SPEED
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot


@dataclass(frozen=True, kw_only=True)
class Active:
    """A constraint that the robot leans on.

    Arguments:
        name: what it is, in words
        multiplier: what relaxing it is worth, [cost / m] of wall or actuator
        triangle: of the zone, -1 if it is not a wall
    """

    name: str
    multiplier: float
    triangle: int = -1


def _nothing() -> IntArray:
    return np.zeros(0, dtype=np.int64)


@dataclass(frozen=True, kw_only=True, eq=False)
class Leaning:
    """Rows of the last QP with a multiplier, as the compiled step writes them.

    Arguments:
        what: kind of the row (A,), see `step.data.Meaning`
        index: of the limit or body point (A,)
        triangle: of a wall, else -1 (A,)
        strength: multipliers [cost / m] (A,)
    """

    what: IntArray = field(default_factory=_nothing)
    index: IntArray = field(default_factory=_nothing)
    triangle: IntArray = field(default_factory=_nothing)
    strength: Array = field(default_factory=lambda: np.zeros(0))

    def describe(self, robot: Robot, zone: SafeZone) -> tuple[Active, ...]:
        """Every constraint once, with its largest multiplier, the strongest first."""
        strongest = dict[str, Active]()
        for k in np.argsort(-self.strength, kind="stable"):
            name, triangle = self._name(int(k), robot, zone), int(self.triangle[k])
            one = Active(name=name, multiplier=float(self.strength[k]), triangle=triangle)
            strongest.setdefault(name, one)
        return tuple(strongest.values())

    def _name(self, k: int, robot: Robot, zone: SafeZone) -> str:
        what, index = self.what[k], int(self.index[k])
        actuators = robot.actuator_names
        if what == STATE_LIMIT and index < len(actuators):
            return f"{actuators[index]} at its length limit"
        if what == STATE_LIMIT:
            own = np.flatnonzero(np.any(np.isfinite(robot.coordinate_limits), axis=1))
            return f"{robot.coordinate_names[own[index - len(actuators)]]} at its limit"
        if what == RATE_LIMIT:
            return f"{actuators[index]} at its speed limit"
        if what == TIP_SPEED:
            return "tip at its speed limit"
        if what == BEND:
            return f"{robot.bend_names[index]} at its limit"
        wall = zone.describe_triangle(int(self.triangle[k]))
        return f"{wall} at {robot.point_name(index)}"
