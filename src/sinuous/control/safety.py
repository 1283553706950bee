"""The safety filter: how much of a planned step is safe, on the exact mesh, also on the way.

A step is accepted if its least slack is at least min(0, least slack where it starts): then
standing still is always allowed and no step makes a bad state worse (notes B8).
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control.shape import ShapeConstraint
from sinuous.control.stage import Stage
from sinuous.control.terms import IncrementLimit

# Two shapes this close count as one [m].
SAME = 1e-6

# Slack that a recovering body may lose for a moment on its way to a better shape [m].
WOBBLE = 1e-4

# Share of the bow of a whole way that its halves are allowed: twice the quarter that they
# have if the way is a parabola.
BOW = 0.5

CHECKS = 256  # shapes looked at before the filter gives a step up
ATTEMPTS = 16  # at shortening a step before the robot stands still
ROUNDING = 1e-9  # share by which a step is shortened further than its limits ask


@dataclass(frozen=True, kw_only=True)
class SafetyFilter:
    """Accepts the largest tested share of a step.

    Arguments:
        shape: constraints on the body
        limits: limits of the increment
        dt: [s]
    """

    shape: Sequence[ShapeConstraint]
    limits: Sequence[IncrementLimit]
    dt: float

    def accept(self, start: Stage, goal: Stage) -> tuple[Stage, float]:
        """The configuration to move to and the share of the step that it is."""
        share = 1.0
        floors = [floor(constraint.slack(start)) for constraint in self.shape]
        for _ in range(ATTEMPTS):
            end = goal if share == 1.0 else at(start, goal, share)
            allowed = min((x.fraction(start, end, self.dt) for x in self.limits), default=1.0)
            if allowed < 1.0:
                share *= allowed * (1.0 - ROUNDING)
            elif self._safe(start, end, floors):
                return end, share
            else:
                share *= 0.5
        return start, 0.0

    def _safe(self, start: Stage, end: Stage, floors: list[float]) -> bool:
        return self._keeps(end, floors) and self._way_is_safe(start, end, floors)

    def _keeps(self, stage: Stage, floors: list[float]) -> bool:
        slacks = (np.min(c.slack(stage), initial=np.inf) for c in self.shape)
        return all(slack >= least for slack, least in zip(slacks, floors, strict=True))

    def _way_is_safe(self, start: Stage, end: Stage, floors: list[float]) -> bool:
        """Whether every shape on the straight way in c keeps its floors.

        Every constraint bounds its slack between two shapes from below; where the bound is
        not enough the shape in the middle is looked at. A body point's way bows out from its
        chord; halving a way quarters the bow, and BOW of it is allowed for.
        """
        allowed = [least - WOBBLE if least < 0.0 else least for least in floors]
        pending: list[tuple[Stage, Stage, Array | None]] = [(start, end, None)]
        checks = 0
        while pending:
            a, b, bow = pending.pop()
            if bow is not None and self._bounded(a, b, bow, allowed):
                continue
            checks += 1
            middle = at(a, b, 0.5)
            if checks > CHECKS or not self._keeps(middle, allowed):
                return False
            halfway = 0.5 * (a.points + b.points)
            bow = BOW * np.linalg.norm(middle.points - halfway, axis=1)
            pending += [(a, middle, bow), (middle, b, bow)]
        return True

    def _bounded(self, a: Stage, b: Stage, bow: Array, allowed: list[float]) -> bool:
        """Whether nothing between two shapes can fall below what is allowed."""
        if np.max(np.linalg.norm(b.points - a.points, axis=1) + bow) < SAME:
            return True
        bounds = zip(self.shape, allowed, strict=True)
        return all(constraint.least_between(a, b, bow) >= least for constraint, least in bounds)


def floor(slack: Array) -> float:
    """Least slack that a step may end with, given the slack it starts with."""
    return min(0.0, float(np.min(slack, initial=np.inf)))


def at(start: Stage, end: Stage, share: float) -> Stage:
    """The stage on the straight way from start to end."""
    return start.moved_to(start.c + share * (end.c - start.c))
