"""The format of robot files: tables of millimetres and degrees, and what they must obey."""

from dataclasses import dataclass
from math import inf
from typing import Annotated

import numpy as np
from pydantic import Field

from sinuous.files import Angle, Curvature, FieldError, Length, Place, Speed
from sinuous.robots.parts import CableConvention

# Least ratio of the singular values of a segment's cable offsets: below it the bend across
# the cables' common plane would be read from length differences under a thousandth of it.
_LEAST_SPREAD = 1e-3

_Positive = Field(gt=0.0)
_Range = tuple[Length, Length]


@dataclass(frozen=True, kw_only=True)
class SegmentTable:
    """`[[segment]]`, from base to tip."""

    length: Annotated[Length, _Positive] | tuple[Annotated[Length, _Positive], Length]
    disks: Annotated[int, Field(ge=1)]
    cable_angles: Annotated[tuple[Angle, ...], Field(min_length=3)]
    pitch_radius: Annotated[Length, _Positive] | tuple[Annotated[Length, _Positive], ...]
    body_radius: Annotated[Length, _Positive]
    disk_thickness: Annotated[Length, _Positive]
    home_length: Length | None = None
    min_bend_radius: Annotated[Length, _Positive] | None = None
    max_curvature: Annotated[Curvature, _Positive] | None = None

    def __post_init__(self) -> None:
        self._check_lengths()
        self._check_cables()
        if self.min_bend_radius is not None and self.max_curvature is not None:
            raise FieldError(
                "min_bend_radius",
                expected="either a least bend radius or a largest curvature",
                remedy="Keep one of them: one is the inverse of the other.",
            )

    @property
    def range(self) -> tuple[float, float]:
        """Shortest and longest backbone [m]."""
        return self.length if isinstance(self.length, tuple) else (self.length, self.length)

    @property
    def extensible(self) -> bool:
        """Whether the backbone is an actuator."""
        return isinstance(self.length, tuple)

    @property
    def home(self) -> float:
        """Length [m] to start from: the stated one or the middle."""
        return sum(self.range) / 2 if self.home_length is None else self.home_length

    @property
    def radii(self) -> tuple[float, ...]:
        """Pitch radius of every cable [m]."""
        one = self.pitch_radius
        return one if isinstance(one, tuple) else (one,) * len(self.cable_angles)

    @property
    def curvature(self) -> float:
        """Largest curvature [1/m], infinite if none is stated."""
        if self.min_bend_radius is not None:
            return 1.0 / self.min_bend_radius
        return inf if self.max_curvature is None else self.max_curvature

    def _check_lengths(self) -> None:
        shortest, longest = self.range
        if isinstance(self.length, tuple):
            _check_range("length", self.length)
        if not shortest <= self.home <= longest:
            raise FieldError(
                "home_length",
                expected="a length between the shortest and the longest",
                remedy="Correct it, or leave it out for the middle.",
            )
        if self.disks * self.disk_thickness >= shortest:
            raise FieldError(
                "disk_thickness",
                expected=f"{self.disks} disks that leave room to bend in the shortest length",
                remedy="Take fewer or thinner disks, or a longer segment.",
            )

    def _check_cables(self) -> None:
        if len(self.radii) != len(self.cable_angles):
            raise FieldError(
                "pitch_radius",
                expected=f"one number, or {len(self.cable_angles)}, one for each cable",
                remedy="Give as many radii as cable angles.",
            )
        if max(self.radii) >= self.body_radius:
            raise FieldError(
                "pitch_radius",
                expected="cables inside the body, closer to the backbone than the body radius",
                remedy="Correct the pitch radius or the body radius.",
            )
        angles, radii = np.array(self.cable_angles), np.array(self.radii)
        spread = np.linalg.svd(radii * np.array([np.cos(angles), np.sin(angles)]), compute_uv=False)
        if spread[1] < _LEAST_SPREAD * spread[0]:
            raise FieldError(
                "cable_angles",
                expected="cables around the backbone, not all on one line through it",
                remedy="Spread the holes, for example 0, 120 and 240 degrees.",
            )


