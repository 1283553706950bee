"""Costs and limits of the problem that is solved, against their own values in plain numpy."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.control.metric import actuator_metric
from sinuous.control.mpc import Costs, MPCState, ShapeConstrainedMPC
from sinuous.control.qp import DenseProblem
from sinuous.control.report import Command, Status
from sinuous.control.step.data import RATE_LIMIT, STATE_LIMIT, TIP_SPEED
from sinuous.control.terms import (
    Effort,
    Posture,
    PrintedLengths,
    Quadratic,
    QuadraticCost,
    TipError,
    WeightedCost,
)
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot

ROBOTS = {name: load_robot(name) for name in ("hachen2025", "opencr_v4")}
FREE = SafeZone.unbounded()
DT = 1 / 30  # [s]

GRADIENT = 1e-6  # relative error against central differences with steps of 1e-4: 1e-8 and less
STEP = 1e-4  # [rad or m]
HESSIAN = 1e-5  # relative error against central differences of gradients with steps of 1e-4
FLOOR = 1e-9  # share of the largest curvature that no direction of a stage falls below
NEAR_BEND, STRAIGHT = 1e-4, 1e-3  # as the controller has them [m], [rad]
DAMPING = 1e-5  # of the tip's null space [m^2 of tip per m^2 of actuator]
ROUNDING = 1e-12  # relative
# Force of the posture cost on the tip, relative to the cost's own gradient: the damping over
# the tip's squared gain, 1e-5 / 1, and some for weak directions.
FORCE = 1e-3
SPEED = 1e-6  # relative excess of a speed limit that is rounding
SHARE = 1e-8  # relative: the filter stays 1e-9 short of what limits allow
LENGTH = 1e-12  # rounding of a length [m]
THERE = 1e-5  # distance to a target that counts as none [m]
WORTH = 1e-2  # relative error of a multiplier at rest, where the tip still creeps

seeds = st.integers(0, 2**32 - 1)
names = st.sampled_from(sorted(ROBOTS))


def random_step(robot: PccRobot, rng: np.random.Generator, size: float) -> Array:
    """A change of all bends by about `size` rad, of the lengths by as many hundredths of a m."""
    unit = np.array([0.01 if name.endswith("length") else 1.0 for name in robot.coordinate_names])
    return size * unit * rng.normal(size=len(unit))


def random_state(mpc: ShapeConstrainedMPC, rng: np.random.Generator, size: float) -> MPCState:
    """Somewhere around home, with a plan that goes somewhere else."""
    robot = mpc.robot
    assert isinstance(robot, PccRobot)
    state = mpc.init(robot.home + random_step(robot, rng, size))
    steps = [random_step(robot, rng, 0.1 * size) for _ in range(mpc.horizon)]
    return replace(state, plan=state.c + np.cumsum(steps, axis=0))


def controller(
    robot: Robot,
    *costs: WeightedCost | QuadraticCost,
    horizon: int = 1,
    effort: float = 0.1,
    tip_speed: float | None = None,
) -> ShapeConstrainedMPC:
    """In free space, with costs of the predicted configurations."""
    return ShapeConstrainedMPC(
        robot, FREE, dt=DT, horizon=horizon, tip_speed=tip_speed,
        costs=Costs(state=costs, effort=Effort(weight=effort)),
    )  # fmt: skip


def by_y(mpc: ShapeConstrainedMPC) -> Array:
    """T (n, n) of delta = T y."""
    step = float(np.max(mpc.robot.rate_limits)) * mpc.dt
    return step * np.linalg.inv(actuator_metric(mpc.robot))


# --- costs -------------------------------------------------------------------------------

Value = Callable[[Array], float]


def tip_error(robot: PccRobot, around: Array, target: Array) -> Value:
    return lambda c: 1e5 * float(np.sum((robot.tip(c) - target) ** 2))


def printed_lengths(robot: PccRobot, around: Array, target: Array) -> Value:
    return lambda c: 10.0 * float(np.sum(robot.lengths(c) ** 2))


def posture(robot: PccRobot, around: Array, target: Array) -> Value:
    """With the projector frozen at `around`."""
    M = actuator_metric(robot)
    J = robot.points_jacobian(around)[-1] @ np.linalg.inv(M)
    P = np.eye(len(M)) - J.T @ np.linalg.solve(J @ J.T + DAMPING * np.eye(3), J)
    return lambda c: 5.0 * float(np.sum((P @ M @ (c - robot.home)) ** 2))


@dataclass(frozen=True, kw_only=True)
class PointError:
    """weight |p - goal|^2 of any body point p: a cost that the package does not know."""

    index: int
    goal: Array
    weight: float

    def quadratic(self, robot: Robot, c: Array, target: Array) -> Quadratic:
        J, error = robot.points_jacobian(c)[self.index], robot.points(c)[self.index] - self.goal
        return Quadratic(
            hessian=2.0 * self.weight * J.T @ J, gradient=2.0 * self.weight * J.T @ error
        )


MIDDLE = PointError(index=20, goal=np.array([0.01, -0.02, 0.05]), weight=2e4)


def point_error(robot: PccRobot, around: Array, target: Array) -> Value:
    return lambda c: (
        MIDDLE.weight * float(np.sum((robot.points(c)[MIDDLE.index] - MIDDLE.goal) ** 2))
    )


Kind = tuple[WeightedCost | QuadraticCost, Callable[[PccRobot, Array, Array], Value]]
TIP: Kind = (TipError(weight=1e5), tip_error)
PRINTED: Kind = (PrintedLengths(weight=10.0), printed_lengths)
POSTURE: Kind = (Posture(weight=5.0), posture)
POINT: Kind = (MIDDLE, point_error)
SUMS = {
    "tip": (TIP,),
    "printed": (PRINTED,),
    "posture": (POSTURE,),
    "ours": (TIP, POSTURE),
    "as printed": (TIP, PRINTED),
    "one's own": (TIP, POSTURE, POINT),
}


def slopes(value: Value, c: Array) -> Array:
    """Gradient (n,) by central differences."""
    steps = STEP * np.eye(len(c))
    return np.array([(value(c + h) - value(c - h)) / (2 * STEP) for h in steps])


def exact_gradient(
    mpc: ShapeConstrainedMPC, kinds: tuple[Kind, ...], state: MPCState, target: Array
) -> Array:
    """Gradient (N n,) by y of the costs of all stages and of the increments between them."""
    robot, N = mpc.robot, mpc.horizon
    assert isinstance(robot, PccRobot)
    values = [[value(robot, c, target) for _, value in kinds] for c in state.plan]

    def total(flat: Array) -> float:
        plan = flat.reshape(N, -1)
        lengths = robot.lengths(np.vstack([state.c, plan]))
        effort = 0.1 * float(np.sum((30.0 * np.diff(lengths, axis=0)) ** 2))
        return effort + sum(
            value(c) for stage, c in zip(values, plan, strict=True) for value in stage
        )

    return (slopes(total, state.plan.ravel()).reshape(N, -1) @ by_y(mpc)).ravel()


def size_of(problem: DenseProblem, gradient: Array) -> float:
    """The problem is divided by a cost that counts as one; which, the gradient tells."""
    size = float(gradient @ gradient) / float(gradient @ problem.f)
    assert size > 0.0
    return size


@given(name=names, seed=seeds, horizon=st.integers(1, 3))
@settings(max_examples=12)
@pytest.mark.parametrize("kind", sorted(SUMS))
def test_gradient_is_that_of_the_cost(kind: str, name: str, seed: int, horizon: int) -> None:
    rng, kinds = np.random.default_rng(seed), SUMS[kind]
    mpc = controller(ROBOTS[name], *(cost for cost, _ in kinds), horizon=horizon)
    state, target = random_state(mpc, rng, 0.5), rng.normal(0.0, 0.1, 3)
    problem = mpc.problem(state, target)
    exact = exact_gradient(mpc, kinds, state, target)
    error = np.abs(problem.f * size_of(problem, exact) - exact)
    assert np.max(error) < GRADIENT * np.max(np.abs(exact))


@given(name=names, seed=seeds)
@settings(max_examples=20)
@pytest.mark.parametrize("kind", sorted(SUMS))
def test_hessian_is_the_nearest_convex_one_of_the_cost(kind: str, name: str, seed: int) -> None:
    """Of the exact cost, with the curvature of the tip's kinematics, also under the force that
    holds the posture, and of bend limits that it pushes against; a user's is as it is given."""
    rng, kinds, robot = np.random.default_rng(seed), SUMS[kind], ROBOTS[name]
    mpc = controller(robot, *(cost for cost, _ in kinds), horizon=2)
    state, target = random_state(mpc, rng, 0.5), rng.normal(0.0, 0.1, 3)
    problem, T, n = mpc.problem(state, target), by_y(mpc), len(robot.home)
    A = robot.lengths_jacobian(robot.home) @ T
    effort = 2.0 * 0.1 * 900.0 * A.T @ A
    expected = np.kron(np.array([[2.0, -1.0], [-1.0, 1.0]]), effort)
    for i, c in enumerate(state.plan):
        H = np.zeros((n, n))
        if TIP in kinds:
            H += curvature(lambda c: tip_gradient(robot, c, target), c)
        for kind_of in (PRINTED, POSTURE):
            if kind_of in kinds:  # quadratic: any step will do
                value = kind_of[1](robot, c, target)
                H += curvature(lambda c, value=value: slopes(value, c), c)
        if POSTURE in kinds:
            mu = holding_force(robot, c)
            H -= curvature(lambda c, mu=mu: robot.points_jacobian(c)[-1].T @ mu, c)
        f = np.zeros(n)
        for kind_of in kinds:
            if kind_of is not POINT:
                f += slopes(kind_of[1](robot, c, target), c)
        H = convex(T.T @ (H + curvature_of_limits(robot, c, f, T)) @ T)
        if POINT in kinds:
            H += T.T @ MIDDLE.quadratic(robot, c, target).hessian @ T
        expected[i * n : (i + 1) * n, i * n : (i + 1) * n] += H
    modelled = problem.H * size_of(problem, exact_gradient(mpc, kinds, state, target))
    assert np.max(np.abs(modelled - expected)) < HESSIAN * np.max(np.abs(expected))


