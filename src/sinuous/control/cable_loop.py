"""Geometric inverse kinematics and a PID for every cable: the controller of paper A, section 3.2.

    target -> (10)-(15) -> joint angles -> (7) -> L_d -> (26) -> actuator speeds

It knows no wall: what keeps the tip where it may be is the operator, who feels a virtual force.
"""

from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from math import isfinite
from time import perf_counter
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.geometric_ik import GeometricIK, IKStatus
from sinuous.control.geometric_rates import RateLimiter
from sinuous.control.pid import Pid, PidState
from sinuous.control.report import Command, Report, Status, hold_still
from sinuous.control.saturation import unbent
from sinuous.control.transmission import Transmission
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.robots.jointed import JointedRobot

ARRIVED = 1e-4  # [m]; the integral of the PID takes long to bring it closer


class CableLoopState(NamedTuple):
    """What the loop remembers between ticks.

    Arguments:
        robot: whose cables they are
        desired, lengths_desired: configuration (n,) and its lengths (P,) [m], what the PIDs go for
        lengths: by the encoders, or by the model where nothing is measured (P,) [m]
        pid: of the cables
    """

    robot: JointedRobot
    desired: Array
    lengths_desired: Array
    lengths: Array
    pid: PidState

    @property
    def c(self) -> Array:
        """Configuration (n,) of the encoders' lengths (8)."""
        return self.robot.configuration(self.lengths)


@dataclass(frozen=True, eq=False)
class CableLoop:
    """Follows a target in the plane PTY, tick by tick.

    A target that no pose reaches is answered with the nearest one that is. A joint that would be
    bent beyond its limit is bent up to it. Where cables would have to be faster than they can be,
    as where the first joint of the solution switches, all of them slow down together.

    Arguments:
        ik: with the robot
        zone: what the run is judged by; this controller does not look at it
        margin: likewise [m]
        pid: gains (26)
        transmission: limits the cables' speed; the robot's own limits hold too
        dt: of a tick [s]

    Raises:
        ValueError: if dt is not a positive time
    """

    ik: GeometricIK
    zone: SafeZone = field(default_factory=SafeZone.unbounded)
    _: KW_ONLY
    margin: float = 0.0
    pid: Pid = field(default_factory=Pid)
    transmission: Transmission = field(default_factory=Transmission)
    dt: float = 1e-3

    def __post_init__(self) -> None:
        if not (isfinite(self.dt) and self.dt > 0.0):
            raise ValueError(f"dt must be a positive time, not {self.dt}")

    @property
    def robot(self) -> JointedRobot:
        """The robot, its base where it stands."""
        return self.ik.robot

    @cached_property
    def _limiter(self) -> RateLimiter:
        return RateLimiter(robot=self.robot, dt=self.dt)

    @cached_property
    def _limits(self) -> tuple[Array, Array]:
        """Slowest and fastest speed of every actuator (P,) [m/s]."""
        stage = 0 if self.robot.insertion is None else 1
        slowest, fastest = (np.array(side) for side in self.robot.rate_limits.T)
        most = self.transmission.cable_speed
        slowest[stage:], fastest[stage:] = (
            np.maximum(slowest[stage:], -most),
            np.minimum(fastest[stage:], most),
        )
        return slowest, fastest

    def init(self, c: ArrayLike) -> CableLoopState:
        """The state to start from, at rest at configuration c (n,).

        Raises:
            ValueError: if c has not the robot's coordinates
        """
        start = np.array(c, dtype=float)
        if start.shape != self.robot.home.shape:
            raise ValueError(f"c must have {len(self.robot.home)} coordinates, not {start.shape}")
        lengths = self.robot.lengths(start)
        return CableLoopState(self.robot, start, lengths, lengths, self.pid.at_rest(len(lengths)))

    def step(
        self, state: CableLoopState, target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[CableLoopState, Command]:
        """One tick towards target (3,) [m]; never raises for bad numbers.

        What is not finite is a fault: the cables hold still and the report says why. Without a
        measurement the cables are taken to have moved as told.
        """
        began, goal = perf_counter(), np.array(target, dtype=float)
        lengths = state.lengths if measured is None else measured.lengths
        if not (goal.shape == (3,) and isfinite(goal[0] + goal[1] + goal[2])):
            return self._hold(state, "the target is not three finite numbers", began)
        if not isfinite(float(lengths @ lengths)):
            return self._hold(state, "the measurement is not finite", began)
        found = self.ik.solve_one(goal)
        wanted = found.c
        if found.status is IKStatus.JOINT_LIMIT:
            wanted = unbent(self.robot, wanted, state.desired)
        desired, lengths_desired, share = self._limiter.follow(
            state.desired, state.lengths_desired, wanted
        )
        error = lengths_desired - lengths
        pid, rates, clipped = self.pid.step(state.pid, error, *self._limits, self.dt)
        if measured is None:
            lengths = lengths + self.dt * rates
        after = CableLoopState(self.robot, desired, lengths_desired, lengths, pid)
        if measured is not None and measured.has_shape:
            points = measured.points
        else:
            points = self.robot.points(after.c)
        report = Report(
            status=self._status(found.status, goal, points[-1]),
            solve_time=perf_counter() - began,
            step_fraction=share,
            points=points,
            robot=self.robot,
            zone=self.zone,
        )
        return after, Command(rates=rates, report=report, clipped=max(clipped, 1.0 - share))

    def _status(self, found: IKStatus, goal: Array, tip: Array) -> Status:
        away = goal - tip
        if float(away @ away) < ARRIVED**2:
            return Status.AT_TARGET
        return Status.TRACKING if found is IKStatus.REACHED else Status.BLOCKED

    def _hold(
        self, state: CableLoopState, reason: str, began: float
    ) -> tuple[CableLoopState, Command]:
        return state, hold_still(self.robot, self.zone, state.c, reason, began)
