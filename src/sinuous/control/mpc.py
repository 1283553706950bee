"""Shape-constrained model predictive control (paper B, section II-C, eq. 10-20).

Each step linearises the problem around the last prediction, solves a QP, checks the solution
on the exact mesh, adds the planes it violates and solves again; a safety filter then decides
how much of the first step is taken.  The nominal state moves to x*[1|k-1]; the printed
x*[0|k-1] of (17) would never move (notes B4).  Costs and constraints act on x[1..N]: as
printed, (12) leaves x[N] free of cost (notes B3).  All of it is one compiled call without the
GIL, see `sinuous.control.step`.
"""

from dataclasses import KW_ONLY, dataclass, field, fields
from functools import cached_property
from math import isfinite
from time import perf_counter
from typing import Any

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.model import Settings, make_model
from sinuous.control.qp import DenseProblem
from sinuous.control.reading import Leaning
from sinuous.control.report import Command, Report, Status, Workload, hold_still
from sinuous.control.step import interior, plan
from sinuous.control.step.data import CONTACTS, Contacts, Model
from sinuous.control.step.memory import Memory
from sinuous.control.step.plan import Solved
from sinuous.control.step.step import Outcome, decide, filtered, first_problem
from sinuous.control.terms import (
    Costs,
    QuadraticCost,
    further_costs,
    total_quadratics,
    total_weights,
)
from sinuous.control.wall_force import Walls
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.robots.robot import Robot

__all__ = ["Costs", "MPCState", "ShapeConstrainedMPC"]

# The plan keeps this much more than the margin, so that the filter need not cut it [m].
RESERVE = 5e-5

# Points this close to where they must stop get a plane from the start [m]; all others get one
# when a solution violates it.
NEAR = 2e-4

# Rounds of solving and adding violated planes.
ROUNDS = 6

# What later stages may violate before a round is spent on them [m]: they are planned anew.
LATE = 2e-4

# Largest change of an actuator from its predicted length that the linearisation is trusted
# with [m] (notes B17), at least one step at full speed; short plans do better without.
TRUST, TRUST_FROM = 5e-4, 5

# A tip this close to its target is there [m]; a slower one has nowhere to go [m/s].
NUDGE = 1e-3  # bend by which a plan leaves a balance [rad]
ARRIVED = 1e-5
STILL = 3e-5

FAILURES = {
    interior.UNFINISHED: "the QP solver reached its iteration limit",
    interior.NOT_FINITE: "the QP is not finite",
}