def holding_force(robot: PccRobot, c: Array) -> Array:
    """At the tip (3,): what balances the posture's gradient along the tip's motions."""
    M = actuator_metric(robot)
    J = robot.points_jacobian(c)[-1] @ np.linalg.inv(M)
    return np.linalg.solve(J @ J.T + DAMPING * np.eye(3), J @ (10.0 * M @ (c - robot.home)))


def curvature_of_limits(robot: PccRobot, c: Array, f: Array, T: Array) -> Array:
    """By c (n, n): -push d2(slack), each limit's push as if it were the only one."""
    H = np.zeros((len(c), len(c)))
    for j, slack in enumerate(robot.bend_slack(c)):
        theta = robot.bend_limits.column[j]
        if slack <= NEAR_BEND and np.hypot(c[theta], c[theta + 1]) > STRAIGHT:
            normal = T.T @ robot.bend_slack_jacobian(c)[j]
            push = max(float(normal @ T.T @ f) / float(normal @ normal), 0.0)
            H -= push * curvature(lambda c, j=j: robot.bend_slack_jacobian(c)[j], c)
    return H


def tip_gradient(robot: PccRobot, c: Array, target: Array) -> Array:
    return 2e5 * robot.points_jacobian(c)[-1].T @ (robot.tip(c) - target)


