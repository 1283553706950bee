"""One plan over the horizon: linearise, solve, look at the exact mesh, add what is violated."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control import qp
from sinuous.control.merit import descend
from sinuous.control.problem import Terms, build_problem, hard_rows
from sinuous.control.reading import Placed, active_of, contacts_of
from sinuous.control.report import Active
from sinuous.control.shape import Contacts
from sinuous.control.stage import Stage

# Rounds of solving and adding violated planes. A body that is beyond a limit anyway violates
# planes in every round: the filter judges its step, and more rounds would not change that.
ROUNDS = 6
ROUNDS_BEYOND = 2


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
    hard = hard_rows(terms, predicted, dt)
    problem = build_problem(terms, scale, start, predicted, contacts, target, hard)
    placed, found, rounds = list[Placed](), predicted, 0
    pending = [
        Placed(stage=i, constraint=constraint, cuts=constraint.cuts(stage, contacts[i]))
        for i, stage in enumerate(predicted)
        for constraint in terms.shape
    ]
    solution = qp.Solution.nothing()
    inside = all(np.min(c.slack(start), initial=0.0) >= 0.0 for c in terms.shape)
    most = ROUNDS if inside else ROUNDS_BEYOND
    while pending and rounds < most:
        wider = problem.with_cuts(scale, [(one.stage, one.cuts) for one in pending])
        rounds += 1
        attempt = qp.solve(wider)
        if attempt.failure and solution.failure:
            return Plan(contacts=contacts, iterations=rounds, planes=wider.soft_rows,
                        failure=attempt.failure)  # fmt: skip
        if attempt.failure:
            break  # the last solution stands; the filter judges its step
        problem, solution, placed = wider, attempt, placed + pending
        delta = scale.delta(solution.y)
        found = [start.moved_to(s.c + d) for s, d in zip(predicted, delta, strict=True)]
        pending = _violated(terms, predicted, found)
    multipliers = problem.multipliers(solution)
    leaning = contacts_of(placed, multipliers[problem.hard :], len(predicted))
    return Plan(
        found=descend(terms, start, predicted, found, target, leaning),
        contacts=leaning,
        iterations=rounds,
        planes=problem.soft_rows,
        active=active_of(start, hard, placed, multipliers),
    )


def _violated(terms: Terms, predicted: Sequence[Stage], found: Sequence[Stage]) -> list[Placed]:
    placed = [
        Placed(stage=i, constraint=constraint, cuts=constraint.violated(old, new))
        for i, (old, new) in enumerate(zip(predicted, found, strict=True))
        for constraint in terms.shape
    ]
    return [one for one in placed if len(one.cuts)]