@dataclass(frozen=True, kw_only=True, eq=False)
class MPCState:
    """What the controller remembers between steps.

    Arguments:
        c: nominal configuration (n,)
        plan: predicted configurations (N, n)
        contacts: walls that each stage of the last plan leaned on
        points, clearance: of the body at c, the latter exact or a lower bound (S, 3), (S,) [m];
            empty if nothing is known
    """

    c: Array
    plan: Array
    contacts: Contacts
    points: Array = field(default_factory=lambda: np.zeros((0, 3)))
    clearance: Array = field(default_factory=lambda: np.zeros(0))


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
        budget: processor time that a step may take [s], None for no limit. When it is spent the
            step goes as far as what is there is safe, or holds still; such steps depend on the
            machine and do not repeat bit for bit
        rate_share: of the actuators' speed limits that the plan may use (notes B13); the rest
            is left to a local controller

    Raises:
        ValueError: if margin, dt, horizon, tip_speed, budget or rate_share make
            no sense
    """

    robot: Robot
    zone: SafeZone
    _: KW_ONLY
    margin: float = 0.0
    dt: float = 1 / 30
    horizon: int = 10
    costs: Costs = field(default_factory=Costs)
    tip_speed: float | None = None
    budget: float | None = None
    rate_share: float = 1.0

    def __post_init__(self) -> None:
        if not (np.isfinite(self.margin) and self.margin >= 0.0):
            raise ValueError(f"margin must be a length of zero or more, not {self.margin}")
        if not (np.isfinite(self.dt) and self.dt > 0.0):
            raise ValueError(f"dt must be a positive time, not {self.dt}")
        if self.horizon < 1:
            raise ValueError(f"horizon must be at least 1, not {self.horizon}")
        if self.tip_speed is not None and not self.tip_speed > 0.0:
            raise ValueError(f"tip_speed must be positive, not {self.tip_speed}")
        if self.budget is not None and not self.budget > 0.0:
            raise ValueError(f"budget must be a positive time, not {self.budget}")
        if not 0.0 < self.rate_share <= 1.0:
            raise ValueError(f"rate_share must be above 0 and at most 1, not {self.rate_share}")

    def __getstate__(self) -> dict[str, Any]:
        """What a copy in another process needs: not the compiled step's memory."""
        return {one.name: getattr(self, one.name) for one in fields(self)}

    @cached_property
    def model(self) -> Model:
        """All that stays the same from step to step, as arrays."""
        fastest = float(np.max(self.robot.rate_limits)) * self.rate_share * self.dt
        settings = Settings(
            margin=self.margin,
            dt=self.dt,
            rate_share=self.rate_share,
            tip_speed=np.inf if self.tip_speed is None else self.tip_speed,
            trust=max(TRUST, fastest) if self.horizon >= TRUST_FROM else np.inf,
            reserve=RESERVE,
            near=NEAR,
            rounds=ROUNDS,
            late=LATE,
        )
        return make_model(robot=self.robot, zone=self.zone, costs=self.costs, settings=settings)

    @cached_property
    def _further_costs(self) -> tuple[QuadraticCost, ...]:
        return further_costs(self.costs.state)

    @cached_property
    def _tip_weight(self) -> float:
        return total_weights(self.costs.state, self.robot).tip

    @cached_property
    def memory(self) -> Memory:
        """Scratch of the steps, for each thread its own."""
        return Memory(self.model, self.horizon)

    def slack(self, c: ArrayLike) -> Array:
        """Clearance of the guarded points beyond what the margin requires (S,) [m].

        Infinite for points that no motion can change, such as a fixed base.
        """
        room = self.zone.clearance(self.robot.points(c)) - self.robot.required_distance(self.margin)
        return np.where(self.robot.movable, room, np.inf)

    def init(self, c: ArrayLike) -> MPCState:
        """The state to start from, at rest at configuration c (n,).

        Raises:
            ValueError: if c has not the robot's coordinates
        """
        start, N = np.array(c, dtype=float), self.horizon
        if start.shape != self.robot.home.shape:
            raise ValueError(f"c must have {len(self.robot.home)} coordinates, not {start.shape}")
        _ = self.memory  # so that the first step takes no longer than others
        return MPCState(
            c=start,
            plan=np.tile(start, (N, 1)),
            contacts=Contacts(
                number=np.zeros(N, dtype=np.int64),
                point=np.zeros((N, CONTACTS), dtype=np.int64),
                slot=np.zeros((N, CONTACTS), dtype=np.int64),
                push=np.zeros((N, CONTACTS, 3)),
            ),
        )

    def step(
        self, state: MPCState, target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[MPCState, Command]:
        """One control step towards target (3,) [m]; never raises for a failed solve.

        Where no safe command is found the robot holds still and the report says why. What is
        measured does not matter: the prediction starts from the controller's own nominal state
        (17). `HierarchicalController` closes the loop.
        """
        began = perf_counter()
        goal = np.array(target, dtype=float)
        if goal.shape != (3,) or not all(map(isfinite, goal.tolist())):
            return self._hold(state, "the target is not three finite numbers", began)
        H, f = total_quadratics(self._further_costs, self.robot, state.plan, goal)
        budget = np.inf if self.budget is None else self.budget
        work = self.memory.work
        prepared = plan.prepare(
            self.model, work, state.c, state.points, state.clearance, state.plan, state.contacts,
            goal, H, f, budget,
        )  # fmt: skip
        solved = plan.solve(self.model, work, prepared)
        if solved.qps == 0 and solved.status in FAILURES:
            return self._hold(state, FAILURES[solved.status], began)
        outcome = decide(self.model, work, prepared, solved, goal, H, f)
        return self._take(solved, outcome, goal, began)

    def accept(self, c: ArrayLike, goal: ArrayLike) -> tuple[Array, float]:
        """How much of one step straight from c (n,) to a goal (n,) the safety filter takes.

        Returns the configuration (n,) it allows, and the share of the way that it is.
        """
        start, end = np.array(c, dtype=float), np.array(goal, dtype=float)
        return filtered(self.model, self.memory.work, start, end)

    def problem(self, state: MPCState, target: ArrayLike) -> DenseProblem:
        """The first QP that a step from this state would solve, to look at or to solve elsewhere.

        Arguments:
            target: (3,) [m]
        """
        goal = np.array(target, dtype=float)
        H, f = total_quadratics(self._further_costs, self.robot, state.plan, goal)
        work = self.memory.work
        prepared = plan.prepare(
            self.model, work, state.c, state.points, state.clearance, state.plan, state.contacts,
            goal, H, f, np.inf,
        )  # fmt: skip
        return DenseProblem.of(first_problem(work, prepared.rows))

    @cached_property
    def _nudge(self) -> Array:
        """A small bend (n,) to this side and that, from segment to segment."""
        nudge = np.zeros(len(self.robot.home))
        for k, column in enumerate(np.unique(self.robot.bend_limits.column)):
            nudge[column : column + 2] = (-1.0) ** k * np.array([0.8, 0.6]) * NUDGE
        return nudge

    def _take(
        self, solved: Solved, outcome: Outcome, goal: Array, began: float
    ) -> tuple[MPCState, Command]:
        status = self._status(outcome)
        # Nothing is in the way and yet the tip does not move: a straight robot whose target is
        # behind its tip sees no slope. Seen from a plan that is bent a little, there is one.
        balanced = status is Status.BLOCKED and not len(outcome.what)
        after = MPCState(
            c=outcome.c,
            plan=outcome.plan + self._nudge if balanced else outcome.plan,
            contacts=outcome.contacts,
            points=outcome.points,
            clearance=outcome.clearance,
        )
        report = Report(
            status=status,
            solve_time=perf_counter() - began,
            workload=Workload(
                qps=solved.qps,
                iterations=solved.iterations,
                planes=solved.planes,
                tests=outcome.tests,
                halvings=outcome.halvings,
                in_time=outcome.in_time,
            ),
            step_fraction=outcome.share,
            points=outcome.points,
            robot=self.robot,
            zone=self.zone,
            leaning=Leaning(
                what=outcome.what,
                index=outcome.which,
                triangle=outcome.triangle,
                strength=outcome.strength,
            ),
            walls=self._walls(outcome, goal),
        )
        return after, Command(rates=outcome.change / self.dt, report=report)

    def _walls(self, outcome: Outcome, goal: Array) -> Walls | None:
        """What the stage that comes next leans on; nothing without a cost of the tip's error."""
        weight = self._tip_weight
        if weight <= 0.0:
            return None
        contacts, last = outcome.contacts, int(outcome.contacts.number[0])
        return Walls(
            robot=self.robot,
            c=outcome.plan[0],
            point=contacts.point[0, :last],
            push=contacts.push[0, :last] / (2.0 * weight),
            goal=goal,
        )

    def hold(self, state: MPCState, reason: str) -> tuple[MPCState, Command]:
        """A step that stays where the robot is, forgets the plan and says why."""
        return self._hold(state, reason, perf_counter())

    def _hold(self, state: MPCState, reason: str, began: float) -> tuple[MPCState, Command]:
        return self.init(state.c), hold_still(self.robot, self.zone, state.c, reason, began)

    def _status(self, outcome: Outcome) -> Status:
        if outcome.slack < 0.0:
            return Status.RECOVERING
        if outcome.tip_error < ARRIVED:
            return Status.AT_TARGET
        # Whoever had no time to find a way cannot say that there is none.
        if outcome.in_time and outcome.tip_moved < STILL * self.dt:
            return Status.BLOCKED
        return Status.TRACKING
