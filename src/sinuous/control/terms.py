"""What a controller wants, as small objects that add up.

The costs of this module are weights of a form that the compiled step knows; any other object
with the method `quadratic` is a cost too, by its second-order model around each predicted
configuration.  The solver loop knows none of them by name.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Protocol, runtime_checkable

import numpy as np

from sinuous.arrays import Array
from sinuous.control.metric import actuator_metric
from sinuous.robots.robot import Robot

# Step rate at which paper B states its input weight [Hz]. The weight is applied to the
# displacement per step, so it means the same at every rate (notes B6).
PRINTED_RATE = 30.0


@dataclass(frozen=True, kw_only=True)
class Quadratic:
    """The cost 1/2 delta' H delta + g' delta of a change delta of the configuration."""

    hessian: Array  # (n, n), positive semi-definite
    gradient: Array  # (n,)


@dataclass(frozen=True, kw_only=True)
class Weights:
    """tip |p - target|^2 + posture |P M (c - home)|^2 + 1/2 c' Q c + q' c.

    p is the tip, P projects on the tip's null space, M measures in actuator metres.

    Arguments:
        tip, posture: weights
        Q, q: (n, n), (n,), zero if None
    """

    tip: float = 0.0
    posture: float = 0.0
    Q: Array | None = None
    q: Array | None = None


@runtime_checkable
class WeightedCost(Protocol):
    """A cost of each predicted configuration in the form that is compiled."""

    def weights(self, robot: Robot) -> Weights:
        """Its weights; those of all costs are added up."""
        ...


@runtime_checkable
class QuadraticCost(Protocol):
    """Any other cost of each predicted configuration."""

    def quadratic(self, robot: Robot, c: Array, target: Array) -> Quadratic:
        """Its second-order model around the configuration c (n,); target (3,) [m]."""
        ...


class IncrementCost(Protocol):
    """A quadratic cost of the increments v between stages."""

    def hessian(self, robot: Robot) -> Array:
        """H (n, n) of 1/2 v' H v, positive definite."""
        ...


@dataclass(frozen=True, kw_only=True)
class TipError:
    """weight |tip - target|^2, the first term of (10)."""

    weight: float

    def weights(self, robot: Robot) -> Weights:
        return Weights(tip=self.weight)


@dataclass(frozen=True, kw_only=True)
class Posture:
    """weight |P (c - home)|^2 in actuator metres, with P the null space of the tip.

    It straightens the body without a force on the tip, so a target that can be reached is
    reached exactly.  The printed x'Sx has such a force and a steady error (notes B5).
    """

    weight: float

    def weights(self, robot: Robot) -> Weights:
        return Weights(posture=self.weight)


@dataclass(frozen=True, kw_only=True)
class PrintedLengths:
    """weight |x|^2 with the actuator lengths x, the third term of (10) as printed."""

    weight: float

    def weights(self, robot: Robot) -> Weights:
        A = robot.lengths_jacobian(robot.home)
        offset = robot.lengths(robot.home) - A @ robot.home
        return Weights(Q=2.0 * self.weight * A.T @ A, q=2.0 * self.weight * A.T @ offset)


@dataclass(frozen=True, kw_only=True)
class Effort:
    """weight |u|^2, the second term of (10), with u in metres per printed step."""

    weight: float

    def hessian(self, robot: Robot) -> Array:
        metric = actuator_metric(robot)
        return 2.0 * self.weight * PRINTED_RATE**2 * metric.T @ metric


@dataclass(frozen=True, kw_only=True)
class Costs:
    """What the controller minimises over the horizon.

    Arguments:
        state: costs of each predicted configuration
        effort: cost of the increments
    """

    state: tuple[WeightedCost | QuadraticCost, ...] = (TipError(weight=1e5), Posture(weight=5.0))
    effort: IncrementCost = field(default_factory=lambda: Effort(weight=0.1))

    @classmethod
    def printed(cls) -> "Costs":
        """The cost (10) with the weights of paper B III-B; it has a steady error (notes B5)."""
        return cls(
            state=(TipError(weight=1000.0), PrintedLengths(weight=10.0)),
            effort=Effort(weight=10.0),
        )


def total_weights(costs: Sequence[WeightedCost | QuadraticCost], robot: Robot) -> Weights:
    """The weights of all costs that have some, added up."""
    parts = [cost.weights(robot) for cost in costs if isinstance(cost, WeightedCost)]
    n = len(robot.home)
    return Weights(
        tip=sum(part.tip for part in parts),
        posture=sum(part.posture for part in parts),
        Q=sum((part.Q for part in parts if part.Q is not None), start=np.zeros((n, n))),
        q=sum((part.q for part in parts if part.q is not None), start=np.zeros(n)),
    )


NO_HESSIANS, NO_GRADIENTS = np.zeros((0, 0, 0)), np.zeros((0, 0))


def further_costs(
    costs: Sequence[WeightedCost | QuadraticCost],
) -> tuple[QuadraticCost, ...]:
    """Those that are not weights."""
    return tuple(cost for cost in costs if not isinstance(cost, WeightedCost))


def total_quadratics(
    costs: Sequence[QuadraticCost], robot: Robot, predicted: Array, target: Array
) -> tuple[Array, Array]:
    """Hessians (N, n, n) and gradients (N, n) of all costs, empty if there are none.

    Arguments:
        predicted: configurations (N, n)
        target: (3,) [m]
    """
    if not costs:
        return NO_HESSIANS, NO_GRADIENTS
    N, n = predicted.shape
    H, f = np.zeros((N, n, n)), np.zeros((N, n))
    for i, c in enumerate(predicted):
        for cost in costs:
            model = cost.quadratic(robot, c, target)
            H[i] += model.hessian
            f[i] += model.gradient
    return H, f
