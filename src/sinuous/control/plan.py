"""One plan over the horizon: linearise, solve, look at the exact mesh, add what is violated.

The Hessian is that of the Lagrangian: the curvature of the kinematics under the pull on the
tip and the push of the walls is included.  Without it a target far outside the walls makes
the step oscillate, because the pull is then large in directions in which the tip's Jacobian
has no gain.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control import qp
from sinuous.control.report import Active
from sinuous.control.shape import Cuts, ShapeConstraint
from sinuous.control.stage import Stage
from sinuous.control.terms import Cost, Effort, IncrementLimit, Rows, StateLimit

# Rounds of solving and adding violated planes.
ROUNDS = 6

# Multipliers below this share of the largest in the problem are rounding.
INACTIVE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Terms:
    """What a plan minimises and keeps; the order is of no importance."""

    costs: Sequence[Cost]
    effort: Effort
    state_limit: StateLimit
    increment_limits: Sequence[IncrementLimit]
    shape: Sequence[ShapeConstraint]


@dataclass(frozen=True, kw_only=True, eq=False)
class Plan:
    """The predicted stages 1..N, or the failure that prevented them.

    Arguments:
        found: predicted stages
        forces: push of the walls on the body points (N, S, 3) [cost / m]
        iterations: QPs solved
        planes: rows that stand in for shape constraints in the last QP
        active: what the plan leans on, the strongest first
        failure: why there is no plan; empty if there is one
    """

    found: Sequence[Stage] = ()
    forces: Array
    iterations: int
    planes: int
    active: tuple[Active, ...] = ()
    failure: str = ""


@dataclass(frozen=True, kw_only=True)
class _Placed:
    """Cuts of one shape constraint at one stage."""

    stage: int
    constraint: ShapeConstraint
    cuts: Cuts


def make_plan(
    terms: Terms,
    scale: qp.Scale,
    start: Stage,
    predicted: Sequence[Stage],
    forces: Array,
    target: Array,
    dt: float,
) -> Plan:
    """Plan from `start` towards target (3,) around the predicted stages 1..N.

    Arguments:
        forces: push of the walls (N, S, 3) in the last plan
        dt: time between stages [s]
    """
    hard = _hard_rows(terms, start, predicted, dt)
    problem = _problem(terms, scale, start, predicted, forces, target, hard)
    placed = [
        _Placed(stage=i, constraint=constraint, cuts=constraint.cuts(stage))
        for i, stage in enumerate(predicted)
        for constraint in terms.shape
    ]
    pending, found = placed, list[Stage]()
    for iterations in range(1, ROUNDS + 1):
        for one in pending:
            problem = problem.with_cuts(scale, one.stage, one.cuts)
        solution = qp.solve(problem)
        planes = sum(len(one.cuts) for one in placed)
        if solution.failure:
            return Plan(forces=forces, iterations=iterations, planes=planes,
                        failure=solution.failure)  # fmt: skip
        delta = scale.delta(solution.y)
        found = [start.moved_to(s.c + d) for s, d in zip(predicted, delta, strict=True)]
        pending = _violated(terms, predicted, found)
        if not pending or iterations == ROUNDS:
            break
        placed = placed + pending
    multipliers = problem.multipliers(solution)
    return Plan(
        found=found,
        forces=_forces(placed, multipliers[problem.hard :], forces.shape),
        iterations=iterations,
        planes=planes,
        active=_active(start, hard, placed, multipliers),
    )


def _hard_rows(
    terms: Terms, start: Stage, predicted: Sequence[Stage], dt: float
) -> list[tuple[Rows, list[Rows]]]:
    """Limits of every stage and of the increment that leads to it."""
    return [
        (terms.state_limit.rows(stage), [limit.rows(stage, dt) for limit in terms.increment_limits])
        for stage in predicted
    ]


def _problem(
    terms: Terms,
    scale: qp.Scale,
    start: Stage,
    predicted: Sequence[Stage],
    forces: Array,
    target: Array,
    hard: list[tuple[Rows, list[Rows]]],
) -> qp.Problem:
    """The QP around the predicted stages, before any cut."""
    hessians, gradients = list[Array](), list[Array]()
    for stage, push in zip(predicted, forces, strict=True):
        models = [cost.quadratic(stage, target) for cost in terms.costs]
        pull = -push
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


def _violated(
    terms: Terms, predicted: Sequence[Stage], found: Sequence[Stage]
) -> list[_Placed]:
    placed = [
        _Placed(stage=i, constraint=constraint, cuts=constraint.violated(old, new))
        for i, (old, new) in enumerate(zip(predicted, found, strict=True))
        for constraint in terms.shape
    ]
    return [one for one in placed if len(one.cuts)]


def _forces(placed: Sequence[_Placed], multipliers: Array, shape: tuple[int, ...]) -> Array:
    """Push of the walls on the body points, from the multipliers of their planes."""
    forces, row = np.zeros(shape), 0
    for one in placed:
        push = multipliers[row : row + len(one.cuts), None] * one.cuts.normal
        walls = np.flatnonzero(one.cuts.triangle >= 0)
        np.add.at(forces[one.stage], one.cuts.source[walls], push[walls])
        row += len(one.cuts)
    return forces


def _active(
    start: Stage,
    hard: list[tuple[Rows, list[Rows]]],
    placed: Sequence[_Placed],
    multipliers: Array,
) -> tuple[Active, ...]:
    """Constraints with a multiplier, each named once with its largest one."""
    strongest = dict[str, Active]()

    def note(name: str, multiplier: float, triangle: int = -1) -> None:
        if name not in strongest or strongest[name].multiplier < multiplier:
            strongest[name] = Active(name=name, multiplier=multiplier, triangle=triangle)

    least, row = INACTIVE * float(np.max(multipliers, initial=0.0)), 0
    for state_rows, increment_rows in hard:
        for rows in (state_rows, *increment_rows):
            for name in rows.names:
                if multipliers[row] > least:
                    note(name, float(multipliers[row]))
                row += 1
    for one in placed:
        for source, triangle in zip(one.cuts.source, one.cuts.triangle, strict=True):
            if multipliers[row] > least:
                name = one.constraint.describe(start, int(source), int(triangle))
                note(name, float(multipliers[row]), int(triangle))
            row += 1
    return tuple(sorted(strongest.values(), key=lambda active: -active.multiplier))
