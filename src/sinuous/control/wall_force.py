"""What walls hold back: multipliers of wall planes, mapped to the tip.

Where the controller rests, the gradient of its cost by a stage's configuration is balanced by the
constraints it leans on,

    2 w J_tip' (target - tip) = - sum_i J_i' push_i + (posture, in the tip's null space),

with the weight w of the tip's error and push_i = lambda_i n_i [cost / m], the multiplier of a wall
plane times its normal at body point i. Divided by 2 w a push is a length: a spring of any stiffness
K from the tip to the target pulls with K times as much, so K push_i / 2w is the force of that wall
on that point, and K way with

    way = (J J' + mu)^-1 J sum_i J_i' push_i / 2w          (J, J_i by actuator metres)

is the force of all walls as it is felt at the tip: what (J')^+ gives in the controller's own
metric, damped like the null space of its posture. A direction in which the tip cannot move gives
no force.

Only walls count, no limits of speed: in free motion the way is zero, however far behind the tip
is. At rest it is tip - target. While the body moves, and where not all rows can be kept,
multipliers may be larger; walls cannot hold back more than is pulled, so the way is no longer than
the target is from the tip.
"""

from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.control.metric import actuator_inverse
from sinuous.control.step.linearise import NULL_SPACE_DAMPING
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot

NOWHERE = np.zeros(3)
NOWHERE.setflags(write=False)


@dataclass(frozen=True, kw_only=True, eq=False)
class Walls:
    """Walls that a stage of a plan leans on; the force of a tip spring K is K times the lengths.

    Arguments:
        robot: whose body it is
        c: configuration of the stage (n,)
        point: body points that lean (k,)
        push: of the walls on them, away from the wall (k, 3) [m]
        goal: of the tip, as the plan has it (3,) [m]
    """

    robot: Robot = field(repr=False)
    c: Array
    point: IntArray
    push: Array
    goal: Array

    @cached_property
    def way(self) -> Array:
        """How far the walls hold the tip back from the target, at the tip (3,) [m]."""
        return self._share * self._mapped

    @cached_property
    def pushed(self) -> int:
        """The body point that walls push the most; the base's if there is none."""
        return int(self.point[int(np.argmax(self._sizes))]) if np.any(self._sizes) else 0

    @cached_property
    def body(self) -> Array:
        """The push of all walls on that point (3,) [m]."""
        here = self.point == self.pushed
        return self._share * np.sum(self.push[here], axis=0) if np.any(self._sizes) else NOWHERE

    @cached_property
    def _sizes(self) -> Array:
        """Of what pushes the point of each push, all walls there together (k,) [m]."""
        same = self.point[:, None] == self.point[None]
        return np.linalg.norm(same @ self.push, axis=1)

    @cached_property
    def _mapped(self) -> Array:
        if not np.any(self.push):
            return NOWHERE
        return at_tip(self.robot, self.c, self.point, self.push)

    @property
    def _pull(self) -> float:
        return float(np.linalg.norm(self.goal - self.robot.tip(self.c)))

    @cached_property
    def _share(self) -> float:
        size, most = float(np.linalg.norm(self._mapped)), self._pull
        return most / size if size > most else 1.0


def at_tip(robot: Robot, c: Array, point: IntArray, push: Array) -> Array:
    """The force at the tip (3,) that does what forces on the body do, see above.

    Arguments:
        c: configuration (n,)
        point: where they act (k,)
        push: the forces, in any unit (k, 3)
    """
    J, inverse = robot.points_jacobian(c), actuator_inverse(robot)
    tip, pushed = J[-1] @ inverse, np.einsum("ki,kin->n", push, J[point]) @ inverse
    return np.linalg.solve(tip @ tip.T + NULL_SPACE_DAMPING * np.eye(3), tip @ pushed)


def closeness(robot: Robot, zone: SafeZone, c: Array, distance: Array, reach: float) -> Array:
    """How much closer than reach the body is to a wall at its closest point, at the tip (3,) [m].

    Zero while every point has that much room; at the margin, the reach along the wall's normal,
    mapped to the tip.

    Arguments:
        c: configuration (n,)
        distance: that the body's points keep (S,) [m]
        reach: [m]
    """
    near = zone.nearest(robot.points(c))
    room = np.where(robot.movable, near.clearance - distance, np.inf)
    closest = int(np.argmin(room))
    missing = reach - float(room[closest])
    if missing <= 0.0:
        return np.zeros(3)
    return at_tip(robot, c, np.array([closest]), missing * near.gradient[closest : closest + 1])
