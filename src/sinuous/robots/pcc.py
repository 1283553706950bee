"""Tendon-driven robots of constant-curvature segments (paper B, section II-A).

Each segment has the coordinates (theta_x, theta_y, gamma): its bend vector and its arc
length.  Its cables then have the lengths q_m = gamma - r_m (theta_x cos s_m + theta_y
sin s_m), so the cable-sum rule (19) holds for every configuration and a straight segment
(theta = 0) is an ordinary point.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.robots import routing
from sinuous.robots.bending import BendLimits
from sinuous.robots.body import Section
from sinuous.robots.chain_robot import ChainRobot
from sinuous.robots.fitted_tables import Fitted
from sinuous.robots.layout import Layout
from sinuous.robots.parts import CableConvention, Segment
from sinuous.robots.rod_mechanics import RodMechanics
from sinuous.robots.routing import Routing


@dataclass(frozen=True, kw_only=True, eq=False)
class PccRobot(ChainRobot):
    """Any number of constant-curvature segments, with an optional stage and tool.

    Coordinates (n,): [insertion], then per segment theta_x, theta_y [rad] and, where it is
    extensible, gamma [m].  Actuators (P,): [insertion], then per segment its cables and,
    where it is extensible, its backbone [m].  The mechanics are what makes it move if physics
    does; kinematics and controllers do not read them.
    """

    segments: tuple[Segment, ...]
    convention: CableConvention = CableConvention.SEGMENT
    mechanics: RodMechanics = field(default_factory=RodMechanics)
    fitted: Fitted | None = None  # what was found out about one real robot

    # --- coordinates and actuators -------------------------------------------------------

    @cached_property
    def _layout(self) -> Layout:
        return Layout(
            segments=self.segments,
            speed=self.speed,
            convention=self.convention,
            insertion=self.insertion,
        )

    @property
    def coordinate_names(self) -> tuple[str, ...]:
        """Names of the coordinates (n,)."""
        return self._layout.coordinate_names

    @property
    def actuator_names(self) -> tuple[str, ...]:
        """Names of the actuators (P,)."""
        return self._layout.actuator_names

    @property
    def bend_names(self) -> tuple[str, ...]:
        """Names of the bend limits (J,)."""
        return self._layout.bend_names

    @property
    def home(self) -> Array:
        """Configuration (n,) to start from."""
        return self._layout.home

    @property
    def rate_limits(self) -> Array:
        """Slowest and fastest actuator rates [m/s] (P, 2)."""
        return self._layout.rate_limits

    @property
    def length_limits(self) -> Array:
        """Shortest and longest actuator lengths [m] (P, 2)."""
        return self._layout.length_limits

    @property
    def coordinate_limits(self) -> Array:
        """Limits of the coordinates (n, 2) that no actuator's limits imply."""
        return self._layout.coordinate_limits

    def lengths(self, c: ArrayLike) -> Array:
        """Actuator lengths (..., P) [m] of configurations (..., n), paper B eq. (1), (19)."""
        A, b = self._layout.length_map
        return np.asarray(c, dtype=float) @ A.T + b

    def lengths_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (P, n) of the lengths; constant, because they are affine in c."""
        return self._layout.length_map[0]

    @property
    def routing(self) -> Routing:
        """The cables as plain arrays: no joints to cross."""
        return self._routing

    @cached_property
    def _routing(self) -> Routing:
        return routing.affine(*self._layout.length_map)

    def configuration(self, lengths: ArrayLike) -> Array:
        """Configuration (..., n) of actuator lengths (..., P).

        The backbone reading gives gamma, least squares over the cables give the bend.  If
        the lengths violate (19), the violation is what least squares leaves over.
        """
        q = np.asarray(lengths, dtype=float)
        c = np.zeros((*q.shape[:-1], len(self.coordinate_names)))
        A, b = self._layout.length_map
        row = 0
        if self.insertion:
            c[..., 0] = q[..., 0]
            row = 1
        for inverse, (theta, gamma) in zip(
            self._layout.inverse_holes, self._layout.columns, strict=True
        ):
            cables = slice(row, row + inverse.shape[1])
            row = cables.stop
            if gamma >= 0:
                c[..., gamma] = q[..., row] - (c @ A[row] + b[row])
                row += 1
            rest = q[..., cables] - (c @ A[cables].T + b[cables])
            c[..., theta : theta + 2] = -rest @ inverse.T
        return c

    # --- body ----------------------------------------------------------------------------

    def _links(self) -> Iterator[Section]:
        """The segments."""
        columns = zip(self.segments, self._layout.columns, strict=True)
        for j, (segment, (theta, gamma)) in enumerate(columns, 1):
            yield Section(
                name=f"segment {j}",
                longest=segment.length[1] if gamma >= 0 else segment.home_length,
                radius=segment.body_radius,
                disks=segment.disks,
                curvature=segment.largest_curvature,
                theta=theta,
                gamma=gamma,
            )

    @property
    def bend_limits(self) -> BendLimits:
        """Largest bends (20), in cable travel."""
        return self._bend_limits

    @cached_property
    def _bend_limits(self) -> BendLimits:
        thetas, slopes, offsets, pitches = list[int](), list[Array](), list[float](), list[float]()
        for segment, (theta, gamma) in zip(self.segments, self._layout.columns, strict=True):
            for slope, offset in segment.bend_planes:
                row = np.zeros(len(self.coordinate_names))
                if gamma >= 0:
                    row[gamma] = slope
                thetas.append(theta)
                slopes.append(row)
                offsets.append(offset + (0.0 if gamma >= 0 else slope * segment.home_length))
                pitches.append(max(segment.pitch_radii))
        return BendLimits(
            column=np.array(thetas),
            is_joint=np.zeros(len(thetas), dtype=np.bool_),
            slope=np.array(slopes),
            offset=np.array(offsets),
            pitch=np.array(pitches),
        )