def curvature(gradient: Callable[[Array], Array], c: Array) -> Array:
    """Derivative (n, n) of a gradient by central differences."""
    steps = STEP * np.eye(len(c))
    H = np.array([(gradient(c + h) - gradient(c - h)) / (2 * STEP) for h in steps])
    return 0.5 * (H + H.T)


def convex(H: Array) -> Array:
    values, vectors = np.linalg.eigh(H)
    floor = FLOOR * max(abs(values[0]), abs(values[-1]))
    return (vectors * np.maximum(values, floor)) @ vectors.T


@given(name=names, seed=seeds)
@settings(max_examples=40)
def test_posture_exerts_no_force_on_the_tip(name: str, seed: int) -> None:
    """Its gradient, in actuator metres, has no part along the tip's motions."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    c = robot.home + random_step(robot, rng, 0.5)
    J = robot.points_jacobian(c)[-1] @ np.linalg.inv(actuator_metric(robot))

    def force(cost: WeightedCost) -> float:
        """On the tip, relative to the gradient."""
        mpc = controller(robot, cost)
        pull = mpc.problem(mpc.init(c), robot.tip(c)).f
        return float(np.linalg.norm(J @ pull) / np.linalg.norm(J, 2) / np.linalg.norm(pull))

    assert force(Posture(weight=5.0)) < FORCE
    assert force(PrintedLengths(weight=5.0)) > 10 * FORCE  # the other side: notes B5


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_posture_wants_nothing_at_home(name: str) -> None:
    mpc = controller(ROBOTS[name], Posture(weight=5.0))
    problem = mpc.problem(mpc.init(mpc.robot.home), np.zeros(3))
    assert np.all(problem.f == 0.0)
    assert np.min(np.linalg.eigvalsh(problem.H)) > -ROUNDING
    state, command = mpc.step(mpc.init(mpc.robot.home), np.zeros(3))
    assert np.max(np.abs(state.c - mpc.robot.home)) < ROUNDING
    assert np.max(np.abs(command.rates)) < ROUNDING / DT


@given(name=names, seed=seeds)
@settings(max_examples=20)
def test_metric_measures_actuator_changes(name: str, seed: int) -> None:
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    v = random_step(robot, rng, 0.1)
    change = np.linalg.norm(robot.lengths(robot.home + v) - robot.lengths(robot.home))
    assert np.linalg.norm(actuator_metric(robot) @ v) == pytest.approx(change, rel=1e-10)


@given(name=names, seed=seeds)
@settings(max_examples=20)
def test_effort_is_the_squared_displacement_per_printed_step(name: str, seed: int) -> None:
    """1/2 v' H v = R |u|^2 where u is the actuator speed of a step v at 30 Hz."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    v = random_step(robot, rng, 0.1)
    u = (robot.lengths(robot.home + v) - robot.lengths(robot.home)) * 30.0
    value = 0.5 * v @ Effort(weight=10.0).hessian(robot) @ v
    assert value == pytest.approx(10.0 * np.sum(u**2), rel=1e-10)


