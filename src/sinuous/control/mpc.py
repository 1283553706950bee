"""Shape-constrained model predictive control (paper B, section II-C, eq. 10-20).

Each step linearises the problem around the last prediction, solves a QP, checks the solution
on the exact mesh, adds the planes it violates and solves again; a safety filter then decides
how much of the first step is taken.  The nominal state moves to x*[1|k-1]; the printed
x*[0|k-1] of (17) would never move (notes B4).  Costs and constraints act on x[1..N]: as
printed, (12) leaves x[N] free of cost (notes B3).
"""

from dataclasses import KW_ONLY, dataclass, field
from functools import cached_property
from time import perf_counter

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control import qp
from sinuous.control.plan import Plan, make_plan
from sinuous.control.problem import Terms
from sinuous.control.report import Command, Report, Status
from sinuous.control.safety import SafetyFilter, floor
from sinuous.control.shape import BendLimit, Contacts
from sinuous.control.stage import Stage, actuator_metric
from sinuous.control.terms import (
    ActuatorLengths,
    ActuatorRates,
    Cost,
    Effort,
    Posture,
    PrintedLengths,
    TipError,
    TipSpeed,
)
from sinuous.control.walls import Walls
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot

# The plan keeps this much more than the margin, so that the filter need not cut it [m].
RESERVE = 5e-5

# Largest change of an actuator from its predicted length that the linearisation is trusted
# with [m] (notes B17), at least one step at full speed.
TRUST = 5e-4

# A tip this close to its target is there [m]; a slower one has nowhere to go [m/s].
ARRIVED = 1e-5
STILL = 3e-5


