"""Damped least squares with a collision penalty (paper B, section III-A, eq. 30-31).

The controller that the paper compares its own with. It knows no constraint: a wall is a cost
that is weighed against the tip's error, and limits of the actuators cut off what it asks for.
"""

from dataclasses import KW_ONLY, dataclass
from enum import Enum
from functools import cached_property
from math import isfinite
from time import perf_counter

import numpy as np

from sinuous.arrays import Array, ArrayLike, IntArray
from sinuous.control.observed import is_finite, observe
from sinuous.control.report import Command, Report, Status, hold_still
from sinuous.control.saturation import attainable, speed_share
from sinuous.control.terms import PRINTED_RATE
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.robots.robot import Robot

# A tip this close to its target is there [m]; a body whose points are all slower rests [m/s].
# The tip's error fades away exponentially, so it is slow long before it is there.
ARRIVED = 1e-5
STILL = 1e-6


class PenaltySign(Enum):
    """Which way the collision penalty pushes the body (notes B12)."""

    DESCENT = -1.0
    """Away from the wall."""
    PRINTED = 1.0
    """Up the penalty, into the wall: (30) as printed, to show that it is a misprint."""


@dataclass(frozen=True, kw_only=True, eq=False)
class DLSState:
    """What the controller remembers between steps.

    Arguments:
        c: configuration (n,) of the actuator lengths after the last command
    """

    c: Array


