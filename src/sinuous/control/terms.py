"""What a controller wants and what it must not do, as small objects.

A cost contributes a quadratic around the predicted configuration, a constraint contributes
linear rows.  The solver loop adds them up and knows none of them by name.  Coordinates are
delta = c - c_bar of one stage of the horizon, or the increment v from one stage to the next.
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.control.stage import Stage, actuator_metric
from sinuous.robots.robot import Robot

# Step rate at which paper B states its input weight [Hz]. The weight is applied to the
# displacement per step, so it means the same at every rate (notes B6).
PRINTED_RATE = 30.0


@dataclass(frozen=True, kw_only=True)
class Quadratic:
    """The cost 1/2 delta' H delta + g' delta."""

    hessian: Array  # (n, n), positive semi-definite
    gradient: Array  # (n,)


@dataclass(frozen=True, kw_only=True)
class Rows:
    """The conditions lower <= A delta <= upper, in metres.

    Arguments:
        jacobian: A (m, n)
        lower, upper: (m,), infinite where there is no condition
        names: what each row means, for reports; empty for what is no limit of the robot
    """

    jacobian: Array
    lower: Array
    upper: Array
    names: tuple[str, ...]


class Cost(Protocol):
    """A cost of one predicted configuration."""

    def quadratic(self, stage: Stage, target: Array) -> Quadratic:
        """Its second-order model at the stage; target (3,) [m]."""
        ...

    def force(self, stage: Stage, target: Array) -> Array | None:
        """Its gradient (3,) by the tip's position, if it has one, for the curvature."""
        ...

    def value(self, stage: Stage, target: Array, around: Stage) -> float:
        """What it amounts to at a stage near `around`, where the model was taken."""
        ...


class IncrementCost(Protocol):
    """A quadratic cost of the increments v between stages."""

    def hessian(self, robot: Robot) -> Array:
        """H (n, n) of 1/2 v' H v."""
        ...


class StateLimit(Protocol):
    """Hard linear limits of a predicted configuration; convex, and kept exactly."""

    def rows(self, stage: Stage) -> Rows: ...


class IncrementLimit(Protocol):
    """Limits of the increments v, of which standing still is always one solution."""

    def rows(self, stage: Stage, dt: float) -> Rows: ...

    def fraction(self, start: Stage, end: Stage, dt: float) -> float:
        """Largest share of the step from start to end that the limit allows."""
        ...


@dataclass(frozen=True, kw_only=True)
class TipError:
    """weight |tip - target|^2, the first term of (10)."""

    weight: float

    def quadratic(self, stage: Stage, target: Array) -> Quadratic:
        J = stage.jacobian[-1]
        return Quadratic(
            hessian=2.0 * self.weight * J.T @ J,
            gradient=2.0 * self.weight * J.T @ (stage.tip - target),
        )

    def force(self, stage: Stage, target: Array) -> Array:
        return 2.0 * self.weight * (stage.tip - target)

    def value(self, stage: Stage, target: Array, around: Stage) -> float:
        return self.weight * float(np.sum((stage.tip - target) ** 2))


@dataclass(frozen=True, kw_only=True)
class Posture:
    """weight |P (c - home)|^2 in actuator metres, with P the null space of the tip.

    It straightens the body without a force on the tip, so a target that can be reached is
    reached exactly.  The printed x'Sx has such a force and a steady error (notes B5).
    """

    weight: float

    def quadratic(self, stage: Stage, target: Array) -> Quadratic:
        pull = stage.tip_null_space
        return Quadratic(
            hessian=2.0 * self.weight * pull.T @ pull,
            gradient=2.0 * self.weight * pull.T @ pull @ (stage.c - stage.robot.home),
        )

    def force(self, stage: Stage, target: Array) -> None:
        return None

    def value(self, stage: Stage, target: Array, around: Stage) -> float:
        pulled = around.tip_null_space @ (stage.c - stage.robot.home)
        return self.weight * float(pulled @ pulled)