@dataclass(frozen=True, kw_only=True)
class Costs:
    """What the controller minimises over the horizon.

    Arguments:
        state: costs of each predicted configuration
        effort: cost of the increments
    """

    state: tuple[Cost, ...] = (TipError(weight=1e5), Posture(weight=5.0))
    effort: Effort = field(default_factory=lambda: Effort(weight=0.1))

    @classmethod
    def printed(cls) -> "Costs":
        """The cost (10) with the weights of paper B III-B; it has a steady error (notes B5)."""
        return cls(
            state=(TipError(weight=1000.0), PrintedLengths(weight=10.0)),
            effort=Effort(weight=10.0),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class MPCState:
    """What the controller remembers between steps.

    Arguments:
        c: nominal configuration (n,)
        plan: predicted configurations (N, n)
        contacts: walls that each stage of the last plan leaned on
    """

    c: Array
    plan: Array
    contacts: tuple[Contacts, ...]


@dataclass(frozen=True, eq=False)
class ShapeConstrainedMPC:
    """Steers the tip to a target while the whole body keeps a margin to the walls.

    Arguments:
        robot: any `Robot`
        zone: the room it may use; targets and points are in its frame
        margin: least distance between body surface and wall, c_d of (18) [m]
        dt: time between steps [s]
        horizon: N, steps looked ahead
        costs: what is minimised
        tip_speed: largest speed of the tip [m/s], None for no limit

    Raises:
        ValueError: if margin, dt, horizon or tip_speed make no sense
    """

    robot: Robot
    zone: SafeZone
    _: KW_ONLY
    margin: float = 0.0
    dt: float = 1 / 30
    horizon: int = 5
    costs: Costs = field(default_factory=Costs)
    tip_speed: float | None = None

    def __post_init__(self) -> None:
        if not (np.isfinite(self.margin) and self.margin >= 0.0):
            raise ValueError(f"margin must be a length of zero or more, not {self.margin}")
        if not (np.isfinite(self.dt) and self.dt > 0.0):
            raise ValueError(f"dt must be a positive time, not {self.dt}")
        if self.horizon < 1:
            raise ValueError(f"horizon must be at least 1, not {self.horizon}")
        if self.tip_speed is not None and not self.tip_speed > 0.0:
            raise ValueError(f"tip_speed must be positive, not {self.tip_speed}")

    @cached_property
    def walls(self) -> Walls:
        """The constraint that keeps the body off the walls."""
        required = self.robot.required_distance(self.margin)
        return Walls(required=required, movable=self.robot.movable, reserve=RESERVE)

    @cached_property
    def terms(self) -> Terms:
        """All costs and constraints."""
        tip = () if self.tip_speed is None else (TipSpeed(limit=self.tip_speed),)
        fastest = float(np.max(self.robot.rate_limits)) * self.dt
        return Terms(
            costs=self.costs.state,
            effort=self.costs.effort,
            state_limit=ActuatorLengths(trust=max(TRUST, fastest)),
            increment_limits=(ActuatorRates(), *tip),
            shape=(self.walls, BendLimit()),
        )

    @cached_property
    def _scale(self) -> qp.Scale:
        return qp.Scale(
            step=float(np.max(self.robot.rate_limits)) * self.dt,
            inverse=np.asarray(np.linalg.inv(actuator_metric(self.robot)), dtype=np.float64),
        )

    def stage(self, c: Array) -> Stage:
        """Kinematics and clearance at a configuration (n,)."""
        return Stage(robot=self.robot, zone=self.zone, c=c)

    def init(self, c: ArrayLike) -> MPCState:
        """The state to start from, at rest at configuration c (n,)."""
        start = np.array(c, dtype=float)
        return MPCState(
            c=start,
            plan=np.tile(start, (self.horizon, 1)),
            contacts=(Contacts.none(),) * self.horizon,
        )

    def step(self, state: MPCState, target: ArrayLike) -> tuple[MPCState, Command]:
        """One control step towards target (3,) [m]; never raises for a failed solve.

        Where no safe command is found the robot holds still and the report says why.
        """
        began = perf_counter()
        goal, start = np.array(target, dtype=float), self.stage(state.c)
        if goal.shape != (3,) or not np.all(np.isfinite(goal)):
            return self._hold(state, start, "the target is not three finite numbers", began)
        try:
            predicted = [self.stage(c) for c in state.plan]
            plan = make_plan(
                self.terms, self._scale, start, predicted, state.contacts, goal, self.dt
            )
        except np.linalg.LinAlgError as error:
            return self._hold(state, start, f"linear algebra failed: {error}", began)
        if plan.failure:
            return self._hold(state, start, plan.failure, began)
        return self._take(state, start, plan, goal, began)

    def _take(
        self, state: MPCState, start: Stage, plan: Plan, target: Array, began: float
    ) -> tuple[MPCState, Command]:
        """Take as much of the plan's first step as is safe."""
        terms = self.terms
        safety = SafetyFilter(shape=terms.shape, limits=terms.increment_limits, dt=self.dt)
        end, share = safety.accept(start, plan.found[0])
        # The whole plan shrinks with the step, so that it stays reachable (notes B17).
        c = start.c + share * (np.array([stage.c for stage in plan.found]) - start.c)
        contacts = (*plan.contacts[1:], plan.contacts[-1])
        after = MPCState(c=end.c, plan=np.concatenate([c[1:], c[-1:]]), contacts=contacts)
        report = Report(
            status=self._status(start, end, target),
            solve_time=perf_counter() - began,
            iterations=plan.iterations,
            planes=plan.planes,
            step_fraction=share,
            points=end.points,
            clearance=self._clearance(end),
            active=plan.active,
        )
        return after, Command(rates=(end.lengths - start.lengths) / self.dt, report=report)

    def _hold(
        self, state: MPCState, start: Stage, reason: str, began: float
    ) -> tuple[MPCState, Command]:
        """Stay where the robot is, forget the plan and say why."""
        report = Report(
            status=Status.HOLDING,
            reason=reason,
            solve_time=perf_counter() - began,
            iterations=0,
            planes=0,
            step_fraction=0.0,
            points=start.points,
            clearance=self._clearance(start),
        )
        rates = np.zeros(len(self.robot.actuator_names))
        return self.init(state.c), Command(rates=rates, report=report)

    def _clearance(self, stage: Stage) -> float:
        return float(np.min(stage.walls.clearance - self.robot.radii))

    def _status(self, start: Stage, end: Stage, target: Array) -> Status:
        if any(floor(constraint.slack(end)) < 0.0 for constraint in self.terms.shape):
            return Status.RECOVERING
        if np.linalg.norm(end.tip - target) < ARRIVED:
            return Status.AT_TARGET
        if np.linalg.norm(end.tip - start.tip) < STILL * self.dt:
            return Status.BLOCKED
        return Status.TRACKING
