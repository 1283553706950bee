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

from sinuous.arrays import Array, ArrayLike, IntArray
from sinuous.robots import pcc_kernels
from sinuous.robots.body import Body, Section
from sinuous.robots.parts import CableConvention, Insertion, Segment, SpeedLimits, Tool

# Bends smaller than this have no direction worth naming: the slack's gradient ignores them.
STRAIGHT = 1e-9


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
    def _columns(self) -> list[tuple[int, int]]:
        """Columns (theta_x, gamma or -1) of every segment."""
        column, columns = (1 if self.insertion else 0), list[tuple[int, int]]()
        for segment in self.segments:
            columns.append((column, column + 2 if segment.extensible else -1))
            column += 3 if segment.extensible else 2
        return columns

    @cached_property
    def coordinate_names(self) -> tuple[str, ...]:
        names = ["insertion"] if self.insertion else []
        for j, segment in enumerate(self.segments, 1):
            names += [f"segment {j} theta_x", f"segment {j} theta_y"]
            names += [f"segment {j} length"] if segment.extensible else []
        return tuple(names)

    @cached_property
    def actuator_names(self) -> tuple[str, ...]:
        names = ["insertion"] if self.insertion else []
        for j, segment in enumerate(self.segments, 1):
            names += [f"segment {j} cable {m}" for m in range(1, len(segment.cable_angles) + 1)]
            names += [f"segment {j} backbone"] if segment.extensible else []
        return tuple(names)

    @cached_property
    def bend_names(self) -> tuple[str, ...]:
        return tuple(
            f"segment {j} {'bend' if row == len(s.bend_planes) - 1 else 'curvature'}"
            for j, s in enumerate(self.segments, 1)
            for row in range(len(s.bend_planes))
        )

    @cached_property
    def home(self) -> Array:
        c = np.zeros(len(self.coordinate_names))
        if self.insertion:
            c[0] = self.insertion.home
        for segment, (_, gamma) in zip(self.segments, self._columns, strict=True):
            if gamma >= 0:
                c[gamma] = segment.home_length
        return c

    @cached_property
    def rate_limits(self) -> Array:
        fastest = [self.speed.insertion] if self.insertion else []
        for segment in self.segments:
            fastest += [self.speed.cable] * len(segment.cable_angles)
            fastest += [self.speed.backbone] if segment.extensible else []
        return np.stack([-np.array(fastest), np.array(fastest)], axis=1)

    @cached_property
    def length_limits(self) -> Array:
        limits = [self.insertion.travel] if self.insertion else []
        shortest, longest = 0.0, 0.0
        for segment in self.segments:
            if self.convention is CableConvention.SEGMENT:
                shortest, longest = 0.0, 0.0
            shortest, longest = shortest + segment.length[0], longest + segment.length[1]
            limits += [segment.cable_length] * len(segment.cable_angles)
            limits += [(shortest, longest)] if segment.extensible else []
        return np.array(limits)

    # --- actuator lengths ----------------------------------------------------------------

    @cached_property
    def _length_map(self) -> tuple[Array, Array]:
        """A (P, n) and b (P,) with lengths = A c + b."""
        A = np.zeros((len(self.actuator_names), len(self.coordinate_names)))
        b = np.zeros(len(self.actuator_names))
        row = 0
        if self.insertion:
            A[0, 0] = 1.0
            row = 1
        for j, segment in enumerate(self.segments):
            first = 0 if self.convention is CableConvention.MOTOR else j
            holes = segment.holes
            backbone = row + len(holes)
            rows = slice(row, backbone + (1 if segment.extensible else 0))
            for passed in range(first, j + 1):
                theta, gamma = self._columns[passed]
                A[row:backbone, theta : theta + 2] -= holes
                if gamma >= 0:
                    A[rows, gamma] += 1.0
                else:
                    b[rows] += self.segments[passed].home_length
            row = rows.stop
        return A, b

    def lengths(self, c: ArrayLike) -> Array:
        """Actuator lengths (..., P) [m] of configurations (..., n), paper B eq. (1), (19)."""
        A, b = self._length_map
        return np.asarray(c, dtype=float) @ A.T + b

    def lengths_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (P, n) of the lengths; constant, because they are affine in c."""
        return self._length_map[0]

    def configuration(self, lengths: ArrayLike) -> Array:
        """Configuration (..., n) of actuator lengths (..., P).

        The backbone reading gives gamma, least squares over the cables give the bend.  If
        the lengths violate (19), the violation is what least squares leaves over.
        """
        q = np.asarray(lengths, dtype=float)
        c = np.zeros((*q.shape[:-1], len(self.coordinate_names)))
        A, b = self._length_map
        row = 0
        if self.insertion:
            c[..., 0] = q[..., 0]
            row = 1
        for segment, (theta, gamma) in zip(self.segments, self._columns, strict=True):
            cables = slice(row, row + len(segment.cable_angles))
            row = cables.stop
            if gamma >= 0:
                c[..., gamma] = q[..., row] - (c @ A[row] + b[row])
                row += 1
            rest = q[..., cables] - (c @ A[cables].T + b[cables])
            c[..., theta : theta + 2] = -rest @ np.linalg.pinv(segment.holes).T
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
        columns = zip(self.segments, self._columns, strict=True)
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
        pcc_kernels.points_batch(self._body.chain, self.T_w_b, flat, out)
        return out.reshape(*shape, *out.shape[1:])

    def points_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (..., S, 3, n) of the points by the configuration, analytic."""
        flat, shape = self._flat(c)
        out = np.empty((len(flat), len(self.radii), 3, flat.shape[1]))
        pcc_kernels.points_jacobian_batch(self._body.chain, self.T_w_b, flat, out)
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
            pcc_kernels.frames(self._body.chain, self.T_w_b, one, R, p)
            pose[:3, :3], pose[:3, 3] = R[-1], p[-1]
        return T.reshape(*shape, 4, 4)

    def points_curvature(self, c: ArrayLike, forces: Array) -> Array:
        """Derivative (n, n) of the generalised force sum_s J_s' f_s, with f (S, 3) held.

        By central differences of the analytic Jacobian: it shapes the step of an optimiser
        and needs no more than a few digits.
        """
        value = np.asarray(c, dtype=float)
        out = np.empty((len(value), len(value)))
        pcc_kernels.curvature(self._body.chain, self.T_w_b, value, forces, out)
        return out

    def _flat(self, c: ArrayLike) -> tuple[Array, tuple[int, ...]]:
        value = np.asarray(c, dtype=float)
        return np.ascontiguousarray(value.reshape(-1, value.shape[-1])), value.shape[:-1]

    # --- bend limits ---------------------------------------------------------------------

    @cached_property
    def _bend_limits(self) -> tuple[IntArray, Array, Array, Array]:
        """Column of theta_x, map (J, n) and offset (J,) of the largest bend, pitch radius."""
        thetas, slopes, offsets, pitches = list[int](), list[Array](), list[float](), list[float]()
        for segment, (theta, gamma) in zip(self.segments, self._columns, strict=True):
            for slope, offset in segment.bend_planes:
                row = np.zeros(len(self.coordinate_names))
                if gamma >= 0:
                    row[gamma] = slope
                thetas.append(theta)
                slopes.append(row)
                offsets.append(offset + (0.0 if gamma >= 0 else slope * segment.home_length))
                pitches.append(max(segment.pitch_radii))
        return np.array(thetas), np.array(slopes), np.array(offsets), np.array(pitches)

    def bend_slack(self, c: ArrayLike) -> Array:
        """Cable travel left (..., J) [m] until a segment's bend limit (20): r (limit - |theta|)."""
        value = np.asarray(c, dtype=float)
        theta, slope, offset, pitch = self._bend_limits
        bend = np.hypot(value[..., theta], value[..., theta + 1])
        return pitch * (value @ slope.T + offset - bend)

    def bend_slack_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (J, n) of the bend slack at one configuration (n,)."""
        value = np.asarray(c, dtype=float)
        theta, slope, _, pitch = self._bend_limits
        bend = np.hypot(value[theta], value[theta + 1])
        rows, inverse = np.arange(len(theta)), 1.0 / np.where(bend > STRAIGHT, bend, np.inf)
        jacobian = slope.copy()
        for k in range(2):
            jacobian[rows, theta + k] -= value[theta + k] * inverse
        return pitch[:, None] * jacobian
