"""What one step has to solve: costs and constraints added up around a prediction."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from sinuous.arrays import Array
from sinuous.control import qp
from sinuous.control.shape import Contacts, ShapeConstraint
from sinuous.control.stage import Stage
from sinuous.control.terms import Cost, Effort, IncrementLimit, Rows, StateLimit

# Limits of every stage and of the increment that leads to it.
HardRows: TypeAlias = list[tuple[Rows, list[Rows]]]


@dataclass(frozen=True, kw_only=True)
class Terms:
    """What a plan minimises and keeps; the order is of no importance."""

    costs: Sequence[Cost]
    effort: Effort
    state_limit: StateLimit
    increment_limits: Sequence[IncrementLimit]
    shape: Sequence[ShapeConstraint]


def hard_rows(terms: Terms, predicted: Sequence[Stage], dt: float) -> HardRows:
    """Limits of every stage and of the increment that leads to it."""
    return [
        (terms.state_limit.rows(stage), [limit.rows(stage, dt) for limit in terms.increment_limits])
        for stage in predicted
    ]


def build_problem(
    terms: Terms,
    scale: qp.Scale,
    start: Stage,
    predicted: Sequence[Stage],
    contacts: Sequence[Contacts],
    target: Array,
    hard: HardRows,
) -> qp.Problem:
    """The QP around the predicted stages, before any cut.

    The Hessian is that of the Lagrangian: the curvature of the kinematics under the pull on
    the tip and the push of the walls is included.  Without it a target far outside the walls
    makes the step oscillate, because the pull is then large in directions in which the tip's
    Jacobian has no gain.
    """
    hessians, gradients = list[Array](), list[Array]()
    for stage, leaning in zip(predicted, contacts, strict=True):
        models = [cost.quadratic(stage, target) for cost in terms.costs]
        pull = -leaning.forces(len(stage.points))
        for cost in terms.costs:
            if (force := cost.force(stage, target)) is not None:
                pull[-1] += force
        curvature = stage.robot.points_curvature(stage.c, pull)
        hessians.append(sum((m.hessian for m in models), start=curvature))
        gradients.append(sum((m.gradient for m in models), start=np.zeros(len(stage.c))))
    c = np.array([start.c, *(stage.c for stage in predicted)])
    return qp.build(
        scale=scale,
        hessians=hessians,
        gradients=gradients,
        effort=terms.effort.hessian(start.robot),
        increments=np.diff(c, axis=0),
        rows=hard,
    )
