"""The local controller against disturbances (paper B, section II-D, eq. 21-28)."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control.metric import actuator_metric
from sinuous.control.observed import Observed
from sinuous.robots.robot import Robot


@dataclass(frozen=True, kw_only=True)
class LocalController:
    """Steers the measured body towards the nominal one, the tip first.

    K_loc = k_EE J+ D_EE + k_body (I - J+ J) g  (21), with J+ damped (23) and g the descent
    direction of the mean squared distance of the disks (26), (27).  As printed, k_body has no
    scale of its own: the same number is sluggish for one robot and unstable for another.  Here
    g is divided by the largest curvature of (26) that the tip leaves free, so that both gains
    are rates of decay: that of the tip's error, and that of the body's in its stiffest direction
    beside it.

    Jacobians are analytic and in actuator coordinates, J_c L+, so what comes out keeps the
    coupling rules (19).

    Arguments:
        tip_gain: k_EE [1/s]
        body_gain: k_body [1/s]
        damping: lambda of (23), for metres of tip by metres of actuator
        share: eta, of the actuators' speed limits, that the plan leaves to it (notes B13)

    Raises:
        ValueError: if a gain or the damping is negative, or the share not within 0 and 1
    """

    tip_gain: float = 30.0
    body_gain: float = 5.0
    damping: float = 0.3
    share: float = 0.2

    def __post_init__(self) -> None:
        values = (self.tip_gain, self.body_gain, self.damping)
        if not all(np.isfinite(v) and v >= 0.0 for v in values) or self.damping == 0.0:
            raise ValueError("gains must be zero or more, the damping positive")
        if not 0.0 <= self.share < 1.0:
            raise ValueError(f"share must be at least 0 and below 1, not {self.share}")

    def rates(self, robot: Robot, seen: Observed, goal: Array, dt: float) -> Array:
        """Actuator rates (P,) [m/s] that bring what is seen to the nominal body.

        Arguments:
            seen: the body as it is now
            goal: where its points should be (S, 3) [m]
            dt: time until the next measurement [s]; no gain removes more than all of an error
        """
        to_actuators = np.linalg.inv(actuator_metric(robot))
        jacobian = robot.points_jacobian(seen.c) @ to_actuators
        J = jacobian[-1]
        # (J'J + lambda I)^-1 J' and J'(JJ' + lambda I)^-1 are the same; the latter is 3 x 3.
        inverse = J.T @ np.linalg.inv(J @ J.T + self.damping * np.eye(3))
        fastest = 1.0 / dt
        v = min(self.tip_gain, fastest) * inverse @ (goal[-1] - seen.tip)
        if seen.has_shape:
            disks = robot.disk_indices[robot.disk_indices != len(goal) - 1]
            body, error = jacobian[disks], (goal - seen.points)[disks]
            free = np.eye(len(v)) - inverse @ J
            moved = (body @ free).reshape(-1, len(v))
            stiffest = float(np.linalg.eigvalsh(moved.T @ moved)[-1])
            g = np.einsum("sdi,sd->i", body, error) / stiffest
            v += min(self.body_gain, fastest) * free @ g
        return robot.lengths_jacobian(seen.c) @ to_actuators @ v
