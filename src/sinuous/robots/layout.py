"""Which coordinates and actuators a robot has, in which order, and how they are related."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.parts import CableConvention, Insertion, Segment, SpeedLimits


@dataclass(frozen=True, kw_only=True, eq=False)
class Layout:
    """Coordinates, actuators and limits of a chain of segments; see `PccRobot`."""

    segments: tuple[Segment, ...]
    speed: SpeedLimits
    convention: CableConvention
    insertion: Insertion | None

    @cached_property
    def columns(self) -> list[tuple[int, int]]:
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
        for segment, (_, gamma) in zip(self.segments, self.columns, strict=True):
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

    @cached_property
    def coordinate_limits(self) -> Array:
        # Lengths counted from the base do not limit each segment's own length.
        limits = np.tile([-np.inf, np.inf], (len(self.coordinate_names), 1))
        if self.convention is CableConvention.MOTOR:
            for segment, (_, gamma) in zip(self.segments, self.columns, strict=True):
                if gamma >= 0:
                    limits[gamma] = segment.length
        return limits

    @cached_property
    def inverse_holes(self) -> list[Array]:
        """Bend of every segment from its cables, by least squares (2, m) [1/m]."""
        return [np.array(np.linalg.pinv(s.holes), dtype=np.float64) for s in self.segments]

    @cached_property
    def length_map(self) -> tuple[Array, Array]:
        """A (P, n) and b (P,) with lengths = A c + b.

        By the motor convention cables and backbones count from the base, through all
        proximal segments, so (19) has the same form in both.
        """
        A = np.zeros((len(self.actuator_names), len(self.coordinate_names)))
        b = np.zeros(len(self.actuator_names))
        row = 0
        if self.insertion:
            A[0, 0] = 1.0
            row = 1
        for j, segment in enumerate(self.segments):
            cables = slice(row, row + len(segment.cable_angles))
            rows = slice(row, cables.stop + (1 if segment.extensible else 0))
            first = 0 if self.convention is CableConvention.MOTOR else j
            for passed in range(first, j + 1):
                theta, gamma = self.columns[passed]
                A[cables, theta : theta + 2] -= segment.holes
                if gamma >= 0:
                    A[rows, gamma] += 1.0
                else:
                    b[rows] += self.segments[passed].home_length
            row = rows.stop
        return A, b
