"""What the controller does when something fails: it holds still and says why."""

import pickle
import threading

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.report import Status
from sinuous.control.step import interior, plan
from sinuous.control.step.plan import Solved
from sinuous.control.terms import Costs, Quadratic, TipError
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot

from .scenes import START, bent_tube, robot_at


@pytest.mark.parametrize("target", [[np.nan, 0.0, 0.1], [np.inf, 0.0, 0.1], [0.0, 0.1]])
def test_a_target_that_is_no_point_is_not_followed(target: list[float]) -> None:
    mpc = bent_tube().mpc()
    state = mpc.init(START)
    after, command = mpc.step(state, target)
    assert command.report.status is Status.HOLDING
    assert "target" in command.report.reason
    assert np.array_equal(after.c, state.c)
    assert np.all(command.rates == 0.0)


def test_a_failed_solve_holds_still_and_the_next_step_goes_on(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    state, _ = mpc.step(mpc.init(START), scene.axis[12])
    with monkeypatch.context() as broken:
        failed = Solved(interior.UNFINISHED, 0, 40, 60, 60, 0, True)
        broken.setattr(plan, "solve", lambda *_: failed)
        held, command = mpc.step(state, scene.axis[12])
    assert command.report.status is Status.HOLDING
    assert command.report.reason == "the QP solver reached its iteration limit"
    assert np.all(command.rates == 0.0)
    assert np.array_equal(held.c, state.c)
    assert command.report.clearance > 0.0
    assert command.report.active == ()
    _, command = mpc.step(held, scene.axis[12])
    assert command.report.status is Status.TRACKING


class Spoilt:
    """A cost that is not a number."""

    def __init__(self, value: float) -> None:
        self.value = value

    def quadratic(self, robot: Robot, c: Array, target: Array) -> Quadratic:
        n = len(c)
        return Quadratic(hessian=np.full((n, n), self.value), gradient=np.full(n, self.value))


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_numbers_that_are_not_finite_are_refused(value: float) -> None:
    scene = bent_tube()
    costs = Costs(state=(TipError(weight=1e5), Spoilt(value)))
    mpc = ShapeConstrainedMPC(scene.robot, scene.zone, margin=0.002, costs=costs)
    state = mpc.init(START)
    after, command = mpc.step(state, scene.axis[12])
    assert command.report.status is Status.HOLDING
    assert command.report.reason == "the QP is not finite"
    assert np.all(command.rates == 0.0)
    assert np.array_equal(after.c, state.c)


def test_a_start_of_another_robot_is_refused() -> None:
    with pytest.raises(ValueError, match="9 coordinates"):
        bent_tube().mpc().init(START[:6])


def test_a_state_that_is_not_finite_holds_still() -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    _, command = mpc.step(mpc.init(START * np.nan), scene.axis[12])
    assert command.report.status is Status.HOLDING
    assert np.all(command.rates == 0.0)


def test_a_goal_in_the_wall_is_cut_short() -> None:
    # Whatever the planner does, the filter alone keeps the margin.
    mpc = bent_tube().mpc()
    bent = np.array([0.0, 0.2, 0.047, 0.0, 0.0, 0.047, 0.0, 0.0, 0.047])
    slow = ShapeConstrainedMPC(mpc.robot, mpc.zone, margin=mpc.margin, dt=10.0)
    assert mpc.slack(bent).min() < 0.0
    end, share = slow.accept(START, bent)
    assert 0.0 < share < 1.0
    assert mpc.slack(end).min() >= 0.0


def test_a_controller_and_its_state_can_be_sent_to_another_process() -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    state, _ = mpc.step(mpc.init(START), scene.axis[12])
    other, there = pickle.loads(pickle.dumps((mpc, state)))
    here, _ = mpc.step(state, scene.axis[12])
    again, _ = other.step(there, scene.axis[12])
    np.testing.assert_array_equal(here.c, again.c)


def test_two_threads_may_use_one_controller() -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    targets = [scene.axis[12], scene.axis[20]]

    def drive(target: Array) -> Array:
        state = mpc.init(START)
        for _ in range(40):
            state, _ = mpc.step(state, target)
        return state.c

    alone = [drive(target) for target in targets]
    together: list[Array] = [START, START]

    def run(k: int) -> None:
        together[k] = drive(targets[k])

    threads = [threading.Thread(target=run, args=(k,)) for k in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(np.array_equal(a, b) for a, b in zip(alone, together, strict=True))


def test_a_short_way_through_a_thin_wall_is_seen() -> None:
    # Both ends are clear, the middle is not: only the check on the way finds it.
    robot = robot_at(0.0)
    c, other = START.copy(), START.copy()
    c[3], other[3] = -0.35, 0.35
    middle = robot.points(START)[-1]
    room = SafeZone.from_mesh(shapes.box([0.4, 0.4, 0.4]))
    needle = shapes.capsule(middle + [0.0, -0.05, 0.0], middle + [0.0, 0.05, 0.0], 0.0005)
    mpc = ShapeConstrainedMPC(robot, room.minus(needle, name="needle"), margin=0.001, dt=10.0)
    assert mpc.slack(c).min() > 0.0
    assert mpc.slack(other).min() > 0.0
    end, share = mpc.accept(c, other)
    assert share < 0.5
    assert mpc.slack(end).min() >= 0.0


def test_a_point_that_goes_out_and_back_is_seen() -> None:
    # Mirrored S-shapes have the same tip, and it stretches forward between them.
    robot = robot_at(0.0)
    c = np.array([0.5, 0.0, 0.065, -1.0, 0.0, 0.065, 0.5, 0.0, 0.065])
    other = c * np.array([-1.0, 1.0, 1.0] * 3)
    stretched = robot.tip(0.5 * (c + other))[2]
    assert np.linalg.norm(robot.tip(c) - robot.tip(other)) < 1e-3
    height = 0.5 * (robot.tip(c)[2] + stretched) + 0.008 + 0.001
    assert stretched - robot.tip(c)[2] > 2e-3
    room = shapes.box([0.3, 0.3, height + 0.1], centre=[0.0, 0.0, (height - 0.1) / 2])
    mpc = ShapeConstrainedMPC(robot, SafeZone.from_mesh(room), margin=0.001, dt=10.0)
    assert min(mpc.slack(c).min(), mpc.slack(other).min()) > 0.0
    end, share = mpc.accept(c, other)
    assert share < 0.5
    assert mpc.slack(end).min() >= 0.0


@pytest.mark.parametrize(
    ("field", "value"),
    [("margin", -1e-3), ("margin", np.nan), ("dt", 0.0), ("dt", np.inf), ("horizon", 0),
     ("tip_speed", 0.0), ("tip_speed", np.nan), ("budget", 0.0), ("budget", np.nan)],
)  # fmt: skip
def test_settings_that_make_no_sense_are_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        ShapeConstrainedMPC(robot_at(0.0), SafeZone.unbounded(), **{field: value})