@pytest.mark.parametrize("dt", [1 / 30, 1 / 200, 1 / 1000])
def test_effort_means_the_same_at_every_rate(dt: float) -> None:
    """A step towards a near target removes the same share of the error at any rate."""
    robot, start = ROBOTS["hachen2025"], ROBOTS["hachen2025"].home
    target = robot.tip(start) + np.array([1e-8, 0.0, 0.0])  # far below what a rate limit forbids
    costs = Costs(state=(TipError(weight=1e5),), effort=Effort(weight=1.0))
    mpc = ShapeConstrainedMPC(robot, FREE, dt=dt, horizon=1, costs=costs)
    problem = mpc.problem(mpc.init(start), target)
    delta = by_y(mpc) @ np.linalg.solve(problem.H, -problem.f)
    J, M = robot.points_jacobian(start)[-1], actuator_metric(robot)
    gain = J @ np.linalg.solve(1e5 * J.T @ J + 900.0 * M.T @ M, J.T) * 1e5
    expected = gain @ (target - robot.tip(start))  # closed form, with no dt in it
    np.testing.assert_allclose(J @ delta, expected, rtol=0, atol=1e-4 * 1e-8)


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_a_cost_of_ones_own_works_in_a_closed_loop(name: str) -> None:
    """A point in the middle of the body goes where it is pulled, and the tip to its target."""
    robot = ROBOTS[name]
    bent = robot.home + random_step(robot, np.random.default_rng(5), 0.2)
    index = len(robot.radii) // 2
    pull = PointError(index=index, goal=robot.points(bent)[index], weight=1e5)
    mpc = controller(robot, TipError(weight=1e5), pull, horizon=5)
    last, c = rest(mpc, robot.tip(bent))
    assert last.report.status is Status.AT_TARGET
    assert np.linalg.norm(robot.points(c)[index] - pull.goal) < THERE
    without, c = rest(controller(robot, TipError(weight=1e5), horizon=5), robot.tip(bent))
    assert without.report.status is Status.AT_TARGET
    assert np.linalg.norm(robot.points(c)[index] - pull.goal) > 10 * THERE


def rest(mpc: ShapeConstrainedMPC, target: Array, steps: int = 200) -> tuple[Command, Array]:
    """The last command of a way from home, and where it ends."""
    state, command = mpc.step(mpc.init(mpc.robot.home), target)
    for _ in range(steps):
        state, command = mpc.step(state, target)
    return command, state.c


# --- limits ------------------------------------------------------------------------------


