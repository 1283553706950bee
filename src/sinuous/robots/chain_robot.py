"""What all robots share whose body is a chain of sections: its points, poses and derivatives."""

from abc import ABC, abstractmethod
from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from functools import cached_property
from math import hypot
from typing import ClassVar, Self

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray, IntArray
from sinuous.robots import bending, chain_kernels, chain_second, pose_kernels
from sinuous.robots.bending import BendLimits
from sinuous.robots.body import Body, Section
from sinuous.robots.chain_kernels import Chain
from sinuous.robots.parts import Insertion, SpeedLimits, Tool


def flat_rows(values: ArrayLike) -> tuple[Array, tuple[int, ...]]:
    """Rows of the last axis (B, n), and the shape of the axes before."""
    rows = np.ascontiguousarray(values, dtype=float)
    if rows.ndim == 1:  # by far the most frequent, and at the highest rate
        return rows[None], ()
    return rows.reshape(-1, rows.shape[-1]), rows.shape[:-1]


def unflat(rows: Array, shape: tuple[int, ...]) -> Array:
    """What was computed for every row (B, ...), with the axes that `flat_rows` took away."""
    return rows.reshape(*shape, *rows.shape[1:]) if shape else rows[0]


@dataclass(frozen=True, kw_only=True, eq=False)
class ChainRobot(ABC):
    """A body that may stand on an insertion stage, the first coordinate, and carry a tool."""

    AXIS: ClassVar[tuple[float, float, float]] = (0.0, 0.0, 1.0)
    """Of the straight robot, in the frame of its base."""

    name: str
    speed: SpeedLimits
    insertion: Insertion | None = None
    tool: Tool | None = None
    spacing: float = 0.003  # largest arc between guarded points [m]
    T_w_b: Array = field(default_factory=lambda: np.eye(4))  # base in the mesh's frame

    @abstractmethod
    def _links(self) -> Iterator[Section]:
        """The sections between stage and tool."""

    @property
    @abstractmethod
    def bend_limits(self) -> BendLimits:
        """How far segments or joints may be bent."""

    def at(self, T_w_b: ArrayLike) -> Self:
        """The same robot with its base at T_w_b (4, 4)."""
        return replace(self, T_w_b=np.array(T_w_b, dtype=float))

    def sampled(self, spacing: float) -> Self:
        """The same robot with its body guarded every `spacing` [m]."""
        return replace(self, spacing=spacing)

    # --- body ----------------------------------------------------------------------------

    @cached_property
    def body(self) -> Body:
        """The sections from base to tip, and where on them the guarded points lie."""
        return Body(sections=tuple(self._sections()), spacing=self.spacing)

    def _sections(self) -> Iterator[Section]:
        if self.insertion:
            reach = max(map(abs, self.insertion.travel))
            yield Section(name="the insertion shaft", longest=reach, radius=self.insertion.radius,
                          gamma=0, direction=self.AXIS, tube=True)  # fmt: skip
        yield from self._links()
        if self.tool and (reach := hypot(*self.tool.offset)) > 0.0:
            x, y, z = (value / reach for value in self.tool.offset)
            yield Section(name="the tool", longest=reach, radius=self.tool.radius,
                          direction=(x, y, z))  # fmt: skip

    @property
    def chain(self) -> Chain:
        """The body as plain arrays, what compiled controllers read; see `chain_kernels`."""
        return self.body.chain

    @property
    def movable(self) -> BoolArray:
        """Which guarded points any actuator can move (S,): all but the fixed base."""
        return self.body.movable

    @property
    def radii(self) -> Array:
        """Body radius [m] (S,) at the guarded points."""
        return self.body.radii

    @property
    def disk_indices(self) -> IntArray:
        """Which of the guarded points are disks (D,)."""
        return self.body.disk_indices

    @property
    def tubes(self) -> IntArray:
        """First and last guarded point of every rigid tube of the body (T, 2)."""
        return self.body.tubes

    def required_distance(self, margin: float) -> Array:
        """Distance [m] (S,) of the guarded points that keeps the whole body at the margin."""
        return self.body.required_distance(margin)

    def point_name(self, index: int) -> str:
        """Where on the body a guarded point lies, in words."""
        return self.body.point_name(index)

    # --- shape ---------------------------------------------------------------------------

    def points(self, c: ArrayLike) -> Array:
        """Guarded points (..., S, 3) in the world frame [m], the base first, the tip last."""
        flat, shape = flat_rows(c)
        out = np.empty((len(flat), len(self.radii), 3))
        chain_kernels.points_batch(self.chain, self.T_w_b, flat, out)
        return unflat(out, shape)

    def points_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (..., S, 3, n) of the points by the configuration, analytic."""
        flat, shape = flat_rows(c)
        out = np.empty((len(flat), len(self.radii), 3, flat.shape[1]))
        chain_kernels.points_jacobian_batch(self.chain, self.T_w_b, flat, out)
        return unflat(out, shape)

    def tip(self, c: ArrayLike) -> Array:
        """Tip position (..., 3) [m]."""
        return self.tip_pose(c)[..., :3, 3]

    def tip_pose(self, c: ArrayLike) -> Array:
        """Tip pose T_w_t (..., 4, 4): at the tool's end, oriented like the end of the body."""
        return self._poses(c, self._tip_start)[..., 0, :, :]

    def shape(self, c: ArrayLike) -> tuple[Array, Array]:
        """Points (..., S, 3) [m] and tip pose (..., 4, 4) at once."""
        flat, shape = flat_rows(c)
        points, tips = np.empty((len(flat), len(self.radii), 3)), np.empty((len(flat), 4, 4))
        pose_kernels.shapes_batch(self.chain, self.T_w_b, flat, points, tips)
        return unflat(points, shape), unflat(tips, shape)

    def points_curvature(self, c: ArrayLike, forces: Array) -> Array:
        """Derivative (n, n) of the generalised force sum_s J_s' f_s, with f (S, 3) held."""
        value = np.ascontiguousarray(c, dtype=float)
        sections, n = len(self.body.sections), len(value)
        R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
        ends, spins = np.empty((sections, 3, 3)), np.empty((sections, 3, 2))
        chain_kernels.chain_derivative(self.chain, self.T_w_b, value, R, p, ends, spins)
        acting = np.flatnonzero(np.any(forces, axis=1))
        out, scratch = np.empty((n, n)), np.empty(chain_second.scratch_size(sections, n))
        chain_second.curvature(
            self.chain, value, R, p, ends, spins, acting, forces[acting], len(acting), scratch, out
        )
        return out

    @cached_property
    def _tip_start(self) -> IntArray:
        return np.array([len(self.body.sections)])

    def _poses(self, c: ArrayLike, starts: IntArray) -> Array:
        """Poses (..., K, 4, 4) in the world where the sections `starts` (K,) start."""
        flat, shape = flat_rows(c)
        out = np.empty((len(flat), len(starts), 4, 4))
        pose_kernels.poses_batch(self.chain, self.T_w_b, flat, starts, out)
        return unflat(out, shape)

    # --- bend limits ---------------------------------------------------------------------

    def bend_slack(self, c: ArrayLike) -> Array:
        """Cable travel left (..., J) [m] until a bend limit; negative: bent too far."""
        return bending.slack(self.bend_limits, np.asarray(c, dtype=float))

    def bend_slack_jacobian(self, c: ArrayLike) -> Array:
        """Derivative (J, n) of the bend slack at one configuration (n,)."""
        return bending.slack_jacobian(self.bend_limits, np.asarray(c, dtype=float))
