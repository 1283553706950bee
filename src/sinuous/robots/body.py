"""The body as a chain of sections, and the points on it that are guarded.

A section is an arc, a straight stretch or a hinge. Between two guarded points on it the body is
covered by keeping a little more distance at the points themselves (notes B7).
"""

from dataclasses import dataclass
from functools import cached_property
from math import ceil

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.robots.chain_kernels import ARC, HINGE, STRAIGHT, Chain

# A section this little longer than a whole number of spacings is not cut once more.
ROUNDING = 1e-9


@dataclass(frozen=True, kw_only=True)
class Section:
    """A stretch of the body.

    Arguments:
        name: in words
        longest: largest arc length [m]
        radius: of the body [m]
        disks: at equal distances, the last one at its end, or none
        curvature: largest [1/m]
        theta: first column of what turns its end, -1 if it is straight
        hinge: whether it turns about its direction by one angle, and has no length
        tube: whether it is rigid and as thick as its radius says; else cables run free along it
        gamma: column of its length, -1 if that is fixed
        direction: unit vector in which it starts, in its own frame; z if it bends,
            the axis of a hinge
    """

    name: str
    longest: float
    radius: float
    disks: int = 0
    curvature: float = 0.0
    theta: int = -1
    hinge: bool = False
    tube: bool = False
    gamma: int = -1
    direction: tuple[float, float, float] = (0.0, 0.0, 1.0)

    @property
    def turns(self) -> int:
        """Number of coordinates that turn its end, see `chain_kernels.Chain`."""
        bends = HINGE if self.hinge else ARC
        return STRAIGHT if self.theta < 0 else bends

    def pieces(self, spacing: float) -> int:
        """Arcs between guarded points at most `spacing` [m] apart, a multiple of its disks."""
        parts = max(self.disks, 1)
        arcs = parts * max(1, ceil(self.longest / parts / spacing - ROUNDING))
        return 0 if self.hinge else arcs


@dataclass(frozen=True, kw_only=True, eq=False)
class Body:
    """Sections from base to tip, guarded at most `spacing` [m] apart; the base is a point too."""

    sections: tuple[Section, ...]
    spacing: float

    @cached_property
    def pieces(self) -> list[int]:
        """Arcs between guarded points in every section."""
        return [section.pieces(self.spacing) for section in self.sections]

    @cached_property
    def chain(self) -> Chain:
        """What the kernels need."""
        steps = [np.arange(1, count + 1) / max(count, 1) for count in self.pieces]
        owner = np.repeat(np.arange(len(self.sections)), self.pieces)
        return Chain(
            turns=np.array([s.turns for s in self.sections]),
            theta_column=np.array([s.theta for s in self.sections]),
            gamma_column=np.array([s.gamma for s in self.sections]),
            fixed_length=np.array([s.longest for s in self.sections]),
            direction=np.array([s.direction for s in self.sections]),
            section=np.concatenate([[0], owner]).astype(np.int64),
            fraction=np.concatenate([[0.0], *steps]),
        )

    @cached_property
    def movable(self) -> BoolArray:
        """Which points any actuator can move (S,): those after where the first section moves."""
        first = next(m for m, s in enumerate(self.sections) if s.turns or s.gamma >= 0)
        section, fraction = self.chain.section, self.chain.fraction
        return (section > first) | ((section == first) & (fraction > 0.0))

    @cached_property
    def radii(self) -> Array:
        """Body radius [m] (S,); where two sections meet, the larger one."""
        return self._at_points([s.radius for s in self.sections])

    @cached_property
    def disk_indices(self) -> IntArray:
        """Which of the guarded points are disks (D,)."""
        indices, start = list[int](), 0
        for section, count in zip(self.sections, self.pieces, strict=True):
            if section.disks:
                step = count // section.disks
                indices += range(start + step, start + count + 1, step)
            start += count
        return np.array(indices, dtype=np.int64)

    @cached_property
    def tubes(self) -> IntArray:
        """First and last guarded point of every section that is a tube (T, 2)."""
        last = np.cumsum(self.pieces)
        ends = [(last[m] - self.pieces[m], last[m]) for m, s in enumerate(self.sections) if s.tube]
        return np.array(ends, dtype=np.int64).reshape(-1, 2)

    def required_distance(self, margin: float) -> Array:
        """Distance [m] (S,) of the guarded points that keeps the whole body at the margin.

        Between two points an arc of length D and curvature k stays within the balls of
        radius sqrt((rho + margin)^2 + (D/2)^2) + k D^2 / 8 around them.
        """
        counts = [max(count, 1) for count in self.pieces]  # a hinge has no arcs, and no length
        arcs = [s.longest / count for s, count in zip(self.sections, counts, strict=True)]
        half = self._at_points([arc / 2 for arc in arcs])
        sagitta = self._at_points(
            [s.curvature * arc**2 / 8 for s, arc in zip(self.sections, arcs, strict=True)]
        )
        return np.hypot(self.radii + margin, half) + sagitta

    def point_name(self, index: int) -> str:
        """Where on the body a guarded point lies, in words."""
        section = self.sections[self.chain.section[index]]
        return f"{self.chain.fraction[index]:.0%} of {section.name}"

    def _at_points(self, values: list[float]) -> Array:
        """A value of every section at its points (S,); where two meet, the larger one."""
        spread = np.repeat(values, self.pieces)
        joints = np.cumsum(self.pieces)[:-1]
        spread = np.concatenate([spread[:1], spread])
        spread[joints] = np.maximum(spread[joints], spread[joints + 1])
        return spread
