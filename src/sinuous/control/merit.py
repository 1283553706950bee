"""Taking as much of a new plan as lowers the exact cost."""

from collections.abc import Sequence

import numpy as np

from sinuous.arrays import Array
from sinuous.control.problem import Terms
from sinuous.control.shape import Contacts
from sinuous.control.stage import Stage

# What a metre beyond a wall costs when plans are compared, in units of the strongest push.
PRICE = 3.0

# Halvings of a change of the plan before it is taken as it is.
BACKTRACKS = 6


def descend(
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
        tried = [
            p.moved_to(p.c + share * (f.c - p.c)) for p, f in zip(predicted, found, strict=True)
        ]
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
            total += price * float(
                np.sum(np.maximum(constraint.reserve - constraint.slack(stage), 0.0))
            )
        before = stage.c
    return total