@dataclass(frozen=True, kw_only=True)
class PrintedLengths:
    """weight |x|^2 with the actuator lengths x, the third term of (10) as printed."""

    weight: float

    def quadratic(self, stage: Stage, target: Array) -> Quadratic:
        A = stage.robot.lengths_jacobian(stage.c)
        return Quadratic(
            hessian=2.0 * self.weight * A.T @ A, gradient=2.0 * self.weight * A.T @ stage.lengths
        )

    def force(self, stage: Stage, target: Array) -> None:
        return None

    def value(self, stage: Stage, target: Array, around: Stage) -> float:
        return self.weight * float(np.sum(stage.lengths**2))


@dataclass(frozen=True, kw_only=True)
class Effort:
    """weight |u|^2, the second term of (10), with u in metres per printed step."""

    weight: float

    def hessian(self, robot: Robot) -> Array:
        metric = actuator_metric(robot)
        return 2.0 * self.weight * PRINTED_RATE**2 * metric.T @ metric


@dataclass(frozen=True, kw_only=True)
class ActuatorLengths:
    """Shortest and longest actuator lengths (15), within a trust region around the prediction.

    Arguments:
        trust: largest change of an actuator from its predicted length [m]
    """

    trust: float

    def rows(self, stage: Stage) -> Rows:
        robot = stage.robot
        lower, upper = _room(robot.length_limits, stage.lengths)
        limited = (lower > -self.trust) | (upper < self.trust)
        own = np.flatnonzero(np.any(np.isfinite(robot.coordinate_limits), axis=1))
        least, most = _room(robot.coordinate_limits[own], stage.c[own])
        names = [
            f"{name} at its length limit" if near else ""
            for name, near in zip(robot.actuator_names, limited, strict=True)
        ]
        names += [f"{robot.coordinate_names[k]} at its limit" for k in own]
        return Rows(
            jacobian=np.concatenate([robot.lengths_jacobian(stage.c), np.eye(len(stage.c))[own]]),
            lower=np.concatenate([np.maximum(lower, -self.trust), least]),
            upper=np.concatenate([np.minimum(upper, self.trust), most]),
            names=tuple(names),
        )


def _room(limits: Array, values: Array) -> tuple[Array, Array]:
    """Changes that keep values within limits (k, 2).

    A prediction that is out of limits by rounding must not make the problem infeasible.
    """
    return np.minimum(limits[:, 0] - values, 0.0), np.maximum(limits[:, 1] - values, 0.0)


@dataclass(frozen=True, kw_only=True)
class ActuatorRates:
    """Slowest and fastest actuator rates (16)."""

    def rows(self, stage: Stage, dt: float) -> Rows:
        limits = stage.robot.rate_limits * dt
        return Rows(
            jacobian=stage.robot.lengths_jacobian(stage.c),
            lower=limits[:, 0],
            upper=limits[:, 1],
            names=tuple(f"{name} at its speed limit" for name in stage.robot.actuator_names),
        )

    def fraction(self, start: Stage, end: Stage, dt: float) -> float:
        change = end.lengths - start.lengths
        limits = start.robot.rate_limits * dt
        excess = np.maximum(change / limits[:, 1], change / limits[:, 0])
        return float(1.0 / max(1.0, np.max(excess)))


@dataclass(frozen=True, kw_only=True)
class TipSpeed:
    """Largest speed of the tip [m/s].

    In the plan it is a box around the increment; the share of the step that is taken makes
    the speed itself exact.
    """

    limit: float

    def rows(self, stage: Stage, dt: float) -> Rows:
        reach = np.full(3, self.limit * dt)
        names = ("tip at its speed limit",) * 3
        return Rows(jacobian=stage.jacobian[-1], lower=-reach, upper=reach, names=names)

    def fraction(self, start: Stage, end: Stage, dt: float) -> float:
        moved = float(np.linalg.norm(end.tip - start.tip))
        return min(1.0, self.limit * dt / moved) if moved > 0.0 else 1.0