def near_limits(mpc: ShapeConstrainedMPC, rng: np.random.Generator, room: float) -> MPCState | None:
    """A start with some actuator within `room` of a limit and a plan within limits, if found."""
    robot = mpc.robot
    assert isinstance(robot, PccRobot)
    A, metric = robot.lengths_jacobian(robot.home), actuator_metric(robot)
    for _ in range(20):
        c = robot.home + random_step(robot, rng, 0.05)
        k, side = int(rng.integers(len(A))), int(rng.integers(2))
        # Along the least change of all actuators that changes this one.
        way = np.linalg.solve(metric.T @ metric, A[k])
        missing = robot.length_limits[k, side] - robot.lengths(c)[k]
        missing -= (1 if side else -1) * rng.uniform(0.0, room)
        c = c + way * missing / float(A[k] @ way)
        steps = rng.normal(size=(mpc.horizon, len(c))) @ by_y(mpc).T * 0.3
        plan = c + np.cumsum(steps, axis=0)
        lengths, moves = robot.lengths(plan), moved(robot, c, plan)
        low, high = robot.length_limits.T
        slow, fast = robot.rate_limits.T * DT
        if np.all((lengths >= low) & (lengths <= high)) and np.all(
            (moves >= slow) & (moves <= fast)
        ):
            return replace(mpc.init(c), plan=plan)
    return None


def moved(robot: PccRobot, start: Array, plan: Array) -> Array:
    """Changes of the actuators from stage to stage (N, P)."""
    return np.diff(robot.lengths(np.vstack([start, plan])), axis=0)


def holds(problem: DenseProblem, y: Array, what: int) -> bool:
    """Whether all hard rows of a kind hold at y (N n,)."""
    rows = np.isinf(problem.price) & (problem.what == what)
    value = problem.A[rows] @ y
    return bool(np.all((value >= problem.lower[rows]) & (value <= problem.upper[rows])))


@given(name=names, seed=seeds, horizon=st.sampled_from([1, 3, 6]))
@settings(max_examples=40)
def test_hard_rows_hold_exactly_where_the_exact_limits_do(
    name: str, seed: int, horizon: int
) -> None:
    """Rates always; lengths, and the trust region, among what the rates can reach."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    mpc = controller(robot, TipError(weight=1e5), horizon=horizon)
    state = near_limits(mpc, rng, 3e-4)
    if state is None:
        return
    problem = mpc.problem(state, np.zeros(3))
    # The trust region is at least one step at full speed; short plans have none.
    trust = max(5e-4, float(np.max(robot.rate_limits)) * DT) if horizon >= 5 else np.inf
    low, high = robot.length_limits.T
    slow, fast = robot.rate_limits.T * DT
    for size in (0.03, 0.1, 0.2, 0.3, 0.5, 1.0):
        steps = size * rng.normal(size=(horizon, len(state.c))) @ by_y(mpc).T
        plan = state.plan + np.cumsum(steps, axis=0)
        moves, lengths = moved(robot, state.c, plan), robot.lengths(plan)
        in_time = bool(np.all((moves >= slow) & (moves <= fast)))
        y = np.linalg.solve(by_y(mpc), (plan - state.plan).T).T.ravel()
        assert holds(problem, y, RATE_LIMIT) == in_time
        if in_time:
            allowed = np.all((lengths >= low) & (lengths <= high))
            allowed &= np.all(np.abs(lengths - robot.lengths(state.plan)) <= trust)
            assert holds(problem, y, STATE_LIMIT) == allowed


@given(name=names, seed=seeds, horizon=st.sampled_from([1, 5]), size=st.sampled_from([0.1, 3.0]))
@settings(max_examples=40)
def test_standing_still_is_always_allowed(name: str, seed: int, horizon: int, size: float) -> None:
    """Even from lengths beyond their limits, by rounding or more."""
    rng = np.random.default_rng(seed)
    mpc = controller(ROBOTS[name], TipError(weight=1e5), horizon=horizon, tip_speed=0.01)
    problem = mpc.problem(random_state(mpc, rng, size), np.zeros(3))
    hard = np.isinf(problem.price)
    assert np.all(problem.lower[hard] <= 0.0)
    assert np.all(problem.upper[hard] >= 0.0)
    assert set(problem.what[hard]) >= {RATE_LIMIT, TIP_SPEED}


@pytest.mark.parametrize("beyond", [1e-12, 1e-4])
def test_a_robot_beyond_a_length_limit_is_not_stuck(beyond: float) -> None:
    """By rounding or more: it may stay, and it may come back."""
    robot = ROBOTS["hachen2025"]
    mpc = controller(robot, TipError(weight=1e5), Posture(weight=5.0), horizon=5)
    start = robot.home.copy()
    start[2] = 0.04 - beyond
    for side in (0.0, 0.01):
        target = robot.tip(start) + [side, 0.0, side]
        state, command = mpc.step(mpc.init(start), target)
        assert command.report.status is not Status.HOLDING
        assert robot.lengths(state.c)[3] >= robot.lengths(start)[3] - LENGTH
    assert np.linalg.norm(robot.tip(state.c) - robot.tip(start)) > 1e-4


@given(name=names, seed=seeds)
@settings(max_examples=20)
def test_tip_speed_rows_are_a_box_around_the_ball(name: str, seed: int) -> None:
    """Every motion within the speed limit is in the box, and none beyond sqrt 3 of it."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    mpc = controller(robot, TipError(weight=1e5), tip_speed=0.02)
    state = mpc.init(robot.home + random_step(robot, rng, 0.5))
    problem = mpc.problem(state, np.zeros(3))
    y = rng.normal(size=len(state.c))
    way = robot.points_jacobian(state.c)[-1] @ by_y(mpc) @ y
    y *= 0.02 * DT / np.linalg.norm(way)
    assert holds(problem, y * (1 - SPEED), TIP_SPEED)
    assert not holds(problem, y * np.sqrt(3.0) * (1 + SPEED), TIP_SPEED)


