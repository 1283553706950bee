"""The device (27) and the models of who holds it."""

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.teleop.leader import LeaderDevice, Load
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import Felt, ImpedanceOperator, Operator, Prescribed

from .rigs import C1, C2, DELAY, DT, LAG, STILL, Run, rig, run, to_and_hold, wave_about

NONE = np.zeros(2)
FREE = Load(NONE, NONE)
ROUNDING = 1e-13  # [m], of thousands of additions of a tick's motion
DEVICE = LeaderDevice(mass=0.1)


def alone(
    operator: Operator[object], device: LeaderDevice, ticks: int, F_m: Array = NONE
) -> tuple[Array, Array, Array]:
    """x, v (K, 2) and F_h (K, 2) of a device that nothing is fed back to but F_m."""
    x, v, state = np.zeros(2), np.zeros(2), operator.init(np.zeros(2))
    xs, vs, Fs = list[Array](), list[Array](), list[Array]()
    for k in range(ticks):
        load = Load(F_m, NONE)
        state, F_h = operator.step(state, Felt(k * DT, x, v, load), device, DT)
        x, v = device.step(x, v, F_h, load, DT)
        xs.append(x)
        vs.append(v)
        Fs.append(F_h)
    return np.array(xs), np.array(vs), np.array(Fs)


def test_a_constant_force_gives_a_constant_acceleration() -> None:
    x, v = np.zeros(2), np.zeros(2)
    for _ in range(1000):
        x, v = DEVICE.step(x, v, np.array([0.3, 0.1]), Load(np.array([0.1, 0.3]), NONE), DT)
    np.testing.assert_allclose(v, [2.0, -2.0], rtol=1e-12)
    # The speed of the end of a tick is used for all of it: half a tick too far.
    np.testing.assert_allclose(x, [1.0 + DT, -1.0 - DT], rtol=1e-9)


def test_the_workspace_ends_at_the_limit_and_can_be_left() -> None:
    device, x, v = LeaderDevice(limit=0.05), np.array([0.0, 0.0]), np.zeros(2)
    push = np.array([1.0, -1.0])
    for _ in range(300):
        x, v = device.step(x, v, push, FREE, DT)
    np.testing.assert_array_equal(x, [0.05, -0.05])
    np.testing.assert_array_equal(v, [0.0, 0.0])
    x, v = device.step(x, v, -push, FREE, DT)
    assert x[0] < 0.05
    assert v[0] < 0.0


@pytest.mark.parametrize("damping", [0.1, 10.0, 1e6])
def test_a_damper_never_takes_more_than_the_motion_there_is(damping: float) -> None:
    """However heavy the damping, and at its speed of decay where the tick is short for it."""
    x, v, load = np.zeros(2), np.array([1.0, -2.0]), Load(NONE, np.full(2, damping))
    for _ in range(100):
        before = v
        x, v = DEVICE.step(x, v, NONE, load, DT)
        assert np.all(np.abs(v) <= np.abs(before))
        assert np.all(v * before >= 0.0)
    if damping == 0.1:
        np.testing.assert_allclose(v, np.exp(-0.1) * np.array([1.0, -2.0]), rtol=1e-4)


def test_a_prescribed_trajectory_is_followed_whatever_pushes() -> None:
    goal = wave_about()
    x, _, F_h = alone(Prescribed(goal), DEVICE, 3000, F_m=np.array([2.0, -7.0]))
    followed = np.array([goal((k + 1) * DT) - goal(0.0) for k in range(3000)])
    np.testing.assert_allclose(x, followed, rtol=0, atol=ROUNDING)
    assert np.mean(F_h[:, 1]) == pytest.approx(-7.0, abs=0.1)


def test_a_prescribed_trajectory_starts_where_the_device_is() -> None:
    """And not with a jump to where it is not."""
    teleop = rig(Prescribed(lambda t: np.array([5.0 + 0.01 * t, 0.0])))
    state = teleop.init(teleop.follower.mapping.place(np.array([0.1, 0.05])))
    for _ in range(1000):
        state, _ = teleop.step(state, teleop.follower.mapping.place(np.array([0.1, 0.05])))
    scale = teleop.leader.mapping.scale
    np.testing.assert_allclose(scale * state.leader.x, [0.1 + 0.0225, 0.05], atol=ROUNDING)


