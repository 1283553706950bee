"""Costs against their own values, limits against the exact ones."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.control import qp
from sinuous.control.safety import SafetyFilter
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
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

ROBOTS = {name: load_robot(name) for name in ("hachen2025", "opencr_v4")}
FREE = SafeZone.unbounded()
DT = 1 / 30  # [s]

GRADIENT = 1e-6  # relative error against central differences with steps of 1e-4: 1e-8 and less
STEP = 1e-4  # [rad or m]
QUADRATIC = 1e-9  # relative: costs that are quadratic equal their model, differences cancel
ROUNDING = 1e-12  # relative
# Force of the posture cost on the tip, relative to the cost's own gradient: the damping over
# the tip's squared gain, 1e-5 / 1, and some for weak directions.
FORCE = 1e-3
SPEED = 1e-6  # relative excess of a speed limit that is rounding

seeds = st.integers(0, 2**32 - 1)
names = st.sampled_from(sorted(ROBOTS))


def random_stage(robot: PccRobot, rng: np.random.Generator) -> Stage:
    return Stage(robot=robot, zone=FREE, c=robot.home + random_step(robot, rng, 0.5))


def random_step(robot: PccRobot, rng: np.random.Generator, size: float) -> Array:
    """A change of all bends by about `size` rad, of the lengths by as many hundredths of a m."""
    unit = np.array([0.01 if name.endswith("length") else 1.0 for name in robot.coordinate_names])
    return size * unit * rng.normal(size=len(unit))


def differences(cost: Cost, stage: Stage, target: Array) -> Array:
    """Gradient (n,) of the cost's value at the stage."""

    def value(c: Array) -> float:
        return cost.value(stage.moved_to(c), target, stage)

    steps = STEP * np.eye(len(stage.c))
    return np.array([(value(stage.c + h) - value(stage.c - h)) / (2 * STEP) for h in steps])


@given(name=names, seed=seeds)
@settings(max_examples=30)
@pytest.mark.parametrize(
    "cost", [TipError(weight=1e5), PrintedLengths(weight=10.0), Posture(weight=5.0)]
)
def test_gradient_is_that_of_the_value(cost: Cost, name: str, seed: int) -> None:
    rng = np.random.default_rng(seed)
    stage, target = random_stage(ROBOTS[name], rng), rng.normal(0.0, 0.1, 3)
    gradient = cost.quadratic(stage, target).gradient
    error = np.abs(gradient - differences(cost, stage, target))
    assert np.max(error) < GRADIENT * np.max(np.abs(gradient))


@given(name=names, seed=seeds)
@settings(max_examples=20)
@pytest.mark.parametrize("cost", [PrintedLengths(weight=10.0), Posture(weight=5.0)])
def test_quadratic_costs_equal_their_model(cost: Cost, name: str, seed: int) -> None:
    """Lengths are affine and the posture's projector is frozen: the model is exact far away."""
    rng = np.random.default_rng(seed)
    robot = ROBOTS[name]
    stage, step, target = random_stage(robot, rng), random_step(robot, rng, 0.5), np.zeros(3)
    model = cost.quadratic(stage, target)
    predicted = model.gradient @ step + 0.5 * step @ model.hessian @ step
    values = [cost.value(stage.moved_to(c), target, stage) for c in (stage.c, stage.c + step)]
    assert abs(values[1] - values[0] - predicted) < QUADRATIC * max(values)


@given(name=names, seed=seeds)
@settings(max_examples=20)
def test_tip_error_with_the_curvature_of_its_force_is_second_order(name: str, seed: int) -> None:
    """What the model leaves over falls with the cube of the step: 8 times at half of it."""
    rng = np.random.default_rng(seed)
    robot, cost = ROBOTS[name], TipError(weight=1e5)
    stage, target = random_stage(robot, rng), rng.normal(0.0, 0.1, 3)
    step, model = random_step(robot, rng, 0.02), cost.quadratic(stage, target)
    forces = np.zeros_like(stage.points)
    forces[-1] = cost.force(stage, target)
    H = model.hessian + robot.points_curvature(stage.c, forces)

    def left(share: float) -> float:
        d = share * step
        value = cost.value(stage.moved_to(stage.c + d), target, stage)
        linear = cost.value(stage, target, stage) + model.gradient @ d
        return abs(value - linear - 0.5 * d @ H @ d)

    scale = abs(model.gradient @ step)
    assert left(0.5) < left(1.0) / 5.0 + 1e-6 * scale
    assert left(1.0) < 0.2 * scale + 0.2 * step @ model.hessian @ step


