"""Damped least squares (30), (31): the law against its dense form, its limits, its feedback."""

import pickle
from dataclasses import replace

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.dls import DampedLeastSquares
from sinuous.control.report import Status
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.plants.kinematic import KinematicPlant
from sinuous.robots.robot_file import load_robot

from .scenes import MARGIN, START, bent_tube

ROBOT = load_robot("hachen2025")
FREE = SafeZone.unbounded()
HOME_TIP = ROBOT.tip(ROBOT.home)
NEAR = HOME_TIP + np.array([0.02, 0.01, -0.01])
DT = 1 / 30

ROUNDING = 1e-12  # [m] or [m/s], of sums of a dozen lengths below 1 m
STEP = 1e-6  # of central differences; their error is of the order of its square
# Length limits and the coupling rules are met in turn, three times: what is left of a violation.
LEFT = 2e-5  # [m]


def tube(**changes: float) -> DampedLeastSquares:
    scene = bent_tube()
    return DampedLeastSquares(scene.robot, scene.zone, margin=MARGIN, **changes)


def in_the_wall(rng: np.random.Generator) -> Array:
    """A configuration whose body is beyond the margin at several disks, by 1 to 10 mm."""
    return START + rng.uniform(0.15, 0.35, 9) * np.tile([1.0, 1.0, 0.0], 3)


def run(controller: DampedLeastSquares, target: Array, steps: int, c: Array = ROBOT.home) -> Array:
    """Tips (steps + 1, 3) of the model on its own."""
    state, tips = controller.init(c), [controller.robot.tip(c)]
    for _ in range(steps):
        state, command = controller.step(state, target)
        tips.append(command.report.points[-1])
    return np.array(tips)


# --- the law ----------------------------------------------------------------------------------


