"""What a controller hands back: a command and a report that certifies it."""

from dataclasses import dataclass
from enum import Enum

from sinuous.arrays import Array


class Status(Enum):
    """How a step ended, worded as advice."""

    TRACKING = "tracking: the tip is on its way"
    AT_TARGET = "at target: the tip is where it should be"
    BLOCKED = "blocked: no allowed motion brings the tip closer; see what is active"
    RECOVERING = "recovering: part of the body is beyond the margin and is coming back"
    HOLDING = "holding still: no safe command was found; see the reason"


@dataclass(frozen=True, kw_only=True)
class Active:
    """A constraint that the robot leans on.

    Arguments:
        name: what it is, in words
        multiplier: what relaxing it is worth, [cost / m] of wall or actuator
        triangle: of the zone, -1 if it is not a wall
    """

    name: str
    multiplier: float
    triangle: int = -1


@dataclass(frozen=True, kw_only=True)
class Report:
    """The certificate of one control step.

    Arguments:
        status: how the step ended
        reason: why, if the robot holds still; empty otherwise
        solve_time: wall-clock time of the whole step [s]
        iterations: QPs solved
        planes: wall planes in the last QP
        step_fraction: share of the planned first step that the safety filter accepted
        points: nominal body points after the step (S, 3) [m]
        clearance: least nominal body clearance after the step [m], negative beyond the wall
        active: constraints with a multiplier, the strongest first
    """

    status: Status
    reason: str = ""
    solve_time: float
    iterations: int
    planes: int
    step_fraction: float
    points: Array
    clearance: float
    active: tuple[Active, ...] = ()


@dataclass(frozen=True, kw_only=True)
class Command:
    """Actuator rates (P,) [m/s] to hold until the next step, and their report."""

    rates: Array
    report: Report