@given(name=names, seed=seeds)
@settings(max_examples=40)
def test_posture_exerts_no_force_on_the_tip(name: str, seed: int) -> None:
    """Its gradient, in actuator metres, has no part along the tip's motions."""
    stage = random_stage(ROBOTS[name], np.random.default_rng(seed))
    inverse = np.linalg.inv(actuator_metric(stage.robot))
    pull = inverse.T @ Posture(weight=5.0).quadratic(stage, stage.tip).gradient
    J = stage.jacobian[-1] @ inverse
    force = np.linalg.norm(J @ pull) / np.linalg.norm(J, 2)
    assert force < FORCE * np.linalg.norm(pull)
    printed = inverse.T @ PrintedLengths(weight=5.0).quadratic(stage, stage.tip).gradient
    force = np.linalg.norm(J @ printed) / np.linalg.norm(J, 2)
    assert force > 10 * FORCE * np.linalg.norm(printed)  # the other side: notes B5


@pytest.mark.parametrize("name", sorted(ROBOTS))
def test_posture_wants_nothing_at_home(name: str) -> None:
    robot = ROBOTS[name]
    stage = Stage(robot=robot, zone=FREE, c=robot.home)
    model = Posture(weight=5.0).quadratic(stage, np.zeros(3))
    assert np.all(model.gradient == 0.0)
    assert np.min(np.linalg.eigvalsh(model.hessian)) > -ROUNDING


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


# --- limits ------------------------------------------------------------------------------


@given(name=names, seed=seeds, trust=st.sampled_from([1e-4, 5e-4, 1.0]))
@settings(max_examples=40)
def test_length_rows_hold_where_the_exact_limits_do(name: str, seed: int, trust: float) -> None:
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    stage = Stage(robot=robot, zone=FREE, c=robot.home + random_step(robot, rng, 0.1))
    limits = robot.length_limits
    if np.any((stage.lengths < limits[:, 0]) | (stage.lengths > limits[:, 1])):
        return
    rows = ActuatorLengths(trust=trust).rows(stage)
    for size in (1e-3, 1e-2, 0.1, 1.0):
        step = random_step(robot, rng, size)
        after = stage.moved_to(stage.c + step).lengths
        change = np.abs(after - stage.lengths)
        exact = (after >= limits[:, 0]) & (after <= limits[:, 1]) & (change <= trust)
        value = rows.jacobian @ step
        np.testing.assert_array_equal((value >= rows.lower) & (value <= rows.upper), exact)