# --- what is active ------------------------------------------------------------------------


def test_limits_that_are_leaned_on_are_named_and_weighed() -> None:
    """At rest below a target that is too high, what a metre of backbone is worth is known."""
    robot = ROBOTS["hachen2025"]
    mpc = controller(robot, TipError(weight=1e5), Posture(weight=5.0))
    target = robot.tip(robot.home) + [0.0, 0.0, 0.2]
    last, c = rest(mpc, target)
    assert last.report.status is Status.BLOCKED
    active = {one.name: one for one in last.report.active}
    assert set(active) == {f"segment {k} backbone at its length limit" for k in (1, 2, 3)}
    np.testing.assert_allclose(c[2::3], 0.09, rtol=0, atol=THERE)
    worth = 2e5 * float(target[2] - robot.tip(c)[2])  # what the tip's cost loses per metre
    for one in active.values():
        assert one.multiplier == pytest.approx(worth, rel=WORTH)
        assert one.triangle == -1


def test_only_rows_near_a_limit_are_called_a_limit() -> None:
    """Not the trust region: a robot far from its limits leans on none of its lengths."""
    robot = ROBOTS["hachen2025"]
    mpc = controller(robot, TipError(weight=1e5), horizon=5)
    target = robot.tip(robot.home) + [0.05, 0.0, 0.0]
    _, command = mpc.step(mpc.init(robot.home), target)
    named = [one.name for one in command.report.active]
    assert not any("length limit" in name for name in named)
    assert any(name.endswith("at its speed limit") for name in named)


def test_a_speed_limit_of_the_tip_is_named() -> None:
    robot = ROBOTS["hachen2025"]
    mpc = controller(robot, TipError(weight=1e5), Posture(weight=5.0), horizon=5, tip_speed=0.005)
    target = robot.tip(robot.home) + [0.0, 0.0, 0.03]
    state, command = mpc.step(mpc.init(robot.home), target)
    assert [one.name for one in command.report.active] == ["tip at its speed limit"]
    way = np.linalg.norm(robot.tip(state.c) - robot.tip(robot.home))
    assert way == pytest.approx(0.005 * DT, rel=1e-3)
    assert way <= 0.005 * DT * (1 + SPEED)


def test_a_robot_at_its_target_leans_on_nothing() -> None:
    robot = ROBOTS["hachen2025"]
    mpc = controller(robot, TipError(weight=1e5), Posture(weight=5.0), horizon=5, tip_speed=0.005)
    last, _ = rest(mpc, robot.tip(robot.home), steps=5)
    assert last.report.active == ()


# --- the share of a step that limits allow -------------------------------------------------