@pytest.mark.parametrize("seed", range(5))
def test_the_law_is_the_printed_one_with_the_penalty_reversed(seed: int) -> None:
    rng = np.random.default_rng(seed)
    dls = tube(gain=0.3, damping=0.7, penalty=0.2)
    c, error = in_the_wall(rng), 0.01 * rng.normal(size=3)
    points = dls.robot.points(c)
    _, slope = dls.collision_cost(points)
    assert np.count_nonzero(np.any(slope, axis=1)) > 1
    # Literally (30): twelve actuators, J_c L+.
    to_c = np.linalg.pinv(dls.robot.lengths_jacobian(c))
    J = dls.robot.points_jacobian(c) @ to_c
    dh = 0.2 * np.einsum("sdp,sd->p", J, slope)
    W = 0.7 * np.eye(12)
    u = 0.3 * np.linalg.solve(J[-1].T @ J[-1] + W, J[-1].T @ error - W @ dh)
    np.testing.assert_allclose(dls.displacement(c, error, points), u, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("seed", range(5))
def test_the_penalty_slopes_as_finite_differences_say(seed: int) -> None:
    rng = np.random.default_rng(seed)
    dls, c, way = tube(), in_the_wall(rng), rng.normal(size=9) * np.tile([1.0, 1.0, 0.01], 3)
    h, slope = dls.collision_cost(dls.robot.points(c))
    there = [dls.collision_cost(dls.robot.points(c + s * STEP * way))[0] for s in (-1, 1)]
    moved = dls.robot.points_jacobian(c) @ way
    assert h > 0.0
    assert (there[1] - there[0]) / (2 * STEP) == pytest.approx(np.sum(slope * moved), rel=1e-5)


def test_what_is_asked_for_keeps_the_sum_rule() -> None:
    dls, rng = tube(), np.random.default_rng(3)
    c = in_the_wall(rng)
    u = dls.displacement(c, 0.01 * rng.normal(size=3), dls.robot.points(c))
    segments = u.reshape(3, 4)
    assert np.max(np.abs(u)) > 1e-5
    violation = 3.0 * segments[:, 3] - np.sum(segments[:, :3], axis=1)
    assert np.max(np.abs(violation)) < ROUNDING


def test_there_is_no_penalty_within_the_margin() -> None:
    dls = tube()
    h, slope = dls.collision_cost(dls.robot.points(START))
    assert h == 0.0
    assert not np.any(slope)


@pytest.mark.parametrize("gain", [0.05, 0.5, 1.0])
@pytest.mark.parametrize("damping", [1e-6, 1.0])
def test_an_error_fades_as_gain_and_damping_say(gain: float, damping: float) -> None:
    dls = DampedLeastSquares(ROBOT, FREE, gain=gain, damping=damping)
    L = ROBOT.lengths_jacobian(ROBOT.home)
    J = ROBOT.points_jacobian(ROBOT.home)[-1] @ np.linalg.pinv(L)
    error = np.array([1e-6, 2e-6, -1e-6])  # [m] so small that the kinematics are linear
    *_, after = run(dls, HOME_TIP + error, 1)
    stiffness = J @ J.T
    left = error - gain * stiffness @ np.linalg.solve(stiffness + damping * np.eye(3), error)
    np.testing.assert_allclose(HOME_TIP + error - after, left, rtol=0, atol=1e-10)


def test_a_gain_means_the_same_at_every_rate() -> None:
    """A second on the way to a target 3 mm ahead, at 30 Hz and at 300 Hz."""
    near, left = HOME_TIP + np.array([0.0, 0.0, 3e-3]), list[float]()
    for rate in (30, 300):
        dls = DampedLeastSquares(ROBOT, FREE, dt=1 / rate, gain=0.05, damping=1e-6)
        left.append(float(np.linalg.norm(near - run(dls, near, rate)[-1])))
    assert left[0] == pytest.approx(3e-3 * 0.95**30, rel=1e-2)
    assert left[1] == pytest.approx(left[0], rel=1e-2)


# --- limits -----------------------------------------------------------------------------------


@pytest.mark.parametrize("gain", [0.05, 1.0])
def test_limits_hold_wherever_the_target_is(gain: float) -> None:
    rng = np.random.default_rng(8)
    dls = DampedLeastSquares(ROBOT, FREE, gain=gain, damping=0.01)
    low, high = ROBOT.length_limits.T
    slowest, fastest = ROBOT.rate_limits.T
    state = dls.init(ROBOT.home)
    for _ in range(8):
        target = rng.uniform(-0.25, 0.25, 3)
        for _ in range(40):
            state, command = dls.step(state, target)
            lengths = ROBOT.lengths(state.c)
            assert np.all(command.rates <= fastest + ROUNDING)
            assert np.all(command.rates >= slowest - ROUNDING)
            assert np.all(lengths >= low - LEFT)
            assert np.all(lengths <= high + LEFT)
            assert np.min(ROBOT.bend_slack(state.c)) >= -LEFT


def test_a_far_target_is_approached_along_the_step_and_not_along_its_stops() -> None:
    """Deadbeat towards a place 200 mm away: the step itself would end far beyond all limits."""
    dls = DampedLeastSquares(ROBOT, FREE, gain=1.0, damping=0.01)
    target = np.array([0.12, 0.0, 0.08])
    distance = np.linalg.norm(run(dls, target, 300) - target, axis=1)
    assert distance[0] > 0.15
    assert distance[-1] < 1e-6


# --- measurements -----------------------------------------------------------------------------


def measured_at(c: Array, **changes: Array) -> Measurement:
    exact = Measurement(tip=ROBOT.tip(c), lengths=ROBOT.lengths(c), points=ROBOT.points(c))
    return replace(exact, **changes)


def test_an_exact_plant_changes_nothing() -> None:
    dls = DampedLeastSquares(ROBOT, FREE, gain=0.2)
    plant = KinematicPlant(ROBOT, seed=0)
    alone = together = dls.init(ROBOT.home)
    seen: Measurement | None = None
    for _ in range(60):
        alone, _ = dls.step(alone, NEAR)
        together, command = dls.step(together, NEAR, seen)
        seen = plant.step(command.rates, DT)
    np.testing.assert_allclose(together.c, alone.c, rtol=0, atol=1e-10)


def test_the_measured_tip_is_brought_to_the_target() -> None:
    dls, offset = DampedLeastSquares(ROBOT, FREE, gain=0.3), np.array([0.003, -0.002, 0.001])
    state, command = dls.init(ROBOT.home), None
    for _ in range(200):
        seen = measured_at(state.c, tip=ROBOT.tip(state.c) + offset)
        state, command = dls.step(state, NEAR, seen)
    assert command is not None
    assert command.report.status is Status.AT_TARGET
    assert np.linalg.norm(ROBOT.tip(state.c) + offset - NEAR) < 1e-6


def test_a_coil_beyond_the_tip_is_taken_to_its_place() -> None:
    dls, coil = DampedLeastSquares(ROBOT, FREE), np.array([0.001, 0.0, 0.01])
    c = ROBOT.home + np.tile([0.3, -0.2, 0.0], 3)
    T = ROBOT.tip_pose(c)
    at_coil = measured_at(c, tip=T[:3, 3] + T[:3, :3] @ coil, coil=coil)
    _, there = dls.step(dls.init(c), NEAR, at_coil)
    _, plain = dls.step(dls.init(c), NEAR, measured_at(c))
    np.testing.assert_allclose(there.rates, plain.rates, rtol=0, atol=ROUNDING)


def test_walls_are_felt_where_the_body_was_measured() -> None:
    dls = tube(penalty=1.0)
    tip, lengths = dls.robot.tip(START), dls.robot.lengths(START)
    shifted = dls.robot.points(START) + np.array([0.015, 0.0, 0.0])
    shape = Measurement(tip=tip, lengths=lengths, points=shifted)
    _, pushed = dls.step(dls.init(START), tip, shape)
    _, unpushed = dls.step(dls.init(START), tip, Measurement(tip=tip, lengths=lengths))
    assert np.max(np.abs(unpushed.rates)) < 1e-9
    assert np.max(np.abs(pushed.rates)) > 1e-3
    moved = dls.robot.points_jacobian(START) @ dls.robot.configuration(pushed.rates)
    assert np.min(moved[:, 0]) < -1e-3  # away from the wall


def test_the_state_is_where_the_encoders_are_after_the_command() -> None:
    dls, elsewhere = DampedLeastSquares(ROBOT, FREE), ROBOT.home + np.tile([0.1, 0.0, 0.002], 3)
    state, command = dls.step(dls.init(ROBOT.home), NEAR, measured_at(elsewhere))
    lengths = ROBOT.lengths(elsewhere) + DT * command.rates
    np.testing.assert_allclose(ROBOT.lengths(state.c), lengths, rtol=0, atol=ROUNDING)
    np.testing.assert_array_equal(command.report.points[-1], ROBOT.points(state.c)[-1])


# --- faults and status ------------------------------------------------------------------------


@pytest.mark.parametrize("target", [[np.nan, 0.0, 0.1], [np.inf, 0.0, 0.1], [0.0, 0.1]])
def test_a_target_that_is_no_point_is_not_followed(target: list[float]) -> None:
    dls = tube()
    after, command = dls.step(dls.init(START), target)
    assert command.report.status is Status.HOLDING
    assert "target" in command.report.reason
    assert np.array_equal(after.c, START)
    assert np.all(command.rates == 0.0)


@pytest.mark.parametrize("what", ["tip", "lengths", "points", "coil"])
def test_a_measurement_that_is_not_finite_holds_still(what: str) -> None:
    dls = DampedLeastSquares(ROBOT, FREE)
    good = measured_at(ROBOT.home)
    bad = replace(good, **{what: getattr(good, what) * np.nan})
    after, command = dls.step(dls.init(ROBOT.home), NEAR, bad)
    assert command.report.status is Status.HOLDING
    assert "measurement" in command.report.reason
    assert np.array_equal(after.c, ROBOT.home)
    assert np.all(command.rates == 0.0)


@pytest.mark.parametrize("size", [1e30, 1e200, 1e308])
def test_numbers_too_large_to_compute_with_do_not_raise(size: float) -> None:
    dls = tube()
    _, command = dls.step(dls.init(START), [size, 0.0, 0.0])
    assert np.all(np.isfinite(command.rates))
    assert np.all(np.abs(command.rates) <= dls.robot.rate_limits[:, 1] + ROUNDING)
    _, command = dls.step(dls.init(START * np.nan), [0.0, 0.0, 0.1])
    assert command.report.status is Status.HOLDING


def test_the_status_says_where_it_rests() -> None:
    dls = DampedLeastSquares(ROBOT, FREE, gain=0.5)
    state = dls.init(ROBOT.home)
    _, command = dls.step(state, NEAR)
    assert command.report.status is Status.TRACKING
    _, command = dls.step(state, HOME_TIP)
    assert command.report.status is Status.AT_TARGET
    up = ROBOT.home + np.tile([0.0, 0.0, 0.025], 3)  # as long as it gets
    _, command = dls.step(dls.init(up), ROBOT.tip(up) + np.array([0.0, 0.0, 0.1]))
    assert command.report.status is Status.BLOCKED


def test_it_can_be_sent_to_another_process() -> None:
    dls = tube()
    state, _ = dls.step(dls.init(START), [0.01, 0.0, 0.1])
    other, there = pickle.loads(pickle.dumps((dls, state)))
    here, _ = dls.step(state, [0.01, 0.0, 0.1])
    again, _ = other.step(there, [0.01, 0.0, 0.1])
    np.testing.assert_array_equal(here.c, again.c)


def test_a_start_of_another_robot_is_refused() -> None:
    with pytest.raises(ValueError, match="9 coordinates"):
        tube().init(START[:6])


@pytest.mark.parametrize(
    ("field", "value"),
    [("margin", -1e-3), ("margin", np.nan), ("dt", 0.0), ("gain", 0.0), ("gain", 1.1),
     ("gain", np.nan), ("damping", 0.0), ("damping", np.inf), ("penalty", -1.0)],
)  # fmt: skip
def test_settings_that_make_no_sense_are_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        DampedLeastSquares(ROBOT, FREE, **{field: value})