@dataclass(frozen=True, eq=False)
class DampedLeastSquares:
    """Steers the tip to a target and pushes disks that are too close away from the wall.

    The actuators move by u = k_j (J'J + W)^-1 (J' (p_d - p) - W dh/du) in a step (30), with
    W = c_w I and the penalty h = sum_i max(c_d - d(p_i), 0)^2 of the disks' centres p_i (31).

    - J is by the actuators, J_c L+: what comes out keeps the coupling rules (19).
    - As printed the penalty's sign is +, which climbs it (notes B12).
    - dh/du is `penalty` dh/dx. By (14) as printed the factor is dt, 1/30 s, and the penalty so soft
      that a winding passage does not hold the body. That k_j is a gain per step makes u a
      displacement and the factor 1: 30 times as stiff.
    - c_d is a distance of disk centres: the body's radius and the margin. More points than the
      disks would multiply the penalty's stiffness. The tip is excluded as printed, and so is what
      no actuator can move.
    - k_j is per step at 30 Hz. At another rate it removes as much of an error per second.

    The Jacobian is that of the encoders' lengths. The tip's error is that of the measured tip, a
    coil beyond it taken to be as far from it as the model says. The penalty sees the measured
    shape, or, with only the tip measured, the model's. Nothing makes up for a reading's age.
    Without a measurement the model stands in for the robot.

    Arguments:
        robot: any `Robot`
        zone: the room it may use; targets and points are in its frame
        margin: distance between body surface and wall from which on the penalty counts [m]
        dt: time between steps [s]
        gain: k_j, share of the error that a step at 30 Hz removes
        damping: c_w, for metres of tip by metres of actuator
        penalty: dh/du by dh/dx
        sign: of the penalty

    Raises:
        ValueError: if margin, dt, gain, damping or penalty make no sense
    """

    robot: Robot
    zone: SafeZone
    _: KW_ONLY
    margin: float = 0.0
    dt: float = 1 / 30
    gain: float = 0.05
    damping: float = 1.0
    penalty: float = 1.0 / PRINTED_RATE
    sign: PenaltySign = PenaltySign.DESCENT

    def __post_init__(self) -> None:
        if not (isfinite(self.margin) and self.margin >= 0.0):
            raise ValueError(f"margin must be a length of zero or more, not {self.margin}")
        if not (isfinite(self.dt) and self.dt > 0.0):
            raise ValueError(f"dt must be a positive time, not {self.dt}")
        if not 0.0 < self.gain <= 1.0:
            raise ValueError(f"gain must be above 0 and at most 1, not {self.gain}")
        if not (isfinite(self.damping) and self.damping > 0.0):
            raise ValueError(f"damping must be positive, not {self.damping}")
        if not (isfinite(self.penalty) and self.penalty >= 0.0):
            raise ValueError(f"penalty must be zero or more, not {self.penalty}")

    @property
    def gain_per_step(self) -> float:
        """k_j at this controller's rate: what is left of an error decays as it does at 30 Hz."""
        return 1.0 - (1.0 - self.gain) ** (PRINTED_RATE * self.dt)

    @cached_property
    def guarded(self) -> IntArray:
        """Which body points have a penalty: disks that move, but for the tip (31)."""
        disks = self.robot.disk_indices
        return disks[self.robot.movable[disks] & (disks != len(self.robot.radii) - 1)]

    def collision_cost(self, points: Array) -> tuple[float, Array]:
        """h (31) [m^2] of body points (S, 3) [m], and its derivative by them (S, 3) [m]."""
        gradient, disks = np.zeros_like(points), self.guarded
        near = self.zone.nearest(points[disks])
        missing = np.maximum(self.robot.radii[disks] + self.margin - near.clearance, 0.0)
        gradient[disks] = -2.0 * missing[:, None] * near.gradient
        return float(missing @ missing), gradient

    def displacement(self, c: Array, error: Array, points: Array) -> Array:
        """u (P,) [m] of (30), what the actuators should move by until the next step.

        With (J'J + W)^-1 = (I - J'(JJ' + W)^-1 J) / c_w this is k_j (g + J'(JJ' + c_w I)^-1 (e -
        J g)), g being the push of the walls: what it does to the tip is all but undone.

        Arguments:
            c: configuration (n,) of the Jacobian
            error: p_d - p of the tip (3,) [m]
            points: of the body, where the walls are felt (S, 3) [m]
        """
        jacobian, L = self.robot.points_jacobian(c), self.robot.lengths_jacobian(c)
        _, slope = self.collision_cost(points)
        push = self.sign.value * self.penalty * np.einsum("sdn,sd->n", jacobian, slope)
        J = jacobian[-1]
        # By c: L+ L+' = (L'L)^-1 stands where the actuators' unit matrix stood.
        both = np.linalg.solve(L.T @ L, np.column_stack([J.T, push]))
        to_tip, g = both[:, :3], both[:, 3]
        damped = J @ to_tip + self.damping * np.eye(3)
        change = g + to_tip @ np.linalg.solve(damped, error - J @ g)
        return self.gain_per_step * L @ change

    def init(self, c: ArrayLike) -> DLSState:
        """The state to start from, at rest at configuration c (n,).

        Raises:
            ValueError: if c has not the robot's coordinates
        """
        start = np.array(c, dtype=float)
        if start.shape != self.robot.home.shape:
            raise ValueError(f"c must have {len(self.robot.home)} coordinates, not {start.shape}")
        return DLSState(c=start)

    def step(
        self, state: DLSState, target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[DLSState, Command]:
        """One control step towards target (3,) [m]; never raises for bad numbers.

        What is not finite is a fault: the robot holds still and the report says why.
        """
        began, goal = perf_counter(), np.array(target, dtype=float)
        if fault := _fault(state, goal, measured):
            return self._hold(state, fault, began)
        lengths = self.robot.lengths(state.c) if measured is None else measured.lengths
        with np.errstate(all="ignore"):  # numbers may be finite and too large to compute with
            c = self.robot.configuration(lengths)
            model = self.robot.points(c)
            tip, points = self._seen(c, model, measured)
            u = self.displacement(c, goal - tip, points)
            rates = self._attainable(lengths, u / self.dt)
            if not np.all(np.isfinite(rates)):
                return self._hold(state, "the command is not finite", began)
            after = DLSState(c=self.robot.configuration(lengths + self.dt * rates))
            moved = self.robot.points(after.c) - model
            status = self._status(goal - tip - moved[-1], moved)
        report = Report(
            status=status,
            solve_time=perf_counter() - began,
            step_fraction=1.0,
            points=model + moved,
            robot=self.robot,
            zone=self.zone,
        )
        return after, Command(rates=rates, report=report)

    def _attainable(self, lengths: Array, rates: Array) -> Array:
        # First the speed, then the stops: far from a target the Jacobian's step may be so long
        # that its end says nothing about where the next short piece of it runs into a stop.
        rates = rates * speed_share(self.robot, rates)
        return attainable(self.robot, lengths, rates, self.dt)

    def _seen(self, c: Array, model: Array, measured: Measurement | None) -> tuple[Array, Array]:
        """Tip (3,) and body points (S, 3) [m], those of the model where nothing is measured."""
        if measured is None:
            return model[-1], model
        seen = observe(self.robot, measured, (c,), self.dt)
        return seen.tip, seen.points if seen.has_shape else model

    def _status(self, error: Array, moved: Array) -> Status:
        if np.linalg.norm(error) < ARRIVED:
            return Status.AT_TARGET
        fastest = float(np.max(np.linalg.norm(moved, axis=1)))
        return Status.BLOCKED if fastest < STILL * self.dt else Status.TRACKING

    def _hold(self, state: DLSState, reason: str, began: float) -> tuple[DLSState, Command]:
        return state, hold_still(self.robot, self.zone, state.c, reason, began)


def _fault(state: DLSState, goal: Array, measured: Measurement | None) -> str:
    """What cannot be computed with, in words; empty if all is well."""
    if goal.shape != (3,) or not np.all(np.isfinite(goal)):
        return "the target is not three finite numbers"
    if not np.all(np.isfinite(state.c)):
        return "the state is not finite"
    if measured is not None and not is_finite(measured):
        return "the measurement is not finite"
    return ""