@given(name=names, seed=seeds, size=st.sampled_from([1e-3, 1e-2, 0.1, 0.3]))
@settings(max_examples=80)
def test_the_filter_takes_the_largest_share_that_rates_and_lengths_allow(
    name: str, seed: int, size: float
) -> None:
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    dt = rng.uniform(1e-3, 1.0)
    mpc = ShapeConstrainedMPC(robot, FREE, dt=dt)
    near = near_limits(controller(robot, TipError(weight=1e5)), rng, 2e-4)
    start = robot.home if near is None or rng.uniform() < 0.5 else near.c
    goal = start + random_step(robot, rng, size)
    # Bends are concave in c: two ends that are allowed will do.
    if min(np.min(robot.bend_slack(c)) for c in (start, goal)) <= 0.0:
        return
    now, change = robot.lengths(start), robot.lengths(goal) - robot.lengths(start)
    ahead = np.where(change > 0.0, robot.rate_limits[:, 1] * dt, -robot.rate_limits[:, 0] * dt)
    room = np.where(change > 0.0, robot.length_limits[:, 1] - now, now - robot.length_limits[:, 0])
    allowed = min(1.0, float(np.min(np.minimum(ahead, np.maximum(room, 0.0)) / np.abs(change))))
    end, share = mpc.accept(start, goal)
    assert share == pytest.approx(allowed, rel=SHARE, abs=SHARE)
    np.testing.assert_allclose(end, start + share * (goal - start), rtol=0, atol=ROUNDING)
    taken = robot.lengths(end) - now
    assert np.all(taken <= robot.rate_limits[:, 1] * dt + LENGTH)
    assert np.all(taken >= robot.rate_limits[:, 0] * dt - LENGTH)


@given(seed=seeds)
@settings(max_examples=20)
def test_rates_are_kept_in_both_directions(seed: int) -> None:
    rng = np.random.default_rng(seed)
    robot = ROBOTS["hachen2025"]
    mpc = ShapeConstrainedMPC(robot, FREE, dt=DT)
    way = random_step(robot, rng, 0.3)
    there, back = (mpc.accept(robot.home, robot.home + side * way)[1] for side in (1.0, -1.0))
    assert there == pytest.approx(back, rel=SHARE)
    assert there < 1.0


def test_a_robot_beyond_a_length_limit_may_only_come_back() -> None:
    robot = ROBOTS["hachen2025"]
    mpc = ShapeConstrainedMPC(robot, FREE, dt=DT)
    start, way = robot.home.copy(), np.zeros(9)
    start[2], way[2] = 0.0399, 1e-4
    assert mpc.accept(start, start + way)[1] == 1.0
    assert mpc.accept(start, start - way)[1] == 0.0


def test_tip_speed_is_exact_on_a_straight_way() -> None:
    robot = ROBOTS["hachen2025"]
    goal = robot.home + np.array([0.0, 0.0, 0.0002] * 3)  # 0.6 mm along z
    slow = ShapeConstrainedMPC(robot, FREE, dt=DT, tip_speed=0.003)
    assert slow.accept(robot.home, goal)[1] == pytest.approx(1e-4 / 6e-4, rel=SHARE)
    assert slow.accept(robot.home, robot.home)[1] == 1.0
    late = ShapeConstrainedMPC(robot, FREE, dt=1.0, tip_speed=0.003)
    assert late.accept(robot.home, goal)[1] == 1.0


@given(name=names, seed=seeds, share=st.sampled_from([0.05, 0.3, 0.6, 0.95]))
@settings(max_examples=40)
def test_tip_speed_holds_for_the_step_that_is_taken(name: str, seed: int, share: float) -> None:
    """The tip's way is curved: a share of a step is not a share of the way."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    start, dt = robot.home, 2.0  # [s] time enough for the actuators
    goal = start + random_step(robot, rng, 0.1)
    limit = share * float(np.linalg.norm(robot.tip(goal) - robot.tip(start))) / dt
    mpc = ShapeConstrainedMPC(robot, FREE, dt=dt, tip_speed=limit)
    end, _ = mpc.accept(start, goal)
    way = np.linalg.norm(robot.tip(end) - robot.tip(start))
    assert way <= limit * dt * (1 + SPEED)
    assert way > 0.5 * limit * dt  # not given away either
