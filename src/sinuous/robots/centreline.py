"""The centre line of a robot as a chain of short arcs, each with its own curvature.

A model bends every segment evenly; a real robot does not. Cut at its guarded points, any robot
is a chain of short arcs, and as such `chain_kernels` already knows its kinematics and their
derivative. In front stands a hinge, an arc of no length, by which the base can be tilted;
behind may stand a rigid coil.

The curvature of an arc is (k_x, k_y) [1/m], in the frame that travels along the centre line
without twist: the direction z of the centre line turns by dz/ds = k_x x + k_y y.
"""

from dataclasses import dataclass
from functools import cached_property
from math import hypot

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.robots import chain_kernels
from sinuous.robots.chain_kernels import ARC, HINGE, STRAIGHT, Chain
from sinuous.robots.robot import Robot

TILT = 2  # coordinates of the base, before those of the arcs


@dataclass(frozen=True, kw_only=True, eq=False)
class Bends:
    """The shape of a centre line of A arcs.

    Arguments:
        lengths: of the arcs (A,) [m]
        curvature: of the arcs (A, 2) [1/m]; zero where the body is rigid
        tilt: of the base (2,), towards its x and y [rad]
    """

    lengths: Array
    curvature: Array
    tilt: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Centreline:
    """Cuts a robot into A = S - 1 arcs between its guarded points.

    Arguments:
        robot: whose guarded points are the joints
        coil: where a sensor sits beyond the tip, in the frame of the tip [m]
    """

    robot: Robot
    coil: tuple[float, float, float] = (0.0, 0.0, 0.0)

    # --- what does not change ------------------------------------------------------------

    @cached_property
    def section(self) -> IntArray:
        """Section of the robot's chain to which each arc belongs (A,)."""
        return self.robot.chain.section[1:]

    @cached_property
    def bends(self) -> BoolArray:
        """Which arcs can bend (A,)."""
        return self.robot.chain.turns[self.section] == ARC

    @cached_property
    def is_smooth(self) -> bool:
        """Whether nothing but its arcs bends it; a joint gives it a corner."""
        return not np.any(self.robot.chain.turns == HINGE)

    @cached_property
    def share(self) -> Array:
        """Length of each arc as a share of its section's (A,)."""
        before = np.where(np.diff(self.robot.chain.section) == 0, self.robot.chain.fraction[:-1], 0)
        return self.robot.chain.fraction[1:] - before

    @cached_property
    def middle(self) -> Array:
        """Fraction of its section at which the middle of each arc lies (A,)."""
        return self.robot.chain.fraction[1:] - 0.5 * self.share

    @cached_property
    def coordinates(self) -> int:
        """Number of coordinates: the tilt, then x and y of every arc that bends."""
        return TILT + 2 * int(np.count_nonzero(self.bends))

    # --- what the model says -------------------------------------------------------------

    def section_lengths(self, c: Array) -> Array:
        """Lengths (M,) [m] of the sections by the model."""
        chain = self.robot.chain
        return np.where(chain.gamma_column < 0, chain.fixed_length, c[chain.gamma_column])

    def section_bends(self, c: Array) -> Array:
        """Bend vectors (M, 2) [rad] of the sections by the model; zero where rigid."""
        theta, arc = self.robot.chain.theta_column, self.robot.chain.turns == ARC
        return np.where(arc[:, None], c[np.where(arc, theta, 0)[:, None] + np.arange(2)], 0.0)

    def model(self, c: Array) -> Bends:
        """The shape of a configuration (n,) by the model: every section bends evenly."""
        lengths = self.section_lengths(c)
        return Bends(
            lengths=lengths[self.section] * self.share,
            curvature=self.curvature(self.section_bends(c), lengths),
            tilt=np.zeros(TILT),
        )

    def curvature(self, bends: Array, lengths: Array) -> Array:
        """Curvature (A, 2) [1/m] of every arc if its section bends evenly.

        Arguments:
            bends: bend vectors of the sections (M, 2) [rad]
            lengths: of the sections (M,) [m]; an insertion shaft that is all the way back has none
        """
        out = np.zeros_like(bends)
        np.divide(bends, lengths[:, None], out=out, where=lengths[:, None] > 0.0)
        return out[self.section]

    # --- kinematics ----------------------------------------------------------------------

    def frames(self, bends: Bends) -> tuple[Array, Array]:
        """Orientation (S, 3, 3) and position (S, 3) [m] of the guarded points in the world."""
        chain, x = self._chain(bends.lengths), self._coordinates(bends)
        sections = len(chain.theta_column)
        R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
        chain_kernels.frames(chain, self.robot.T_w_b, x, R, p)
        last = len(bends.lengths) + 2
        return R[1:last], p[1:last]

    def points_with_jacobian(self, bends: Bends) -> tuple[Array, Array]:
        """Guarded points and the coil (S + 1, 3) [m] and their derivative (S + 1, 3, n).

        The n coordinates are those of `coordinates`: tilt [rad], then curvatures [1/m].
        """
        chain, x = self._chain(bends.lengths), self._coordinates(bends)
        T = self.robot.T_w_b
        points, jacobian = (
            np.empty((len(chain.section), 3)),
            np.empty((len(chain.section), 3, len(x))),
        )
        chain_kernels.points(chain, T, x, points)
        chain_kernels.points_jacobian_batch(chain, T, x[None], jacobian[None])
        jacobian[:, :, TILT:] *= np.repeat(bends.lengths[self.bends], 2)
        return points, jacobian

    def _coordinates(self, bends: Bends) -> Array:
        """Tilt and bend vectors [rad], as the chain reads them."""
        theta = bends.curvature[self.bends] * bends.lengths[self.bends, None]
        return np.concatenate([bends.tilt, theta.ravel()])

    def _chain(self, lengths: Array) -> Chain:
        """The hinge, every arc and the coil, each a section with its guarded point at its end."""
        reach = hypot(*self.coil)
        theta, direction = self._rows
        sections = np.arange(len(theta))
        return Chain(
            turns=np.where(theta < 0, STRAIGHT, ARC),
            theta_column=theta,
            gamma_column=np.full(len(theta), -1),
            fixed_length=np.concatenate([[0.0], lengths, [reach]]),
            direction=direction,
            section=sections,
            fraction=np.ones(len(theta)),
        )

    @cached_property
    def _rows(self) -> tuple[IntArray, Array]:
        """First column and direction of the hinge, the arcs and the coil."""
        arcs = np.full(len(self.section), -1)
        arcs[self.bends] = TILT + 2 * np.arange(np.count_nonzero(self.bends))
        theta = np.concatenate([[0], arcs, [-1]])
        reach = hypot(*self.coil)
        coil = np.array(self.coil) / reach if reach > 0.0 else np.array([0.0, 0.0, 1.0])
        along = self.robot.chain.direction[self.section]
        return theta, np.concatenate([[[0.0, 0.0, 1.0]], along, coil[None]])
