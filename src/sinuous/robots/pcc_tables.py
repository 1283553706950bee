"""The format of robot files with segments: millimetres and degrees, and what they must obey."""

from dataclasses import dataclass, field
from math import inf
from typing import Annotated

import numpy as np
from pydantic import Field

from sinuous.files import Angle, Curvature, FieldError, Length, Speed
from sinuous.robots.fitted_tables import FittedTable
from sinuous.robots.parts import CableConvention, Segment, SpeedLimits
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_tables import (
    LimitsTable,
    Positive,
    Ranges,
    RobotTable,
    check_range,
    check_ranges,
    one_each,
    speed_missing,
)
from sinuous.robots.rod_tables import RodPhysicsTable

# Least ratio of the singular values of a segment's cable offsets: below it the bend across
# the cables' common plane would be read from length differences under a thousandth of it.
_LEAST_SPREAD = 1e-3


@dataclass(frozen=True, kw_only=True)
class SegmentTable:
    """`[[segment]]`, from base to tip."""

    length: Annotated[Length, Positive] | tuple[Annotated[Length, Positive], Length]
    disks: Annotated[int, Field(ge=1)]
    cable_angles: Annotated[tuple[Angle, ...], Field(min_length=3)]
    pitch_radius: Annotated[Length, Positive] | tuple[Annotated[Length, Positive], ...]
    body_radius: Annotated[Length, Positive]
    disk_thickness: Annotated[Length, Positive]
    home_length: Length | None = None
    min_bend_radius: Annotated[Length, Positive] | None = None
    max_curvature: Annotated[Curvature, Positive] | None = None
    effective_pitch: Annotated[Length, Positive] | None = None  # of elastic cables, by calibration

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
    def effective_radii(self) -> tuple[float, ...]:
        """Pitch radius of every cable [m] that kinematics reckon with."""
        one = self.effective_pitch
        return self.radii if one is None else (one,) * len(self.cable_angles)

    @property
    def curvature(self) -> float:
        """Largest curvature [1/m], infinite if none is stated."""
        if self.min_bend_radius is not None:
            return 1.0 / self.min_bend_radius
        return inf if self.max_curvature is None else self.max_curvature

    def part(self, cable_length: tuple[float, float]) -> Segment:
        """Return what the robot is built from."""
        return Segment(
            length=self.range,
            home_length=self.home,
            disks=self.disks,
            cable_angles=self.cable_angles,
            pitch_radii=self.effective_radii,
            body_radius=self.body_radius,
            disk_thickness=self.disk_thickness,
            max_curvature=self.curvature,
            cable_length=cable_length,
        )

    def _check_lengths(self) -> None:
        shortest, longest = self.range
        if isinstance(self.length, tuple):
            check_range("length", self.length)
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
class PccLimitsTable(LimitsTable):
    """`[limits.NAME]` of a robot of segments."""

    cable_length: Ranges  # one pair for all segments, or one for each
    backbone_speed: Annotated[Speed, Positive] | None = None


@dataclass(frozen=True, kw_only=True)
class PccTable(RobotTable):
    """A robot file with segments."""

    segment: Annotated[tuple[SegmentTable, ...], Field(min_length=1)]
    limits: Annotated[dict[str, PccLimitsTable], Field(min_length=1)]
    cable_convention: CableConvention = CableConvention.SEGMENT
    physics: RodPhysicsTable = field(default_factory=RodPhysicsTable)
    fitted: FittedTable | None = None

    def __post_init__(self) -> None:
        for name, limits in self.limits.items():
            if limits.backbone_speed is None and any(table.extensible for table in self.segment):
                place = ("limits", name, "backbone_speed")
                raise speed_missing(place, "a segment changes its length")
        self.check_insertion(self.limits)
        if self.fitted is not None:
            self._check_fitted(self.fitted)
        for name, limits in self.limits.items():
            check_ranges(
                ("limits", name, "cable_length"),
                limits.cable_length,
                self._cables_at_home(),
                part="segment",
                causes="the home length or the cable convention",
            )

    def _check_fitted(self, fitted: FittedTable) -> None:
        """Refuse a calibration that is none of this robot."""
        fixed = self.insertion is None and not any(table.extensible for table in self.segment)
        if not fixed or self.cable_convention is not CableConvention.MOTOR:
            raise FieldError(
                "fitted",
                expected="segments of fixed length on a fixed base, cables counted at the motors",
                remedy='Take [fitted] out, or write cable_convention = "motor".',
            )
        fitted.check(sum(len(table.cable_angles) for table in self.segment), len(self.segment))

    def _cables_at_home(self) -> list[float]:
        """Length [m] of every segment's cables, by the file's convention."""
        homes = np.array([table.home for table in self.segment])
        motor = self.cable_convention is CableConvention.MOTOR
        return (np.cumsum(homes) if motor else homes).tolist()

    def robot(self, limits: str) -> PccRobot:
        """Return the robot with these limits."""
        chosen = self.limits[limits]
        lengths = one_each(chosen.cable_length, len(self.segment))
        segments = tuple(t.part(each) for t, each in zip(self.segment, lengths, strict=True))
        return PccRobot(
            name=self.name,
            segments=segments,
            speed=SpeedLimits(
                cable=chosen.cable_speed,
                backbone=chosen.backbone_speed or 0.0,  # without an actuator nobody reads it
                insertion=chosen.insertion_speed or 0.0,
            ),
            convention=self.cable_convention,
            insertion=self.insertion and self.insertion.part,
            tool=self.tool and self.tool.part,
            spacing=self.guard_spacing,
            mechanics=self.physics.mechanics,
            fitted=self.fitted and self.fitted.part(segments),
        )