def test_the_impedance_operator_gives_way_like_its_spring() -> None:
    operator = ImpedanceOperator(lambda _: np.array([0.02, 0.0]))
    x, v, F_h = alone(operator, DEVICE, 3000, F_m=np.array([0.6, 0.0]))
    np.testing.assert_allclose(x[-1], [0.02 - 0.6 / 60.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(F_h[-1], [0.6, 0.0], atol=1e-7)
    np.testing.assert_allclose(v[-1], 0.0, atol=1e-8)


def test_a_damped_oscillator_is_first_order_in_the_tick() -> None:
    """m x'' + c x' + k x = k: against the closed solution, with half the tick."""
    errors = list[float]()
    mass, k, c, t = 0.1, 60.0, 0.5, 0.2
    decay, turn = c / (2 * mass), np.sqrt(k / mass - (c / (2 * mass)) ** 2)
    exact = 1.0 - np.exp(-decay * t) * (np.cos(turn * t) + decay / turn * np.sin(turn * t))
    for dt in (1e-3, 0.5e-3):
        operator = ImpedanceOperator(lambda _: np.ones(1), stiffness=k, damping=c)
        x, v = np.zeros(1), np.zeros(1)
        for i in range(round(t / dt)):
            load, device = Load(NONE[:1], NONE[:1]), LeaderDevice(mass=mass)
            _, F = operator.step(None, Felt(i * dt, x, v, load), device, dt)
            x, v = device.step(x, v, F, load, dt)
        errors.append(abs(float(x[0]) - exact))
    assert errors[1] == pytest.approx(0.5 * errors[0], rel=0.05)


STOPS = np.array([[0.06, 0.0], [0.06, 0.05], [0.0, 0.0]])


def waiting_run(patience: float) -> Run:
    operator = MoveAndWait(stops=STOPS, moving=1.0, patience=patience)
    return run(rig(operator, scheme=C2), 12.0)


def test_move_and_wait_visits_every_stop_and_stands_still_there() -> None:
    r = waiting_run(patience=0.6)
    still = np.all(np.abs(r.V) < STILL, axis=1)
    starts = np.flatnonzero(still[1:] & ~still[:-1])
    assert len(starts) == 3
    for stop, k in zip(STOPS, starts, strict=True):
        np.testing.assert_allclose(r.x[k + 1], stop, rtol=0, atol=ROUNDING)


def test_it_waits_until_the_force_has_come_back() -> None:
    """It sets out again with the force steady for its patience: then F_s is long at rest too."""
    r = waiting_run(patience=0.6)
    still = np.all(np.abs(r.V) < STILL, axis=1)
    leaves = np.flatnonzero(still[:-1] & ~still[1:])
    leaves = leaves[leaves > 1000]
    assert len(leaves) == 2
    for k in leaves:
        np.testing.assert_allclose(r.F_m[k], r.F_m[k - 600], atol=0.01)
        np.testing.assert_allclose(r.F_m[k], r.F_s[k], atol=0.02)
        # The force goes on changing after the stop for the way there and back at least.
        stopped = np.flatnonzero(~still[:k])[-1]
        assert (k - stopped) * DT > 2 * DELAY + LAG


def test_who_feels_no_change_waits_for_the_patience_only() -> None:
    operator = MoveAndWait(stops=STOPS, moving=0.5, patience=0.3)
    x, v, _ = alone(operator, DEVICE, 3000)
    still = np.flatnonzero(np.all(np.abs(v) < STILL, axis=1))
    assert still[0] * DT == pytest.approx(0.5, abs=2 * DT)
    np.testing.assert_allclose(x[-1], STOPS[-1], atol=ROUNDING)
    moving = np.any(np.abs(v) > STILL, axis=1)
    assert np.sum(moving) * DT == pytest.approx(1.5, abs=3 * DT)
    assert np.flatnonzero(moving)[-1] * DT == pytest.approx(2.1, abs=5 * DT)


def test_a_real_hand_is_moved_by_the_force_that_a_source_of_motion_withstands() -> None:
    goal = to_and_hold(np.array([0.09, 0.0]))
    stiff, soft = run(rig(Prescribed(goal), scheme=C1), 4.0), run(rig(ImpedanceOperator(goal)), 4.0)
    assert stiff.x[-1, 0] == pytest.approx(0.09)
    assert 0.07 < soft.x[-1, 0] < 0.0899


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: LeaderDevice(mass=0.0), "mass"),
        (lambda: LeaderDevice(limit=-1.0), "limit"),
        (lambda: LeaderDevice(limit=np.nan), "limit"),
        (lambda: ImpedanceOperator(wave_about(), stiffness=-1.0), "stiffness"),
        (lambda: ImpedanceOperator(wave_about(), damping=np.nan), "damping"),
        (lambda: MoveAndWait(stops=np.zeros((0, 2))), "stops"),
        (lambda: MoveAndWait(stops=np.zeros(2)), "stops"),
        (lambda: MoveAndWait(stops=STOPS, moving=0.0), "moving"),
        (lambda: MoveAndWait(stops=STOPS, patience=np.inf), "patience"),
        (lambda: MoveAndWait(stops=STOPS, tolerance=-1.0), "tolerance"),
        (lambda: MoveAndWait(stops=STOPS).init(np.zeros(3)), "stops must have 3 axes"),
    ],
)
def test_numbers_that_make_no_sense(make: object, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        make()  # type: ignore[operator]


@pytest.mark.parametrize("operator", [Prescribed, ImpedanceOperator])
def test_a_goal_has_the_device_s_axes(operator: type[Prescribed]) -> None:
    teleop = rig(operator(lambda t: np.zeros(3)))
    with pytest.raises(ValueError, match="goal must have 2 axes"):
        teleop.step(teleop.init([0.0, 0.6, 0.0]), [0.0, 0.6, 0.0])
