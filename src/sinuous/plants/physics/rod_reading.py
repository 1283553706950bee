"""What the numbers of a rod robot's model mean: cables it is told, points that it has."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.plants.physics.rod_links import cubic
from sinuous.robots.chain_kernels import ARC
from sinuous.robots.layout import Layout
from sinuous.robots.parts import CableConvention
from sinuous.robots.pcc import PccRobot

STRAIGHT = (
    1e-8  # a link bent by less counts as bent by that, so that nothing is divided by zero [rad]
)
ROUNDING = 1e-9  # a point so little beyond a frame lies at it, as a share of a link


class Hole(NamedTuple):
    """Where a cable runs: in which segment it ends, the first 0, and where in every disk [m]."""

    segment: int
    offset: tuple[float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class RodReading:
    """Between actuator lengths, configurations, links and points of a robot of segments."""

    robot: PccRobot

    # --- actuators -----------------------------------------------------------------------

    @cached_property
    def holes(self) -> list[Hole]:
        """Of all cables (C,)."""
        return [
            Hole(j, (float(x), float(y)))
            for j, segment in enumerate(self.robot.segments)
            for x, y in segment.holes
        ]

    @cached_property
    def cables(self) -> IntArray:
        """Which of the robot's actuators are cables (C,)."""
        found, row = list[int](), 1 if self.robot.insertion else 0
        for segment in self.robot.segments:
            found += range(row, row + len(segment.cable_angles))
            row += len(segment.cable_angles) + (1 if segment.extensible else 0)
        return np.array(found)

    def configuration(self, lengths: Array) -> Array:
        """Configuration (..., n) of actuator lengths (..., P) [m], as the robot reads them."""
        slope, offset = self._configuration_map
        return lengths @ slope + offset

    def cable_lengths(self, lengths: Array) -> Array:
        """Lengths (..., C) [m] of whole cables that actuator lengths (..., P) [m] ask for.

        The robot counts cables along arcs, as its model does: by the segment convention inside
        the own segment, to which comes here what the cable needs to pass the segments before.
        A real cable runs straight from disk to disk and is shorter than the arc by about
        gamma theta^2 / (24 n^2) in a segment of n gaps: asked for arcs, it slackens as the
        robot bends. That is physics, and stays. Two links in a gap cut the corner a little more
        than the backbone's arc does; that is not physics, and is taken off here.
        """
        whole_slope, whole_offset = self._passed_map
        c = self.configuration(lengths)
        return lengths[..., self.cables] + c @ whole_slope + whole_offset + self._corners(c)

    @cached_property
    def _configuration_map(self) -> tuple[Array, Array]:
        """Slope (P, n) and offset (n,) of the configuration, which is affine in the lengths."""
        count = len(self.robot.actuator_names)
        offset = self.robot.configuration(np.zeros(count))
        return self.robot.configuration(np.eye(count)) - offset, offset

    @cached_property
    def _passed_map(self) -> tuple[Array, Array]:
        """Slope (n, C) and offset (C,) [m] of what a cable needs before its own segment."""
        own = Layout(
            segments=self.robot.segments,
            speed=self.robot.speed,
            convention=self.robot.convention,
            insertion=self.robot.insertion,
        )
        whole = replace(own, convention=CableConvention.MOTOR)
        slope = whole.length_map[0] - own.length_map[0]
        offset = whole.length_map[1] - own.length_map[1]
        return slope[self.cables].T, offset[self.cables]

    def _corners(self, c: Array) -> Array:
        """What links are shorter than arcs by (..., C) [m], between holes in the disks.

        With a gap g bent by t, holes d off the backbone towards the bend are
        g sin(t/2) / (t/2) - 2 d sin(t/2) apart; m links turn the first term into
        g sin(t/2) / (m tan(x)) with x = t / (2 m).
        """
        bends, lengths = self._bends(c), self._lengths(c)
        m, bend = self._per_gap, np.sqrt(np.sum(bends * bends, axis=-1))
        x = np.maximum(0.5 * bend / self._links, STRAIGHT)
        chords = lengths * np.sin(m * x) / m
        return (chords * (np.cos(x) / np.sin(x) - 1.0 / x)) @ self._passes

    @property
    def _per_gap(self) -> int:
        return self.robot.mechanics.links_per_gap

    @cached_property
    def _disks(self) -> IntArray:
        """Disks of each segment (J,)."""
        return np.array([segment.disks for segment in self.robot.segments])

    @cached_property
    def _passes(self) -> Array:
        """Whether a cable runs through a segment (J, C), as 0 and 1."""
        segments = np.arange(len(self.robot.segments))[:, None]
        return (segments <= [hole.segment for hole in self.holes]).astype(float)

    # --- links ---------------------------------------------------------------------------

    def base(self, c: Array) -> Array:
        """Where the base of the first segment is (3,) [m]."""
        T = self.robot.T_w_b
        return T[:3, 3] + (c[0] if self.robot.insertion else 0.0) * T[:3, 2]

    def link_lengths(self, c: Array) -> Array:
        """Lengths (J,) [m] of the links of each segment."""
        return self._lengths(c) / self._links

    def link_bends(self, c: Array) -> Array:
        """Bend vectors (J, 2) [rad] of the links of each segment."""
        return self._bends(c) / self._links[:, None]

    @cached_property
    def _links(self) -> IntArray:
        """Links of each segment (J,)."""
        return self._per_gap * self._disks

    def _bends(self, c: Array) -> Array:
        """Bend vectors (..., J, 2) [rad] of the segments."""
        return c[..., self._theta]

    def _lengths(self, c: Array) -> Array:
        """Lengths (..., J) [m] of the segments."""
        slope, fixed = self._length_map
        return c @ slope + fixed

    @cached_property
    def _theta(self) -> IntArray:
        """Columns of each segment's bend vector (J, 2)."""
        chain = self.robot.chain
        return chain.theta_column[chain.turns == ARC][:, None] + np.arange(2)

    @cached_property
    def _length_map(self) -> tuple[Array, Array]:
        """Slope (n, J) and offset (J,) [m] of the segments' lengths."""
        chain = self.robot.chain
        arcs = np.flatnonzero(chain.turns == ARC)
        gamma = chain.gamma_column[arcs]
        slope = (np.arange(len(self.robot.home))[:, None] == gamma).astype(float)
        return slope, np.where(gamma < 0, chain.fixed_length[arcs], 0.0)

    # --- points --------------------------------------------------------------------------

    def points(self, places: Array, directions: Array) -> Array:
        """Guarded points (S, 3) [m] of the robot, as it orders them.

        Arguments:
            places: of the base, all links and the tip (N + 2, 3) [m]
            directions: of the backbone there (N + 2, 3)
        """
        spans = self._spans
        mount = self.robot.T_w_b[:3, 3]
        where, along = np.vstack([mount, places]), np.vstack([directions[:1], directions])
        chord = where[1:] - where[:-1]
        # The cubic starts and ends with tangents as long as its arc, here to second order.
        length = np.sqrt(np.einsum("ij,ij->i", chord, chord))[spans.first, None]
        first, second, (start, leaves, end, arrives) = spans.first, spans.first + 1, spans.weights
        tangents = leaves * along[first] + arrives * along[second]
        return start * where[first] + end * where[second] + length * tangents

    @cached_property
    def _spans(self) -> "_Spans":
        """How the points follow from the mount (0), the base (1), all links and the tip."""
        chain = self.robot.chain
        arc = chain.turns[chain.section] == ARC
        links = np.zeros(len(chain.turns), dtype=np.int64)
        links[chain.turns == ARC] = self._links
        start = 1 + np.cumsum(links) - links
        start[np.cumsum(links) == 0] = 0  # before the first segment is the shaft
        count = np.maximum(links, 1)[chain.section]
        along = chain.fraction * count
        cell = np.clip(np.ceil(along - ROUNDING).astype(np.int64) - 1, 0, count - 1)
        first = start[chain.section] + cell
        u, zero = along - cell, np.zeros(len(cell))
        weights = np.where(arc, cubic(u), [1.0 - u, zero, u, zero])
        return _Spans(first=first, weights=weights[:, :, None])


class _Spans(NamedTuple):
    """The first of the two frames (S,) beside each point; weights (4, S, 1) as `cubic` has them."""

    first: IntArray
    weights: Array