@given(name=names, seed=seeds)
@settings(max_examples=20)
def test_standing_still_is_always_allowed(name: str, seed: int) -> None:
    """Even from lengths beyond their limits, by rounding or more."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    stage = Stage(robot=robot, zone=FREE, c=robot.home + random_step(robot, rng, 3.0))
    for rows in (
        ActuatorLengths(trust=5e-4).rows(stage),
        ActuatorRates().rows(stage, DT),
        TipSpeed(limit=0.01).rows(stage, DT),
    ):
        assert np.all(rows.lower <= 0.0)
        assert np.all(rows.upper >= 0.0)
        assert len(rows.names) == len(rows.lower) == len(rows.jacobian)


def test_only_rows_near_a_limit_are_called_a_limit() -> None:
    robot = ROBOTS["hachen2025"]
    c = robot.home.copy()
    c[2] = 0.0402  # [m] 0.2 mm from the shortest backbone
    rows = ActuatorLengths(trust=5e-4).rows(Stage(robot=robot, zone=FREE, c=c))
    named = [name for name in rows.names if name]
    assert named == ["segment 1 backbone at its length limit"]


@given(name=names, seed=seeds, size=st.sampled_from([1e-3, 1e-2, 0.3]))
@settings(max_examples=40)
def test_rate_fraction_is_the_largest_allowed(name: str, seed: int, size: float) -> None:
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    start = random_stage(robot, rng)
    end = start.moved_to(start.c + random_step(robot, rng, size))
    limit, dt = ActuatorRates(), rng.uniform(1e-3, 0.1)
    share = limit.fraction(start, end, dt)
    taken = start.moved_to(start.c + share * (end.c - start.c))
    load = np.max((taken.lengths - start.lengths) / (robot.rate_limits[:, 1] * dt))
    load = max(load, np.max((taken.lengths - start.lengths) / (robot.rate_limits[:, 0] * dt)))
    if share < 1.0:
        assert load == pytest.approx(1.0, abs=1e-9)
    else:
        assert load <= 1.0 + 1e-9
    rows = limit.rows(start, dt)
    value = rows.jacobian @ (taken.c - start.c)
    assert np.all(value <= rows.upper * (1 + SPEED))
    assert np.all(value >= rows.lower * (1 + SPEED))


@given(seed=seeds)
@settings(max_examples=20)
def test_one_sided_rates_are_kept_on_their_side(seed: int) -> None:
    """A rate limit need not be the same in both directions."""
    rng = np.random.default_rng(seed)
    robot = ROBOTS["hachen2025"]
    start = random_stage(robot, rng)
    end = start.moved_to(start.c + random_step(robot, rng, 0.3))
    share = ActuatorRates().fraction(start, end, DT)
    back = ActuatorRates().fraction(start, start.moved_to(2 * start.c - end.c), DT)
    assert share == pytest.approx(back, rel=1e-9)


def test_tip_speed_fraction_is_exact_on_a_straight_way() -> None:
    robot = ROBOTS["hachen2025"]
    start = Stage(robot=robot, zone=FREE, c=robot.home)
    end = start.moved_to(robot.home + np.array([0.0, 0.0, 0.002] * 3))  # 6 mm along z
    limit = TipSpeed(limit=0.03)
    assert limit.fraction(start, end, DT) == pytest.approx(1e-3 / 6e-3, rel=1e-9)
    assert limit.fraction(start, start, DT) == 1.0
    assert limit.fraction(start, end, 1.0) == 1.0


@given(name=names, seed=seeds, share=st.floats(0.05, 0.95))
@settings(max_examples=60)
def test_tip_speed_holds_for_the_step_that_is_taken(name: str, seed: int, share: float) -> None:
    """The tip's way is curved: a share of a step is not a share of the way."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    start = random_stage(robot, rng)
    goal = start.moved_to(start.c + random_step(robot, rng, 0.1))
    limit = TipSpeed(limit=share * float(np.linalg.norm(goal.tip - start.tip)) / DT)
    end, _ = SafetyFilter(shape=(), limits=(limit,), dt=DT).accept(start, goal)
    assert np.linalg.norm(end.tip - start.tip) <= limit.limit * DT * (1 + SPEED)
    assert np.linalg.norm(end.tip - start.tip) > 0.5 * limit.limit * DT  # not given away either


@given(name=names, seed=seeds)
@settings(max_examples=20)
def test_tip_speed_rows_are_a_box_around_the_ball(name: str, seed: int) -> None:
    """Every motion within the speed limit is in the box, and none beyond sqrt 3 of it."""
    robot, rng = ROBOTS[name], np.random.default_rng(seed)
    stage, limit = random_stage(robot, rng), TipSpeed(limit=0.02)
    rows = limit.rows(stage, DT)
    step = random_step(robot, rng, 0.01)
    moved = stage.jacobian[-1] @ step
    value = rows.jacobian @ step * (limit.limit * DT / np.linalg.norm(moved))
    assert np.all((value >= rows.lower * (1 + SPEED)) & (value <= rows.upper * (1 + SPEED)))
    corner = np.linalg.norm(rows.upper)
    assert corner == pytest.approx(np.sqrt(3.0) * limit.limit * DT, rel=1e-12)


@pytest.mark.parametrize("dt", [1 / 30, 1 / 200, 1 / 1000])
def test_effort_means_the_same_at_every_rate(dt: float) -> None:
    """A step towards a near target removes the same share of the error at any rate."""
    robot, start = ROBOTS["hachen2025"], ROBOTS["hachen2025"].home
    stage = Stage(robot=robot, zone=FREE, c=start)
    target = stage.tip + np.array([1e-8, 0.0, 0.0])  # far below what a rate limit forbids
    model = TipError(weight=1e5).quadratic(stage, target)
    step = float(np.max(robot.rate_limits)) * dt
    scale = qp.Scale(step=step, inverse=np.linalg.inv(actuator_metric(robot)))
    rows = ActuatorRates().rows(stage, dt)
    problem = qp.build(
        scale=scale,
        hessians=[model.hessian],
        gradients=[model.gradient],
        effort=Effort(weight=1.0).hessian(robot),
        increments=np.zeros((1, len(start))),
        rows=[(rows, [rows])],
    )
    delta = scale.delta(qp.solve(problem).y)[0]
    J = stage.jacobian[-1]
    metric = actuator_metric(robot)
    gain = J @ np.linalg.solve(1e5 * J.T @ J + 900.0 * metric.T @ metric, J.T) * 1e5
    expected = gain @ (target - stage.tip)  # closed form, with no dt in it
    np.testing.assert_allclose(J @ delta, expected, rtol=0, atol=1e-4 * 1e-8)
