"""The complete controller (29): feedback, its share of the speed limits, offsets, faults."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.hierarchical import HierarchicalController
from sinuous.control.local import LocalController
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.observed import Observed, observe, remember
from sinuous.control.offset_free import OffsetFree, When
from sinuous.control.report import Status
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.plants.kinematic import Disturbance, KinematicPlant
from sinuous.robots.robot_file import load_robot

ROBOT = load_robot("hachen2025")
FREE = SafeZone.unbounded()
DT = 1 / 30
TARGET = np.array([0.05, 0.0, 0.16])  # [m]
ARRIVED = 1e-5  # [m] a hundredth of a millimetre
ROUNDING = 1e-12
ASKEW = np.array([0.3, -0.2, 0.004, -0.25, 0.1, -0.003, 0.2, 0.3, 0.002])  # of a configuration
OFFSET = np.array([0.004, -0.003, 0.002])  # [m] of a tip that the model knows nothing of

MPC = ShapeConstrainedMPC(ROBOT, FREE, dt=DT, horizon=2)


def whole(c: Array) -> Observed:
    """A body that is where the model says."""
    points = ROBOT.points(c)
    return Observed(c=c, tip=points[-1], points=points)


def measured(c: Array, offset: Array | None = None) -> Measurement:
    """An exact measurement of all of a body, every point off by an offset."""
    points = ROBOT.points(c) + (0.0 if offset is None else offset)
    return Measurement(tip=points[-1], points=points, lengths=ROBOT.lengths(c))


def blind(reading: Measurement) -> Measurement:
    """The same without the body."""
    return replace(reading, points=np.zeros((0, 3)))


# --- the local controller (21)-(28) -----------------------------------------------------------


def test_its_rates_keep_the_coupling_rules() -> None:
    rng, local = np.random.default_rng(0), LocalController()
    for _ in range(20):
        c = ROBOT.home + 0.5 * rng.normal(size=9) * np.tile([1.0, 1.0, 0.01], 3)
        goal = ROBOT.points(c) + 0.003 * rng.normal(size=(len(ROBOT.radii), 3))
        rates = local.rates(ROBOT, whole(c), goal, DT).reshape(3, 4)
        np.testing.assert_allclose(3.0 * rates[:, 3], np.sum(rates[:, :3], axis=1), atol=ROUNDING)


def test_the_tips_error_decays_at_its_gain_and_the_bodys_with_it() -> None:
    """An exact robot that stands elsewhere than the nominal one."""
    local = LocalController(tip_gain=6.0, body_gain=30.0, damping=1e-6)
    goal, c = ROBOT.points(ROBOT.home), ROBOT.home + 0.2 * ASKEW
    tip, body = list[float](), list[float]()
    for _ in range(60):
        seen = whole(c)
        tip.append(float(np.linalg.norm(goal[-1] - seen.tip)))
        body.append(float(np.mean(np.sum((goal - seen.points) ** 2, axis=1))))
        c = (
            c
            + DT
            * np.linalg.lstsq(
                ROBOT.lengths_jacobian(c), local.rates(ROBOT, seen, goal, DT), rcond=None
            )[0]
        )
    # One step leaves 1 - k dt of it, but for the curvature of the kinematics.
    assert tip[1] / tip[0] == pytest.approx(0.8, abs=0.03)
    assert tip[30] < 0.01 * tip[0]
    assert all(later < earlier for earlier, later in pairwise(body))
    assert body[-1] < 0.05 * body[0]


def test_the_body_term_leaves_the_tip_alone() -> None:
    local = LocalController(tip_gain=0.0, body_gain=10.0, damping=1e-9)
    seen, goal = whole(ROBOT.home + ASKEW), ROBOT.points(ROBOT.home)
    rates = local.rates(ROBOT, seen, goal, DT)
    change = np.linalg.lstsq(ROBOT.lengths_jacobian(seen.c), rates, rcond=None)[0]
    moved = ROBOT.points_jacobian(seen.c) @ change
    assert np.linalg.norm(moved[-1]) < 1e-6 * np.max(np.linalg.norm(moved, axis=1))
    assert np.max(np.linalg.norm(moved, axis=1)) > 1e-3  # [m/s]


def test_no_gain_takes_more_than_all_of_an_error() -> None:
    seen, goal = whole(ROBOT.home + 0.05 * ASKEW), ROBOT.points(ROBOT.home)
    once = LocalController(tip_gain=1.0 / DT, body_gain=1.0 / DT).rates(ROBOT, seen, goal, DT)
    often = LocalController(tip_gain=1e6, body_gain=1e6).rates(ROBOT, seen, goal, DT)
    np.testing.assert_allclose(often, once, rtol=1e-12)


@pytest.mark.parametrize(
    "bad", [{"tip_gain": -1.0}, {"body_gain": np.nan}, {"damping": 0.0}, {"share": 1.0}]
)
def test_gains_that_make_no_sense_are_refused(bad: dict[str, float]) -> None:
    with pytest.raises(ValueError, match="must be"):
        LocalController(**bad)


# --- the whole (29) ---------------------------------------------------------------------------


def driven(
    controller: HierarchicalController, plant: KinematicPlant, steps: int, *, tip_only: bool = False
) -> tuple[list[Array], list[float]]:
    """True tips and nominal errors of a closed loop from home."""
    state, reading = controller.init(ROBOT.home), None
    tips, errors = list[Array](), list[float]()
    for _ in range(steps):
        state, command = controller.step(state, TARGET, reading)
        reading = plant.step(command.rates, DT)
        reading = blind(reading) if tip_only else reading
        tips.append(plant.truth.T_w_t[:3, 3])
        errors.append(float(np.linalg.norm(command.report.points[-1] + command.offset - TARGET)))
    return tips, errors


class Leaning(KinematicPlant):
    """A robot whose tip is always off by the same, and its body in proportion."""

    def _points(self, points):
        return super()._points(points) + np.linspace(0.0, 1.0, len(points))[:, None] * OFFSET

    def _look(self):
        truth = super()._look()
        T_w_t = truth.T_w_t.copy()
        T_w_t[:3, 3] += OFFSET
        return replace(truth, T_w_t=T_w_t)


PLAN_ONLY = OffsetFree(when=When.NEVER)


def test_a_constant_offset_is_gone_with_feedback_and_stays_without() -> None:
    def at_rest(local: LocalController | None, offset: OffsetFree, *, tip_only: bool) -> float:
        controller = HierarchicalController(MPC, local=local, offset_free=offset)
        tips, errors = driven(controller, Leaning(ROBOT, seed=0), 300, tip_only=tip_only)
        assert errors[-1] < ARRIVED
        return float(np.linalg.norm(tips[-1] - TARGET))

    off = float(np.linalg.norm(OFFSET))
    assert at_rest(None, PLAN_ONLY, tip_only=True) == pytest.approx(off, abs=ARRIVED)
    assert at_rest(LocalController(), PLAN_ONLY, tip_only=True) < ARRIVED
    assert at_rest(LocalController(), PLAN_ONLY, tip_only=False) < ARRIVED
    assert at_rest(None, OffsetFree(), tip_only=True) < ARRIVED
    assert at_rest(LocalController(), OffsetFree(), tip_only=True) < ARRIVED
    # By default nothing is learned where the whole body is measured.
    assert at_rest(None, OffsetFree(), tip_only=False) == pytest.approx(off, abs=ARRIVED)


def test_an_offset_of_a_robot_that_does_not_follow_is_limited() -> None:
    """It stands still whatever it is told: without a limit the plan runs away from it."""

    def largest(limit: float) -> float:
        offset = OffsetFree(when=When.ALWAYS, time_constant=0.1, limit=limit)
        controller = HierarchicalController(MPC, local=None, offset_free=offset)
        state, stuck = controller.init(ROBOT.home), measured(ROBOT.home)
        for _ in range(200):
            state, command = controller.step(state, TARGET, stuck)
        return float(np.linalg.norm(command.offset))

    assert largest(0.015) == pytest.approx(0.015)
    assert largest(10.0) > 0.1


def test_feedback_lowers_the_error_under_the_printed_disturbance() -> None:
    def mean_error(local: LocalController | None) -> float:
        controller = HierarchicalController(MPC, local=local, offset_free=PLAN_ONLY)
        plant = KinematicPlant(ROBOT, seed=3, disturbance=Disturbance.printed())
        tips, errors = driven(controller, plant, 300)
        assert errors[-1] < ARRIVED  # the nominal state is not disturbed
        return float(np.mean(np.linalg.norm(np.array(tips[150:]) - TARGET, axis=1)))

    assert mean_error(LocalController()) < 0.7 * mean_error(None)


def test_the_margin_promise_with_an_offset() -> None:
    """A target beyond the wall: nominal body at its margin, real one short of it by the offset."""
    tube = shapes.tube([[0.0, 0.0, -0.05], [0.0, 0.0, 0.32]], 0.03)
    zone = SafeZone.from_mesh(tube, name="tube")
    mpc = ShapeConstrainedMPC(ROBOT, zone, margin=0.0055, dt=DT, horizon=2)
    controller = HierarchicalController(mpc, local=None)
    state, reading = controller.init(ROBOT.home), None
    plant, nominal, actual = Leaning(ROBOT, seed=0), np.inf, np.inf
    for _ in range(250):
        state, command = controller.step(state, [0.05, 0.0, 0.2], reading)
        reading = blind(plant.step(command.rates, DT))
        nominal = min(nominal, command.report.clearance)
        room = zone.clearance(plant.truth.points) - ROBOT.radii
        actual = min(actual, float(np.min(room[ROBOT.movable])))
    assert nominal >= mpc.margin
    assert nominal - np.linalg.norm(OFFSET) <= actual < nominal


# --- B13: rates are shared --------------------------------------------------------------------


def far_off(share: float) -> tuple[Array, Array, float]:
    """One step with a real body far behind: plan, all rates, and how much was clipped."""
    controller = HierarchicalController(MPC, local=LocalController(share=share))
    state, far = controller.init(ROBOT.home), np.array([0.09, 0.06, 0.11])
    # The plan runs at full speed, and the body lags behind it in the same direction.
    for _ in range(5):
        state, _ = controller.step(state, far, None)
    state, command = controller.step(state, far, measured(ROBOT.home))
    return command.rates - command.local, command.rates, command.clipped


def test_b13_without_a_share_the_plan_leaves_nothing_to_the_local_controller() -> None:
    """(29) as printed adds to a plan that uses its limits to the full: the sum breaks them."""
    fastest = ROBOT.rate_limits[:, 1]
    plan, rates, clipped = far_off(share=0.0)
    assert np.max(np.abs(plan) / fastest) == pytest.approx(1.0, abs=1e-6)
    assert clipped > 0.1
    np.testing.assert_allclose(rates, plan, atol=1e-9)


def test_b13_with_a_share_the_local_controller_has_some_and_clipping_is_reported() -> None:
    fastest = ROBOT.rate_limits[:, 1]
    plan, rates, clipped = far_off(share=0.25)
    assert np.max(np.abs(plan) / fastest) == pytest.approx(0.75, abs=1e-6)
    assert np.max(np.abs(rates) / fastest) <= 1.0 + ROUNDING
    assert np.max(np.abs(rates - plan) / fastest) > 0.2
    assert clipped > 0.1


# --- readings that are late -------------------------------------------------------------------


def test_a_late_reading_of_an_exact_robot_says_where_it_is_now() -> None:
    rng, past = np.random.default_rng(2), ()
    for k in range(12):
        past = remember(past, ROBOT.home + k / 12 * ASKEW + 0.01 * rng.normal(size=9))
    then = past[-1 - 4]
    seen = observe(ROBOT, replace(measured(then), age=4 * DT), past, DT)
    np.testing.assert_allclose(seen.points, ROBOT.points(past[-1]), atol=ROUNDING)
    halfway = 0.5 * (past[-3] + past[-4])
    seen = observe(ROBOT, replace(measured(halfway), age=2.5 * DT), past, DT)
    np.testing.assert_allclose(seen.tip, ROBOT.tip(past[-1]), atol=ROUNDING)


def test_a_coil_beyond_the_tip_is_not_taken_for_the_tip() -> None:
    c, coil = ROBOT.home + ASKEW, np.array([0.0, 0.0, 0.010])
    place = ROBOT.tip_pose(c) @ np.append(coil, 1.0)
    reading = Measurement(tip=place[:3], lengths=ROBOT.lengths(c), coil=coil)
    seen = observe(ROBOT, reading, (c,), DT)
    np.testing.assert_allclose(seen.tip, ROBOT.tip(c), atol=ROUNDING)
    assert not seen.has_shape


def test_a_delay_that_is_known_does_no_harm_and_one_that_is_not_does() -> None:
    """Readings a fifth of a second old, and a gain that such a delay makes unstable."""

    def spread(age: float) -> float:
        controller = HierarchicalController(
            MPC, local=LocalController(tip_gain=25.0), offset_free=PLAN_ONLY
        )
        plant, state, late = (
            Leaning(ROBOT, seed=0),
            controller.init(ROBOT.home),
            list[Measurement](),
        )
        tips = list[Array]()
        for k in range(400):
            told = None if k < 6 else replace(late[-6], age=age, lengths=late[-1].lengths)
            state, command = controller.step(state, TARGET, told)
            late.append(plant.step(command.rates, DT))
            tips.append(late[-1].tip)
        return float(np.max(np.ptp(np.array(tips[-100:]), axis=0)))

    assert spread(5 * DT) < ARRIVED
    assert spread(0.0) > 1e-3


# --- faults -----------------------------------------------------------------------------------


@pytest.mark.parametrize("what", ["tip", "lengths", "points", "age"])
def test_a_measurement_that_is_not_finite_holds_the_robot_still(what: str) -> None:
    controller = HierarchicalController(MPC)
    state = controller.init(ROBOT.home)
    for _ in range(5):
        state, _ = controller.step(state, TARGET, measured(state.c))
    good = measured(state.c)
    bad = np.nan if what == "age" else np.full_like(getattr(good, what), np.nan)
    after, command = controller.step(state, TARGET, replace(good, **{what: bad}))
    assert command.report.status is Status.HOLDING
    assert "not finite" in command.report.reason
    assert not np.any(command.rates)
    assert np.array_equal(after.c, state.c)
    after, command = controller.step(after, TARGET, good)  # and goes on when it is
    assert command.report.status is Status.TRACKING


@pytest.mark.parametrize("what", ["tip", "lengths", "points"])
@pytest.mark.parametrize("size", [1e30, 1e160, 1e300])
def test_a_measurement_beyond_all_reason_moves_nothing_that_is_not_finite(
    what: str, size: float
) -> None:
    controller = HierarchicalController(MPC, offset_free=OffsetFree(when=When.ALWAYS))
    state = controller.init(ROBOT.home)
    good = measured(state.c)
    state, _ = controller.step(state, TARGET, good)
    mad = replace(good, **{what: np.full_like(getattr(good, what), size)})
    after, command = controller.step(state, TARGET, mad)
    slowest, fastest = ROBOT.rate_limits.T
    assert np.all((command.rates >= slowest - ROUNDING) & (command.rates <= fastest + ROUNDING))
    assert np.all(np.isfinite(after.offset))
    after, command = controller.step(after, TARGET, good)
    assert command.report.status is Status.TRACKING


@pytest.mark.parametrize("target", [[0.05, 0.0], [0.05, 0.0, 0.16, 0.0], [np.nan, 0.0, 0.16]])
def test_a_target_that_is_no_place_holds_the_plan_still(target: list[float]) -> None:
    controller = HierarchicalController(MPC)
    state = controller.init(ROBOT.home)
    after, command = controller.step(state, target, measured(state.c))
    assert command.report.status is Status.HOLDING
    assert "three finite numbers" in command.report.reason
    assert np.array_equal(after.c, state.c)
