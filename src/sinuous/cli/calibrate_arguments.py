"""What `sinuous calibrate` takes; the texts here are its manual."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, arg

File = Annotated[str, arg(metavar="FILE")]
MaybeFile = Annotated[str | None, arg(metavar="FILE")]
Name = Annotated[str | None, arg(metavar="COLUMN")]
Names = Annotated[str | None, arg(metavar="A,B,...")]
Unit = Annotated[str | None, arg(metavar="{m,cm,mm}")]


@dataclass(frozen=True, kw_only=True)
class Calibrate:
    """Fit a robot file to recorded motor positions and tip positions.

    Which motor is which cable and which way it pulls, then all at once: base and marker, cable
    angles and pitch, stiffness, pretension and slack, friction and play, each with an interval,
    and how far the tip is off in movements that were left out.

    Exit codes: 0 done, 2 bad input.
    """

    data: Positional[Annotated[str, arg(metavar="DATA")]]
    """recording (.csv) of time, motors, tip and, if there are several, names of movements"""
    robot: Annotated[str, arg(metavar="ROBOT")]
    """the nominal robot: a preset or a robot file"""
    pulls: MaybeFile = None
    """recording of every cable pulled alone while all others are let go; without it such movements
    in DATA identify the motors, or, if there are none, motors are taken in the order of the cables
    and pull all the same way"""
    validate: MaybeFile = None
    """recording to judge the result by; nothing of it is fitted"""
    out: MaybeFile = None
    """robot file to write; every other verb reads it"""
    json: MaybeFile = None
    """file for parameters with intervals, and all errors"""
    figures: Annotated[str | None, arg(metavar="DIR")] = None
    """folder for the figures; by default beside --out"""
    time: Name = None
    """column of the time in seconds"""
    motors: Names = None
    """columns of the motors' positions, negative values or not: their direction is found"""
    tip: Names = None
    """columns of the tip's x, y and z"""
    pattern: Name = None
    """column of the names of the movements"""
    cable_unit: Unit = None
    """unit of the motors' positions; by default what the columns' names end with, else mm"""
    tip_unit: Unit = None
    """unit of the tip's position"""
