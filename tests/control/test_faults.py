"""What the controller does when something fails: it holds still and says why."""

import numpy as np
import pytest

from sinuous.control import plan, qp
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.report import Status
from sinuous.control.safety import SafetyFilter
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone

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
        broken.setattr(qp, "_daqp", lambda problem: (problem.f, problem.lower, -4))
        held, command = mpc.step(state, scene.axis[12])
    assert command.report.status is Status.HOLDING
    assert command.report.reason == "the QP solver reached its iteration limit"
    assert np.all(command.rates == 0.0)
    assert np.array_equal(held.c, state.c)
    _, command = mpc.step(held, scene.axis[12])
    assert command.report.status is Status.TRACKING


def test_a_solution_that_is_not_finite_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    monkeypatch.setattr(
        qp, "_daqp", lambda problem: (problem.f * np.nan, problem.lower, qp.OPTIMAL[0])
    )
    _, command = mpc.step(mpc.init(START), scene.axis[12])
    assert command.report.status is Status.HOLDING
    assert np.all(command.rates == 0.0)


def test_linear_algebra_that_fails_holds_still(monkeypatch: pytest.MonkeyPatch) -> None:
    scene = bent_tube()
    mpc = scene.mpc()

    def singular(*_: object) -> None:
        raise np.linalg.LinAlgError("singular matrix")

    monkeypatch.setattr("sinuous.control.mpc.make_plan", singular)
    _, command = mpc.step(mpc.init(START), scene.axis[12])
    assert command.report.status is Status.HOLDING
    assert "singular matrix" in command.report.reason


def test_a_plan_through_the_wall_is_cut_short(monkeypatch: pytest.MonkeyPatch) -> None:
    # Whatever the planner does, the filter alone keeps the margin.
    monkeypatch.setattr(plan, "ROUNDS", 1)
    scene = bent_tube()
    mpc = scene.mpc()
    safety = SafetyFilter(shape=mpc.terms.shape, limits=(), dt=mpc.dt)
    bent = np.array([0.0, 0.6, 0.055, 0.0, 0.0, 0.055, 0.0, 0.0, 0.055])
    end, share = safety.accept(mpc.stage(START), mpc.stage(bent))
    assert 0.0 < share < 1.0
    assert mpc.walls.slack(end).min() >= 0.0


def test_a_short_way_through_a_thin_wall_is_seen() -> None:
    # Both ends are clear, the middle is not: only the check on the way finds it.
    robot = robot_at(0.0)
    c, other = START.copy(), START.copy()
    c[3], other[3] = -0.35, 0.35
    middle = robot.points(START)[-1]
    room = SafeZone.from_mesh(shapes.box([0.4, 0.4, 0.4]))
    needle = shapes.capsule(middle + [0.0, -0.05, 0.0], middle + [0.0, 0.05, 0.0], 0.0005)
    mpc = ShapeConstrainedMPC(robot, room.minus(needle, name="needle"), margin=0.001)
    start, goal = mpc.stage(c), mpc.stage(other)
    assert mpc.walls.slack(start).min() > 0.0
    assert mpc.walls.slack(goal).min() > 0.0
    end, share = SafetyFilter(shape=mpc.terms.shape, limits=(), dt=mpc.dt).accept(start, goal)
    assert share < 0.5
    assert mpc.walls.slack(end).min() >= 0.0


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
    mpc = ShapeConstrainedMPC(robot, SafeZone.from_mesh(room), margin=0.001)
    start, goal = mpc.stage(c), mpc.stage(other)
    assert min(mpc.walls.slack(start).min(), mpc.walls.slack(goal).min()) > 0.0
    end, share = SafetyFilter(shape=mpc.terms.shape, limits=(), dt=mpc.dt).accept(start, goal)
    assert share < 0.5
    assert mpc.walls.slack(end).min() >= 0.0


@pytest.mark.parametrize(
    ("field", "value"),
    [("margin", -1e-3), ("margin", np.nan), ("dt", 0.0), ("dt", np.inf), ("horizon", 0),
     ("tip_speed", 0.0), ("tip_speed", np.nan)],
)  # fmt: skip
def test_settings_that_make_no_sense_are_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        ShapeConstrainedMPC(robot_at(0.0), SafeZone.unbounded(), **{field: value})
