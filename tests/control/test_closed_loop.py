"""Closed loops: walls, limits, targets out of reach, recovery, rest."""

import numpy as np
import pytest

from sinuous.control.mpc import Costs, ShapeConstrainedMPC
from sinuous.control.report import Status
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone

from .loops import Judged, assert_limits_kept, drive
from .scenes import MARGIN, START, Scene, bent_tube, bumpy_tube, robot_at

STEADY = 1e-5  # steady tip error a reachable target may leave [m]: the figure
JITTER = 1e-4  # movement at rest that would be felt as jitter [m]
RESTING = 30  # steps for which a robot at rest is watched


@pytest.mark.parametrize("seed", range(10))
def test_no_step_in_a_random_tube_touches_the_margin(seed: int) -> None:
    rng = np.random.default_rng(seed)
    scene = bumpy_tube(rng)
    mpc = scene.mpc()
    deep = scene.axis[rng.integers(len(scene.axis) // 2, len(scene.axis))]
    side = rng.normal(size=3)
    targets = [deep + rng.normal(0.0, 0.008, 3), deep + 0.04 * side / np.linalg.norm(side)]
    state, judged = drive(mpc, mpc.init(START), targets)
    _, resting = drive(mpc, state, targets[-1:] * RESTING, steps=1)
    for part in (judged, resting):
        assert part.worst_margin >= 0.0
        assert part.holds == 0
        assert_limits_kept(part)
    assert jitter(resting) < JITTER


@pytest.mark.parametrize("horizon", [1, 2, 20])
def test_every_horizon_keeps_the_margin(horizon: int) -> None:
    scene = bent_tube()
    mpc = scene.mpc(horizon)
    _, judged = drive(mpc, mpc.init(START), [scene.axis[20], scene.axis[-1]], steps=60)
    assert judged.worst_margin >= 0.0
    assert judged.holds == 0
    assert_limits_kept(judged)


def test_targets_that_jump_every_step_cannot_break_the_margin() -> None:
    scene, rng = bent_tube(), np.random.default_rng(7)
    mpc = scene.mpc(2)
    targets = scene.axis[rng.integers(5, len(scene.axis), 120)] + rng.normal(0.0, 0.03, (120, 3))
    _, judged = drive(mpc, mpc.init(START), list(targets), steps=1)
    assert judged.worst_margin >= 0.0
    assert judged.holds == 0
    assert_limits_kept(judged)


def test_reachable_targets_are_reached_where_walls_press_and_where_they_do_not() -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    state, walls = mpc.init(START), 0
    for target in (scene.axis[12], scene.axis[20] + [-0.004, 0.003, 0.0], scene.axis[24]):
        state, judged = drive(mpc, state, [target])
        last = judged.commands[-1].report
        assert last.status is Status.AT_TARGET
        assert np.linalg.norm(last.points[-1] - target) < STEADY
        walls += any(active.triangle >= 0 for active in last.active)
    assert walls > 0  # at least one of them is reached leaning on a wall


def test_a_tip_speed_limit_is_exact() -> None:
    scene, limit = bent_tube(), 0.03
    mpc = ShapeConstrainedMPC(scene.robot, scene.zone, margin=MARGIN, tip_speed=limit)
    state = mpc.init(START)
    tips = [scene.robot.tip(state.c)]
    for _ in range(60):
        state, _ = mpc.step(state, scene.axis[20])
        tips.append(scene.robot.tip(state.c))
    speeds = np.linalg.norm(np.diff(tips, axis=0), axis=1) / mpc.dt
    assert speeds.max() <= limit
    assert speeds.max() > 0.9 * limit  # and it is used


def test_an_unreachable_target_is_waited_for_at_the_margin() -> None:
    scene = bent_tube()
    mpc = scene.mpc()
    out = np.array([-0.5, 0.6, 0.62])
    target = scene.axis[27] + 0.04 * out / np.linalg.norm(out)
    state, _ = drive(mpc, mpc.init(START), [target])
    _, judged = drive(mpc, state, [target] * RESTING, steps=1)
    last = judged.commands[-1].report
    assert last.status is Status.BLOCKED
    assert last.active[0].triangle >= 0
    assert 0.0 <= judged.worst_margin
    assert MARGIN <= last.clearance <= MARGIN + 3e-4  # at the margin, not short of it
    assert jitter(judged) < JITTER


def jitter(judged: Judged) -> float:
    """Largest change of the body's movement from one step to the next [m]; drift has none."""
    points = np.array([command.report.points for command in judged.commands])
    return float(np.linalg.norm(np.diff(points, n=2, axis=0), axis=2).max())


def outside(scene: Scene, depth: float) -> np.ndarray:
    """A configuration bent until its body is `depth` beyond where it may be [m]."""
    mpc = scene.mpc()
    for bend in np.linspace(0.0, 0.6, 2000):
        c = np.array([0.0, bend, 0.055, 0.0, 0.0, 0.055, 0.0, 0.0, 0.055])
        if mpc.walls.slack(mpc.stage(c)).min() < -depth:
            return c
    raise AssertionError("the scene has room for every bend")


@pytest.mark.parametrize(
    ("depth", "rounds"),
    [(0.002, 30), (MARGIN + 0.008 + 0.002, 90)],
    ids=["2 mm inside the margin", "centre line 2 mm outside the mesh"],
)
def test_a_bad_start_is_left_without_breaking_a_limit(depth: float, rounds: int) -> None:
    scene = bent_tube("hardware")  # slow enough for the way back to take several steps
    mpc = scene.mpc()
    start = outside(scene, depth)
    state, judged, worst = mpc.init(start), Judged(), -np.inf
    for step in range(rounds):
        slack = mpc.walls.slack(mpc.stage(state.c)).min()
        assert slack >= worst - 1e-12 or slack >= 0.0  # never worse than before
        worst = slack
        state, judged = drive(mpc, state, [scene.axis[10]], steps=1, judged=judged)
        if step == 0:
            assert judged.commands[0].report.status is Status.RECOVERING
    assert mpc.walls.slack(mpc.stage(state.c)).min() >= 0.0
    assert judged.commands[-1].report.status is not Status.RECOVERING
    assert judged.holds == 0
    assert judged.worst_rate <= 1.0 + 1e-12


def test_a_spike_between_two_disks_is_not_touched() -> None:
    robot = robot_at(-0.03)
    room = SafeZone.from_mesh(shapes.box([0.2, 0.2, 0.3], centre=[0.0, 0.0, 0.149]),
                              entrance=[0.0, 0.0, -0.001])  # fmt: skip
    disks = robot.points(START)[robot.disk_indices]
    between = 0.5 * (disks[14] + disks[15])
    tip = between + [0.0125, 0.0, 0.0]  # 0.5 mm short of the margin plus the body radius... away
    zone = room.minus(shapes.spike(tip + [0.06, 0.0, 0.0], tip, 0.002), name="spike")
    mpc = ShapeConstrainedMPC(robot, zone, margin=MARGIN)
    lean = robot.tip(START) + [0.03, 0.0, 0.01]  # pulls the body against the spike
    _, judged = drive(mpc, mpc.init(START), [lean, lean + [0.0, 0.02, 0.0]], steps=150)
    assert judged.worst_margin >= 0.0
    assert any(a.triangle >= 0 for c in judged.commands for a in c.report.active)


def test_guarding_disks_only_lets_the_spike_in() -> None:
    # The other side of the coverage rule (notes B7): nine millimetres between guarded points,
    # and the distance they keep without the allowance for what lies between them.
    robot = robot_at(-0.03)
    disks = robot.points(START)[robot.disk_indices]
    spacing = float(np.linalg.norm(disks[15] - disks[14]))
    required = 0.008 + MARGIN
    between = np.sqrt(required**2 - (spacing / 2) ** 2)  # spike that both disks just tolerate
    assert required - between > 1e-4
    allowed = robot.required_distance(MARGIN)[robot.disk_indices]
    assert np.all(allowed > required)


def test_the_default_cost_has_no_steady_error_and_the_printed_one_has() -> None:
    robot = robot_at(0.0)
    target = np.array([0.05, 0.0, 0.16])
    errors = {}
    for name, costs in (("default", Costs()), ("printed", Costs.printed())):
        mpc = ShapeConstrainedMPC(robot, SafeZone.unbounded(), costs=costs)
        state, _ = drive(mpc, mpc.init(robot.home), [target], steps=600)
        errors[name] = float(np.linalg.norm(robot.tip(state.c) - target))
    assert errors["default"] < STEADY
    assert errors["printed"] > 1e-3
