"""What the multipliers of a plan say: which walls it leans on, and what limits the robot."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control.problem import HardRows
from sinuous.control.report import Active
from sinuous.control.shape import Contacts, Cuts, ShapeConstraint, merged
from sinuous.control.stage import Stage

# Multipliers below this share of the largest in the problem are rounding.
INACTIVE = 1e-6


@dataclass(frozen=True, kw_only=True)
class Placed:
    """Cuts of one shape constraint at one stage."""

    stage: int
    constraint: ShapeConstraint
    cuts: Cuts


def contacts_of(placed: Sequence[Placed], multipliers: Array, stages: int) -> list[Contacts]:
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


def active_of(
    start: Stage,
    hard: HardRows,
    placed: Sequence[Placed],
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
                if name and multipliers[row] > least:
                    note(name, float(multipliers[row]))
                row += 1
    for one in placed:
        for source, triangle in zip(one.cuts.source, one.cuts.triangle, strict=True):
            if multipliers[row] > least:
                name = one.constraint.describe(start, int(source), int(triangle))
                note(name, float(multipliers[row]), int(triangle))
            row += 1
    return tuple(sorted(strongest.values(), key=lambda active: -active.multiplier))
