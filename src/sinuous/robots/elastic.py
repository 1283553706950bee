"""A robot whose bend follows from elastic, pull-only cables, friction and play.

Constant-curvature kinematics says that cables bend a robot as far as their lengths allow. Real
cables stretch, lose tension and stick. Here the bend vectors of all segments make an energy least
(`elastic_kernels`); everything is relative to the bending stiffness EI of the backbone, because
motor positions and tip positions say nothing about forces.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray
from sinuous.robots import elastic_kernels
from sinuous.robots.elastic_kernels import Cables

# By which every cable stays stretched when motors are told how to bend the robot [m].
LEAST_STRETCH = 0.2e-3


@dataclass(frozen=True, kw_only=True, eq=False)
class ElasticModel:
    """The statics of J inextensible segments and C cables, each ending with one segment.

    Arguments:
        lengths: of the segments (J,) [m]
        segment: in which each cable ends (C,); it passes all segments before
        holes: of each cable, from the backbone, where it passes the first segment (C, 2) [m]
        twist: angle by which the holes of each segment are turned about the axis (J,) [rad]
        stiffness: of each cable over EI (C,) [1/m^3]
        slack: pull of the motor from which each cable is taut on the straight robot (C,) [m];
            negative: it is stretched by as much, its pretension
        rest: bend vectors without any cable (J, 2) [rad]
        friction: moment over EI that holds each segment where it is (J,) [1/m]
        play: dead band between motor and cable [m]

    Raises:
        ValueError: if shapes differ, or a length or stiffness is not positive
    """

    lengths: Array
    segment: IntArray
    holes: Array
    twist: Array
    stiffness: Array
    slack: Array
    rest: Array
    friction: Array
    play: float = 0.0

    def __post_init__(self) -> None:
        segments, cables = len(self.lengths), len(self.segment)
        shapes = (
            (self.holes, (cables, 2)),
            (self.twist, (segments,)),
            (self.stiffness, (cables,)),
            (self.slack, (cables,)),
            (self.rest, (segments, 2)),
            (self.friction, (segments,)),
        )
        if any(np.shape(value) != shape for value, shape in shapes):
            raise ValueError(f"{cables} cables and {segments} segments need values of their number")
        if not (np.all(self.lengths > 0.0) and np.all(self.stiffness > 0.0)):
            raise ValueError("lengths and stiffness must be positive")
        if np.any(self.friction < 0.0) or self.play < 0.0:
            raise ValueError("friction and play must be zero or more")

    @cached_property
    def cables(self) -> Cables:
        """The model as plain arrays: what compiled code reads."""
        passed = np.arange(len(self.lengths)) <= self.segment[:, None]
        c, s = np.cos(self.twist), np.sin(self.twist)
        turn = np.array([[c, -s], [s, c]])
        holes = passed[:, :, None] * np.einsum("ikj,ak->aji", turn, self.holes)
        return Cables(
            holes=np.ascontiguousarray(holes.reshape(len(self.segment), -1)),
            stiffness=np.ascontiguousarray(self.stiffness, dtype=float),
            bending=np.repeat(1.0 / self.lengths, 2),
            rest=np.ascontiguousarray(self.rest, dtype=float).ravel(),
            friction=np.ascontiguousarray(self.friction, dtype=float),
            play=float(self.play),
        )

    def at_rest(self, pull: Array) -> Array:
        """Bends (2J,) [rad] for motors that pull by (C,) [m], without friction and play."""
        u = self.cables.rest.copy()
        elastic_kernels.relax(self.cables, pull - self.slack, u)
        return u

    def trace(self, pulls: Array) -> Array:
        """Bends (T, 2J) [rad] for motors that pull by (T, C) [m], row after row.

        Before the first row it rests without friction, every cable in the middle of its play.
        """
        rows = np.ascontiguousarray(pulls - self.slack)
        u, follow, out = (
            self.at_rest(pulls[0]),
            rows[0].copy(),
            np.empty((len(rows), 2 * len(self.lengths))),
        )
        elastic_kernels.trace(self.cables, rows, follow, u, out)
        return out

    def pulls(self, bends: ArrayLike, *, least: float = LEAST_STRETCH) -> Array:
        """Pulls of the motors (C,) [m] that make the robot rest at bends (2J,) [rad].

        The inverse of `at_rest`. From tip to base, the cables of each segment carry what its
        bend needs beyond the cables that pass on: the least tensions that do it, and as much
        more of those that bend nothing that no cable is stretched by less than `least` [m].
        """
        u, holes = np.asarray(bends, dtype=float), self.cables.holes
        need = self.cables.bending * (u - self.cables.rest)
        tension = np.zeros(len(self.segment))
        for j in range(len(self.lengths) - 1, -1, -1):
            own, rows = self.segment == j, slice(2 * j, 2 * j + 2)
            arms = holes[own, rows].T
            inverse = np.linalg.pinv(arms)
            alone = inverse @ (need[rows] - holes[:, rows].T @ tension)
            idle = np.ones(len(alone)) - inverse @ arms.sum(axis=1)  # bends nothing
            floor = least * self.stiffness[own]
            tension[own] = alone + max(0.0, float(np.max((floor - alone) / idle))) * idle
        return holes @ u + tension / self.stiffness + self.slack

    def stretch(self, pulls: Array, bends: Array) -> Array:
        """Stretch of the cables (..., C) [m] at bends (..., 2J), play aside; negative: slack."""
        return pulls - self.slack - bends @ self.cables.holes.T

    def is_slack(self, pulls: Array, bends: Array) -> BoolArray:
        """Which cables (..., C) have no tension."""
        return self.stretch(pulls, bends) <= 0.0
