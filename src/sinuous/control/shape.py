"""Constraints on the body's shape: not linear, kept by cutting planes and the safety filter."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Protocol, Self

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.control.stage import Stage

# A plan may come this much closer than its reserve before it is corrected [m].
TOLERANCE = 1e-6


# Bend limits with less cable travel left than this get a row from the start [m].
NEAR_BEND = 0.002


@dataclass(frozen=True, kw_only=True)
class Cuts:
    """Linear conditions slack + A delta >= 0 that stand in for a shape constraint.

    Arguments:
        jacobian: A (m, n)
        slack: (m,) [m]
        source: (m,) body point of a wall plane, or segment of a bend limit
        triangle: (m,) wall triangle, -1 for none
        normal: (m, 3) direction in which the wall pushes, zero for none
    """

    jacobian: Array
    slack: Array
    source: IntArray
    triangle: IntArray
    normal: Array

    def __len__(self) -> int:
        return len(self.slack)

    @classmethod
    def none(cls, coordinates: int) -> Self:
        """No row at all, for a robot with so many coordinates."""
        nothing = np.zeros(0, dtype=np.int64)
        return cls(
            jacobian=np.zeros((0, coordinates)),
            slack=np.zeros(0),
            source=nothing,
            triangle=nothing,
            normal=np.zeros((0, 3)),
        )

    def lowered(self, missed: Array) -> Self:
        """The same rows with less slack, by what linearisation missed (m,)."""
        return replace(self, slack=self.slack - missed)

    def only(self, chosen: IntArray) -> "Cuts":
        """The chosen rows."""
        return Cuts(
            jacobian=self.jacobian[chosen],
            slack=self.slack[chosen],
            source=self.source[chosen],
            triangle=self.triangle[chosen],
            normal=self.normal[chosen],
        )


@dataclass(frozen=True, kw_only=True)
class Contacts:
    """Walls that one stage of the last plan leaned on.

    Arguments:
        source: (m,) body points
        triangle: (m,) triangles they leaned on
        push: (m, 3) the walls' push on the points [cost / m]
    """

    source: IntArray
    triangle: IntArray
    push: Array

    @classmethod
    def none(cls) -> "Contacts":
        """No contact at all."""
        nothing = np.zeros(0, dtype=np.int64)
        return cls(source=nothing, triangle=nothing, push=np.zeros((0, 3)))

    def forces(self, points: int) -> Array:
        """Push on all body points (S, 3)."""
        forces = np.zeros((points, 3))
        np.add.at(forces, self.source, self.push)
        return forces


def merged(parts: Sequence[Contacts]) -> Contacts:
    """Contacts of one stage from all its rows, each pair of point and triangle once."""
    source = np.concatenate([part.source for part in parts])
    triangle = np.concatenate([part.triangle for part in parts])
    push = np.concatenate([part.push for part in parts])
    pairs, where = np.unique(np.stack([source, triangle]), axis=1, return_inverse=True)
    total = np.zeros((pairs.shape[1], 3))
    np.add.at(total, where.ravel(), push)
    return Contacts(source=pairs[0], triangle=pairs[1], push=total)


class ShapeConstraint(Protocol):
    """A constraint g(c) >= 0 on each of several parts of the body."""

    @property
    def reserve(self) -> float:
        """Slack that plans keep, so that the safety filter has room [m]."""
        ...

    def slack(self, stage: Stage) -> Array:
        """g (k,) exactly [m]; parts that no motion can change are left out."""
        ...

    def least_between(self, a: Stage, b: Stage, bow: Array) -> float:
        """A lower bound of the slack on the straight way in c from one stage to another.

        Arguments:
            bow: how far each body point may stray from its chord (S,) [m]
        """
        ...

    def cuts(self, stage: Stage, contacts: Contacts) -> Cuts:
        """First rows around the stage, those for the last plan's contacts among them."""
        ...

    def violated(self, stage: Stage, found: Stage) -> Cuts:
        """Rows around the stage that cut off what is violated at the solution found.

        Where the row itself holds and only the curvature of the kinematics is to blame, its
        slack is lowered by what linearisation missed (a second-order correction).
        """
        ...

    def describe(self, stage: Stage, source: int, triangle: int) -> str:
        """Name a row for a report."""
        ...


@dataclass(frozen=True, kw_only=True)
class BendLimit:
    """Largest bend of every segment (20), with the curvature from the bend vector.

    |theta| is convex, so its tangent allows too much: the row is kept `reserve` short of the
    limit and corrected where that is not enough (notes B10).
    """

    reserve: float = 1e-5  # of cable travel [m]

    def slack(self, stage: Stage) -> Array:
        return stage.bend_slack

    def least_between(self, a: Stage, b: Stage, bow: Array) -> float:
        # The slack is concave in c, so it is least at one of the ends.
        return float(min(np.min(a.bend_slack), np.min(b.bend_slack)))

    def cuts(self, stage: Stage, contacts: Contacts) -> Cuts:
        return self._rows(stage, np.flatnonzero(stage.bend_slack < NEAR_BEND))

    def violated(self, stage: Stage, found: Stage) -> Cuts:
        beyond = np.flatnonzero(found.bend_slack < self.reserve - TOLERANCE)
        rows = self._rows(stage, beyond)
        linear = rows.slack + self.reserve + rows.jacobian @ (found.c - stage.c)
        return rows.lowered(np.maximum(linear - found.bend_slack[rows.source], 0.0))

    def describe(self, stage: Stage, source: int, triangle: int) -> str:
        return f"{stage.robot.bend_names[source]} at its limit"

    def _rows(self, stage: Stage, which: IntArray) -> Cuts:
        """Tangents of some limits."""
        if not len(which):
            return Cuts.none(len(stage.c))
        A = stage.robot.bend_slack_jacobian(stage.c)[which]
        rows = Cuts(
            jacobian=A,
            slack=stage.bend_slack[which] - self.reserve,
            source=which,
            triangle=np.full(len(which), -1, dtype=np.int64),
            normal=np.zeros((len(which), 3)),
        )
        # A straight segment of fixed length can bend any way: its limit has no tangent.
        return rows.only(np.flatnonzero(np.any(A != 0.0, axis=1)))
