"""Tensions by statics: what the cables must pull with to keep an elastic backbone bent."""

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.cables import bend_columns, cable_rows
from sinuous.robots.centreline import Centreline
from sinuous.robots.chain_kernels import ARC
from sinuous.robots.parts import CableConvention
from sinuous.robots.pcc import PccRobot


@dataclass(frozen=True, kw_only=True, eq=False)
class BackboneTensions:
    """Estimates tensions from the nominal shape, without sensors.

    The cables hold the moment of every bend, E I theta / gamma, with their lever arms, all cables
    that pass a segment counting. Of all tensions that do, those are taken that are nearest to the
    tension that bends nothing, stiffness x (pretension + what is pulled in - what bending slackens
    them by): cables share a moment like springs. A cable runs straight from disk to disk and is
    shorter there than the arc that the model counts, by gamma theta^2 / (24 n^2) in a segment of n
    gaps. Weight, contact, friction and loads at the tip are not known and left out.

    Arguments:
        robot: with its mechanics
    """

    robot: PccRobot

    def __call__(self, c: Array, shift: Array) -> Array:
        """Tensions (C,) [N], zero where a cable is slack.

        Arguments:
            c: configuration (n,)
            shift: by how much each cable is pulled in (C,) [m]
        """
        cables = self.robot.mechanics.cables
        at_rest = cables.stiffness * (cables.pretension + shift - self._slackened(c))
        missing = self._moments(c) - self._lever @ at_rest
        return np.maximum(at_rest + self._sharing @ missing, 0.0)

    def _moments(self, c: Array) -> Array:
        """E I theta / gamma of every bend coordinate (B,) [N m]."""
        lengths = self._lengths(c)
        stiffness = self.robot.mechanics.backbone.bending_stiffness
        return stiffness * c[bend_columns(self.robot)] / np.repeat(lengths, 2)

    def _slackened(self, c: Array) -> Array:
        """What cables (C,) are shorter by than the model counts, from disk to disk [m]."""
        segments = self.robot.segments
        gaps = np.array([segment.disks for segment in segments])
        bends = c[bend_columns(self.robot)].reshape(-1, 2)
        shorter = np.cumsum(self._lengths(c) * np.sum(bends**2, axis=1) / (24.0 * gaps**2))
        return np.repeat(shorter, [len(segment.cable_angles) for segment in segments])

    def _lengths(self, c: Array) -> Array:
        """Lengths (J,) of the segments [m]."""
        return self._line.section_lengths(c)[self.robot.chain.turns == ARC]

    @cached_property
    def _line(self) -> Centreline:
        return Centreline(robot=self.robot)

    @cached_property
    def _lever(self) -> Array:
        """Moments by tensions (B, C) [m], of whole cables."""
        whole = replace(self.robot, convention=CableConvention.MOTOR)
        slope = whole.lengths_jacobian(whole.home)
        return -slope[np.ix_(cable_rows(whole), bend_columns(whole))].T

    @cached_property
    def _sharing(self) -> Array:
        """Tensions by moments (C, B) [1/m]."""
        return np.array(np.linalg.pinv(self._lever), dtype=np.float64)
