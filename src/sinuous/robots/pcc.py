"""Tendon-driven robots of constant-curvature segments (paper B, section II-A).

Each segment has the coordinates (theta_x, theta_y, gamma): its bend vector and its arc
length.  Its cables then have the lengths q_m = gamma - r_m (theta_x cos s_m + theta_y
sin s_m), so the cable-sum rule (19) holds for every configuration and a straight segment
(theta = 0) is an ordinary point.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import hypot
from typing import Self

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray
from sinuous.robots import bending, chain_kernels, chain_second, routing
from sinuous.robots.bending import BendLimits
from sinuous.robots.body import Body, Section
from sinuous.robots.chain_kernels import Chain
from sinuous.robots.layout import Layout
from sinuous.robots.parts import CableConvention, Insertion, Segment, SpeedLimits, Tool
from sinuous.robots.routing import Routing


@dataclass(frozen=True, kw_only=True, eq=False)
class PccRobot:
    """Any number of constant-curvature segments, with an optional stage and tool.

    Coordinates (n,): [insertion], then per segment theta_x, theta_y [rad] and, where it is
    extensible, gamma [m].  Actuators (P,): [insertion], then per segment its cables and,
    where it is extensible, its backbone [m].
    """

    name: str
    segments: tuple[Segment, ...]
    speed: SpeedLimits
    convention: CableConvention = CableConvention.SEGMENT
    insertion: Insertion | None = None
    tool: Tool | None = None
    spacing: float = 0.003  # largest arc between guarded points [m]
    T_w_b: Array = field(default_factory=lambda: np.eye(4))  # base in the mesh's frame

    def at(self, T_w_b: ArrayLike) -> Self:
        """The same robot with its base at T_w_b (4, 4)."""
        return replace(self, T_w_b=np.array(T_w_b, dtype=float))

    def sampled(self, spacing: float) -> Self:
        """The same robot with its body guarded every `spacing` [m]."""
        return replace(self, spacing=spacing)

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

    @cached_property
    def _body(self) -> Body:
        return Body(sections=tuple(self._sections()), spacing=self.spacing)

    def _sections(self) -> Iterator[Section]:
        if self.insertion:
            reach = max(map(abs, self.insertion.travel))
            yield Section(name="the insertion shaft", longest=reach, radius=self.insertion.radius,
                          gamma=0)  # fmt: skip
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
        if self.tool and (reach := hypot(*self.tool.offset)) > 0.0:
            x, y, z = (value / reach for value in self.tool.offset)
            yield Section(
                name="the tool", longest=reach, radius=self.tool.radius, direction=(x, y, z)
            )

    @property
    def chain(self) -> Chain:
        """The body as plain arrays, what compiled controllers read; see `chain_kernels`."""
        return self._body.chain

    @property
    def movable(self) -> BoolArray:
        """Which guarded points any actuator can move (S,): all but the fixed base."""
        return self._body.movable

    @property
    def radii(self) -> Array:
        """Body radius [m] (S,) at the guarded points."""
        return self._body.radii

    @property
    def disk_indices(self) -> IntArray:
        """Which of the guarded points are disks (D,)."""
        return self._body.disk_indices

    def required_distance(self, margin: float) -> Array:
        """Distance [m] (S,) of the guarded points that keeps the whole body at the margin."""
        return self._body.required_distance(margin)

    def point_name(self, index: int) -> str:
        """Where on the body a guarded point lies, in words."""
        return self._body.point_name(index)

    def points(self, c: ArrayLike) -> Array:
        """Guarded points (..., S, 3) in the world frame [m], the base first, the tip last."""
        flat, shape = self._flat(c)
        out = np.empty((len(flat), len(self.radii), 3))
        chain_kernels.points_batch(self.chain, self.T_w_b, flat, out)
        return out.reshape(*shape, *out.shape[1:])

    def points_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (..., S, 3, n) of the points by the configuration, analytic."""
        flat, shape = self._flat(c)
        out = np.empty((len(flat), len(self.radii), 3, flat.shape[1]))
        chain_kernels.points_jacobian_batch(self.chain, self.T_w_b, flat, out)
        return out.reshape(*shape, *out.shape[1:])

    def tip(self, c: ArrayLike) -> Array:
        """Tip position (..., 3) [m]."""
        return self.tip_pose(c)[..., :3, 3]

    def tip_pose(self, c: ArrayLike) -> Array:
        """Tip pose T_w_t (..., 4, 4): at the tool's end, oriented like the last disk."""
        flat, shape = self._flat(c)
        sections = len(self._body.sections)
        T = np.tile(np.eye(4), (len(flat), 1, 1))
        R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
        for pose, one in zip(T, flat, strict=True):
            chain_kernels.frames(self.chain, self.T_w_b, one, R, p)
            pose[:3, :3], pose[:3, 3] = R[-1], p[-1]
        return T.reshape(*shape, 4, 4)

    def points_curvature(self, c: ArrayLike, forces: Array) -> Array:
        """Derivative (n, n) of the generalised force sum_s J_s' f_s, with f (S, 3) held."""
        value = np.ascontiguousarray(c, dtype=float)
        sections, n = len(self._body.sections), len(value)
        R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
        ends, spins = np.empty((sections, 3, 3)), np.empty((sections, 3, 2))
        chain_kernels.chain_derivative(self.chain, self.T_w_b, value, R, p, ends, spins)
        acting = np.flatnonzero(np.any(forces, axis=1))
        out, scratch = np.empty((n, n)), np.empty(chain_second.scratch_size(sections, n))
        chain_second.curvature(
            self.chain, value, R, p, ends, spins, acting, forces[acting], len(acting), scratch, out
        )
        return out

    def _flat(self, c: ArrayLike) -> tuple[Array, tuple[int, ...]]:
        value = np.asarray(c, dtype=float)
        return np.ascontiguousarray(value.reshape(-1, value.shape[-1])), value.shape[:-1]

    # --- bend limits ---------------------------------------------------------------------

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

    def bend_slack(self, c: ArrayLike) -> Array:
        """Cable travel left (..., J) [m] until a segment's bend limit (20): r (limit - |theta|)."""
        return bending.slack(self._bend_limits, np.asarray(c, dtype=float))

    def bend_slack_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (J, n) of the bend slack at one configuration (n,)."""
        return bending.slack_jacobian(self._bend_limits, np.asarray(c, dtype=float))
