"""What a controller hands back: a command and a report that certifies it."""

from dataclasses import dataclass, field
from enum import Enum
from functools import cached_property
from time import perf_counter

import numpy as np

from sinuous.arrays import Array
from sinuous.control.reading import Active, Leaning
from sinuous.control.wall_force import Walls
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot

NOTHING, NOWHERE = np.zeros(0), np.zeros(3)  # shared by all commands that say nothing else
for _constant in (NOTHING, NOWHERE):
    _constant.setflags(write=False)


class Status(Enum):
    """How a step ended, worded as advice."""

    TRACKING = "tracking: the tip is on its way"
    AT_TARGET = "at target: the tip is where it should be"
    BLOCKED = "blocked: no allowed motion brings the tip closer; see what is active"
    RECOVERING = "recovering: part of the body is beyond the margin and is coming back"
    HOLDING = "holding still: no safe command was found; see the reason"


@dataclass(frozen=True, kw_only=True)
class Workload:
    """How much a step had to do.

    Arguments:
        qps: solved
        iterations: of the QP solver, over all QPs
        planes: rows that stood in for the shape in the last QP
        tests: shares of the step that the safety filter looked at
        halvings: of the plan's change until it lowered the exact cost
        in_time: whether the budget was enough
    """

    qps: int = 0
    iterations: int = 0
    planes: int = 0
    tests: int = 0
    halvings: int = 0
    in_time: bool = True


@dataclass(frozen=True, kw_only=True, eq=False)
class Report:
    """The certificate of one control step.

    What takes time and is not needed to go on is computed when first asked for.

    Arguments:
        status: how the step ended
        reason: why, if the robot holds still; empty otherwise
        solve_time: wall-clock time of the whole step [s]
        workload: how much it had to do
        step_fraction: share of the planned first step that the safety filter accepted
        points: nominal body points after the step (S, 3) [m]
        walls: that the plan leans on; None of a controller that has no plan, or no longer one
    """

    status: Status
    reason: str = ""
    solve_time: float
    workload: Workload = Workload()
    step_fraction: float
    points: Array
    robot: Robot = field(repr=False)
    zone: SafeZone = field(repr=False)
    leaning: Leaning = field(default=Leaning(), repr=False)
    walls: Walls | None = field(default=None, repr=False)

    @property
    def iterations(self) -> int:
        """QPs solved."""
        return self.workload.qps

    @property
    def planes(self) -> int:
        """Wall planes in the last QP."""
        return self.workload.planes

    @cached_property
    def clearance(self) -> float:
        """Least nominal body clearance after the step [m], negative beyond the wall."""
        return float(np.min(self.zone.clearance(self.points) - self.robot.radii))

    @cached_property
    def active(self) -> tuple[Active, ...]:
        """Constraints with a multiplier, the strongest first."""
        return self.leaning.describe(self.robot, self.zone)


@dataclass(frozen=True, kw_only=True)
class Command:
    """Actuator rates to hold until the next step, and their report.

    Arguments:
        rates: (P,) [m/s]
        report: how they were found
        local: the part of the rates that a local controller adds (P,) [m/s]; empty without one
        clipped: share of the rates asked for that limits took away, 0 to 1
        offset: of the real tip from the nominal one, which the plan aims around (3,) [m]
        tensions: of the cables, as the controller knows them (C,) [N]; empty if it does not
    """

    rates: Array
    report: Report
    local: Array = field(default_factory=lambda: NOTHING)
    clipped: float = 0.0
    offset: Array = field(default_factory=lambda: NOWHERE)
    tensions: Array = field(default_factory=lambda: NOTHING)


def hold_still(robot: Robot, zone: SafeZone, c: Array, reason: str, began: float) -> Command:
    """A command to stay at configuration c (n,), with the reason in its report.

    Arguments:
        began: when the step did, by `time.perf_counter` [s]
    """
    report = Report(
        status=Status.HOLDING,
        reason=reason,
        solve_time=perf_counter() - began,
        step_fraction=0.0,
        points=robot.points(c),
        robot=robot,
        zone=zone,
    )
    return Command(rates=np.zeros(len(robot.actuator_names)), report=report)
