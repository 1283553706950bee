"""What the files of all robots have in common: name, stage, tool, speeds, ranges of lengths."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

from sinuous.files import FieldError, Length, Place, Speed
from sinuous.robots.parts import Insertion, Tool

Positive = Field(gt=0.0)
Range = tuple[Length, Length]
Ranges = Range | tuple[Range, ...]
"""One pair for all, or one for each."""


@dataclass(frozen=True, kw_only=True)
class InsertionTable:
    """`[insertion]`: a stage that pushes the base forward; home is its start by default."""

    travel: Range
    radius: Annotated[Length, Positive]
    home: Length | None = None

    def __post_init__(self) -> None:
        check_range("travel", self.travel)
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

    @property
    def part(self) -> Insertion:
        """What the robot is built from."""
        return Insertion(travel=self.travel, home=self.start, radius=self.radius)


@dataclass(frozen=True, kw_only=True)
class ToolTable:
    """`[tool]`: what the last disk or plate carries; its end is the tip."""

    offset: tuple[Length, Length, Length]
    radius: Annotated[Length, Positive]

    @property
    def part(self) -> Tool:
        """What the robot is built from."""
        return Tool(offset=self.offset, radius=self.radius)


@dataclass(frozen=True, kw_only=True)
class LimitsTable:
    """`[limits.NAME]`: what the actuators may do in the simulation, or on the hardware."""

    cable_speed: Annotated[Speed, Positive]
    insertion_speed: Annotated[Speed, Positive] | None = None


@dataclass(frozen=True, kw_only=True)
class RobotTable:
    """A robot file, but for what the body is made of and the limits."""

    name: Annotated[str, Field(min_length=1)]
    about: str = ""
    guard_spacing: Annotated[Length, Positive] = 0.003
    insertion: InsertionTable | None = None
    tool: ToolTable | None = None

    def check_insertion(self, limits: Mapping[str, LimitsTable]) -> None:
        """Refuse an insertion stage without a speed."""
        for name, table in limits.items():
            if table.insertion_speed is None and self.insertion is not None:
                place = ("limits", name, "insertion_speed")
                raise speed_missing(place, "there is an insertion stage")


def one_each(ranges: Ranges, count: int) -> list[tuple[float, float]]:
    """Return the pairs of a list of them, or one pair as often as it is needed."""
    pairs = [pair for pair in ranges if isinstance(pair, tuple)]
    if pairs:
        return pairs
    low, high = (value for value in ranges if not isinstance(value, tuple))
    return [(low, high)] * count


def check_range(field: str, limits: tuple[float, float]) -> None:
    """Refuse a pair that is not in ascending order."""
    if not limits[0] < limits[1]:
        raise FieldError(
            field,
            expected="a smaller and then a larger value",
            remedy="Put the smaller first; for a fixed length give a single number.",
        )


def check_ranges(
    place: Place, ranges: Ranges, homes: list[float], *, part: str, causes: str
) -> None:
    """Refuse cable lengths that are not one pair, or one for each part, around its home length.

    Arguments:
        place: of the field
        ranges: what stands there [m]
        homes: length of each part's cables at home [m]
        part: what has cables, in words
        causes: what the lengths at home follow from, in words
    """
    if len(one_each(ranges, len(homes))) != len(homes):
        raise FieldError(
            place,
            expected=f"one pair, or {len(homes)}, one for each {part}",
            remedy=f"Give as many pairs as {part}s.",
        )
    for number, home in enumerate(homes, start=1):
        low, high = one_each(ranges, len(homes))[number - 1]
        if not low < home < high:
            raise FieldError(
                place,
                expected=f"a shortest length below and a longest above {home * 1e3:g} mm, "
                f"the length of {part} {number}'s cables at home",
                remedy=f"Otherwise they cannot move both ways: correct the limits, {causes}.",
            )


def speed_missing(place: Place, reason: str) -> FieldError:
    """Return the error for a speed that an actuator needs."""
    return FieldError(
        place,
        expected=f"a speed, because {reason}",
        remedy=f"Add {place[-1]}_mm_s to [{'.'.join(map(str, place[:-1]))}].",
    )
