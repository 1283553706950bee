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
from sinuous.control.shape import Contacts, Cuts, ShapeConstraint, merged
from sinuous.control.stage import Stage
from sinuous.control.terms import Cost, Effort, IncrementLimit, Rows, StateLimit

# Rounds of solving and adding violated planes.
ROUNDS = 6

# What a metre beyond a wall costs when plans are compared, in units of the strongest push.
PRICE = 3.0

# Halvings of a change of the plan before it is taken as it is.
BACKTRACKS = 6

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
        contacts: walls that each stage leans on
        iterations: QPs solved
        planes: rows that stand in for shape constraints in the last QP
        active: what the plan leans on, the strongest first
        failure: why there is no plan; empty if there is one
    """

    found: Sequence[Stage] = ()
    contacts: Sequence[Contacts]
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
    contacts: Sequence[Contacts],
    target: Array,
    dt: float,
) -> Plan:
    """Plan from `start` towards target (3,) around the predicted stages 1..N.

    Arguments:
        contacts: walls that the stages of the last plan leaned on
        dt: time between stages [s]
    """
    hard = _hard_rows(terms, start, predicted, dt)
    problem = _problem(terms, scale, start, predicted, contacts, target, hard)
    placed = [
        _Placed(stage=i, constraint=constraint, cuts=constraint.cuts(stage, contacts[i]))
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
            return Plan(contacts=contacts, iterations=iterations, planes=planes,
                        failure=solution.failure)  # fmt: skip
        delta = scale.delta(solution.y)
        found = [start.moved_to(s.c + d) for s, d in zip(predicted, delta, strict=True)]
        pending = _violated(terms, predicted, found)
        if not pending or iterations == ROUNDS:
            break
        placed = placed + pending
    multipliers = problem.multipliers(solution)
    leaning = _contacts(placed, multipliers[problem.hard :], len(predicted))
    return Plan(
        found=_descend(terms, start, predicted, found, target, leaning),
        contacts=leaning,
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
    contacts: Sequence[Contacts],
    target: Array,
    hard: list[tuple[Rows, list[Rows]]],
) -> qp.Problem:
    """The QP around the predicted stages, before any cut."""
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


def _violated(
    terms: Terms, predicted: Sequence[Stage], found: Sequence[Stage]
) -> list[_Placed]:
    placed = [
        _Placed(stage=i, constraint=constraint, cuts=constraint.violated(old, new))
        for i, (old, new) in enumerate(zip(predicted, found, strict=True))
        for constraint in terms.shape
    ]
    return [one for one in placed if len(one.cuts)]


def _descend(
    terms: Terms,
    start: Stage,
    predicted: Sequence[Stage],
    found: Sequence[Stage],
    target: Array,
    contacts: Sequence[Contacts],
) -> Sequence[Stage]:
    """As much of the change from the predicted to the found stages as lowers the exact cost.

    Without it the plan can hop for ever between two sets of active walls (a limit cycle of
    millimetres where three walls meet at the tip).
    """
    strongest = [float(np.max(np.linalg.norm(c.push, axis=1), initial=0.0)) for c in contacts]
    price = PRICE * max(strongest)
    before = _merit(terms, start, predicted, predicted, target, price)
    share, tried = 1.0, found
    for _ in range(BACKTRACKS):
        if _merit(terms, start, predicted, tried, target, price) <= before:
            break
        share *= 0.5
        tried = [p.moved_to(p.c + share * (f.c - p.c)) for p, f in zip(predicted, found, strict=True)]
    return tried


def _merit(
    terms: Terms,
    start: Stage,
    predicted: Sequence[Stage],
    stages: Sequence[Stage],
    target: Array,
    price: float,
) -> float:
    """Exact cost of the stages, plus the price of every metre beyond a shape constraint."""
    total, effort, before = 0.0, terms.effort.hessian(start.robot), start.c
    for stage, around in zip(stages, predicted, strict=True):
        total += sum(cost.value(stage, target, around) for cost in terms.costs)
        total += 0.5 * float((stage.c - before) @ effort @ (stage.c - before))
        for constraint in terms.shape:
            total += price * float(np.sum(np.maximum(constraint.reserve - constraint.slack(stage), 0.0)))
        before = stage.c
    return total


def _contacts(placed: Sequence[_Placed], multipliers: Array, stages: int) -> list[Contacts]:
    """What each stage leans on, from the multipliers of the planes."""
    leaning, row = [list[Contacts]() for _ in range(stages)], 0
    for one in placed:
        strength = multipliers[row : row + len(one.cuts)]
        on = np.flatnonzero((strength > 0.0) & (one.cuts.triangle >= 0))
        push = strength[on, None] * one.cuts.normal[on]
        leaning[one.stage].append(
            Contacts(source=one.cuts.source[on], triangle=one.cuts.triangle[on], push=push)
        )
        row += len(one.cuts)
    return [merged(parts) for parts in leaning]


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