@dataclass(frozen=True, kw_only=True)
class InsertionTable:
    """`[insertion]`: a stage that pushes the base forward; home is its start by default."""

    travel: _Range
    radius: Annotated[Length, _Positive]
    home: Length | None = None

    def __post_init__(self) -> None:
        _check_range("travel", self.travel)
        if not self.travel[0] <= self.start <= self.travel[1]:
            raise FieldError(
                "home",
                expected="a position within the travel",
                remedy="Correct it, or leave it out for the start of the travel.",
            )

    @property
    def start(self) -> float:
        """Position [m] to start from."""
        return self.travel[0] if self.home is None else self.home


@dataclass(frozen=True, kw_only=True)
class ToolTable:
    """`[tool]`: what the last disk carries; its end is the tip."""

    offset: tuple[Length, Length, Length]
    radius: Annotated[Length, _Positive]


@dataclass(frozen=True, kw_only=True)
class LimitsTable:
    """`[limits.NAME]`: what the actuators may do in the simulation, or on the hardware."""

    cable_speed: Annotated[Speed, _Positive]
    cable_length: _Range | tuple[_Range, ...]  # one pair for all segments, or one for each
    backbone_speed: Annotated[Speed, _Positive] | None = None
    insertion_speed: Annotated[Speed, _Positive] | None = None

    def cable_lengths(self, segments: int) -> list[tuple[float, float]]:
        """Return the shortest and longest cable length [m] of every segment."""
        pairs = [pair for pair in self.cable_length if isinstance(pair, tuple)]
        if pairs:
            return pairs
        low, high = (value for value in self.cable_length if not isinstance(value, tuple))
        return [(low, high)] * segments


@dataclass(frozen=True, kw_only=True)
class RobotTable:
    """A robot file."""

    name: Annotated[str, Field(min_length=1)]
    segment: Annotated[tuple[SegmentTable, ...], Field(min_length=1)]
    limits: Annotated[dict[str, LimitsTable], Field(min_length=1)]
    about: str = ""
    cable_convention: CableConvention = CableConvention.SEGMENT
    guard_spacing: Annotated[Length, _Positive] = 0.003
    insertion: InsertionTable | None = None
    tool: ToolTable | None = None

    def __post_init__(self) -> None:
        for name, limits in self.limits.items():
            place = ("limits", name)
            if limits.backbone_speed is None and any(table.extensible for table in self.segment):
                raise _speed_missing((*place, "backbone_speed"), "a segment changes its length")
            if limits.insertion_speed is None and self.insertion is not None:
                raise _speed_missing((*place, "insertion_speed"), "there is an insertion stage")
            self._check_cable_lengths((*place, "cable_length"), limits)

    def _check_cable_lengths(self, place: Place, limits: LimitsTable) -> None:
        if len(limits.cable_lengths(len(self.segment))) != len(self.segment):
            raise FieldError(
                place,
                expected=f"one pair, or {len(self.segment)}, one for each segment",
                remedy="Give as many pairs as segments.",
            )
        home = 0.0
        for number, table in enumerate(self.segment, start=1):
            passed = home if self.cable_convention is CableConvention.MOTOR else 0.0
            home = passed + table.home
            low, high = limits.cable_lengths(len(self.segment))[number - 1]
            if not low < home < high:
                raise FieldError(
                    place,
                    expected=f"a shortest length below and a longest above {home * 1e3:g} mm, "
                    f"the length of segment {number}'s cables at home",
                    remedy="Otherwise they cannot move both ways: correct the limits, the home "
                    "length or the cable convention.",
                )


def _check_range(field: str, limits: tuple[float, float]) -> None:
    if not limits[0] < limits[1]:
        raise FieldError(
            field,
            expected="a smaller and then a larger value",
            remedy="Put the smaller first; for a fixed length give a single number.",
        )


def _speed_missing(place: Place, reason: str) -> FieldError:
    return FieldError(
        place,
        expected=f"a speed, because {reason}",
        remedy=f"Add {place[-1]}_mm_s to [{'.'.join(map(str, place[:-1]))}].",
    )
