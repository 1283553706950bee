"""`sinuous bench ik`."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.bench.ik_drive import IKAnswers, ask, joint_motion, judge, smoothness
from sinuous.bench.ik_peers import task
from sinuous.bench.ik_peers.heuristics import HEURISTICS
from sinuous.bench.ik_peers.least_squares import LEAST_SQUARES, pseudo_inverse
from sinuous.bench.ik_peers.ours import OURS, called_from_python
from sinuous.bench.ik_peers.solver import TOLERANCE, IKSolver
from sinuous.bench.ik_tasks import STEP, draw_tasks
from sinuous.compiled import kernel
from sinuous.control.geometric_ik import CHI, GeometricIK
from sinuous.control.geometric_ik_kernels import Arm
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.parts import JointOrder
from sinuous.robots.robot_file import load_jointed

QIN = load_jointed("qin2020")
ALTERNATE = replace(QIN, orders=(JointOrder.ZX, JointOrder.XZ) * 2 + (JointOrder.ZX,))
PEERS = (*LEAST_SQUARES, *HEURISTICS)
STEP_RAD = 1e-6  # of central differences: truncation 1e-12, rounding 1e-10
DIFFERENCE = 1e-9  # [m/rad]
EXACT = 1e-12

every_peer = pytest.mark.parametrize("solver", PEERS, ids=lambda solver: solver.name)


def test_every_solver_is_measured_and_drawn(bench: Callable[[str], dict[str, Any]]) -> None:
    found = bench("ik")
    assert found["figures"] == ["ik.png"]
    names = [OURS.name, "from Python", *(peer.name for peer in PEERS)]
    assert [row["solver"] for row in found["targets"]] == names
    ours = found["targets"][0]
    assert ours["solved"] == 1.0
    assert ours["tip_error_max_um"] < 1e-6
    for row in found["targets"]:
        assert 0.0 < row["median_us"] <= row["p99_us"] <= row["max_us"]
        assert row["tip_error_max_um"] <= 1e6 * TOLERANCE * 1.001
    starts = {(row["solver"], row["start"]) for row in found["paths"]}
    assert starts >= {
        (p.name, start) for p in PEERS for start in ("reference pose", "last solution")
    }
    ratio = found["ratios"][0]
    assert (ratio["peer"], ratio["task"]) == ("DLS", "targets")
    assert ratio["median"] == pytest.approx(found["targets"][2]["median_us"] / ours["median_us"])
    assert {row["cables"] for row in found["following"]} == {"simulation", "hardware"}
    for row in found["following"]:
        assert row["load_at_switch_median"] is None or row["lag_max_mm"] >= row["lag_rms_mm"]


@every_peer
@pytest.mark.parametrize("robot", [QIN, ALTERNATE])
def test_peers_reach_what_they_say_they_reach(solver: IKSolver, robot: JointedRobot) -> None:
    """With the last tube parallel to y, by the robot's own kinematics, cold and warm."""
    ik = GeometricIK(robot)
    tasks = draw_tasks(ik, quick=True)
    path = tasks.paths[0]
    for targets, warm in ((tasks.targets, False), (path, True)):
        found = judge(ik, ask(solver, ik, targets, tasks.start, warm=warm))
        least = 0.7 if solver.name == "CCD" else 0.9  # it is slow where the chain is straight
        assert float(str(found["solved"])) >= least


@every_peer
def test_peers_stay_where_they_are_if_that_is_the_target(solver: IKSolver) -> None:
    ik = GeometricIK(QIN)
    start = ik.solve_one(ik.on_plane([0.03, 0.05], CHI)).c
    c = np.empty_like(start)
    assert solver.solve(ik.arm, QIN.tip(start), start, c, 1) == 0
    np.testing.assert_allclose(c, start, atol=1e-9)


def test_ours_is_the_geometric_solution_whatever_it_starts_from() -> None:
    ik = GeometricIK(QIN)
    for target in draw_tasks(ik, quick=True).targets:
        expected, start = ik.solve_one(target).c, np.full(10, np.nan)
        for solver in (OURS, called_from_python(ik)):
            c = np.empty(10)
            solver.solve(ik.arm, target, start, c, 3)
            np.testing.assert_array_equal(c, expected)


@kernel
def residual(arm: Arm, target: Array, c: Array, whole: bool) -> task.Scratch:
    scratch = task.new_scratch(arm, whole)
    frame = task.forward(arm, c, scratch.axes.shape[0], scratch.p, scratch.axes)
    task.left_to_do(arm, task.goal_of(arm, target, scratch), frame, scratch)
    task.differentiate(arm, frame, scratch)
    return scratch


@pytest.mark.parametrize("whole", [False, True])
@pytest.mark.parametrize("robot", [QIN, ALTERNATE])
def test_jacobians_are_derivatives(robot: JointedRobot, whole: bool) -> None:
    ik, rng = GeometricIK(robot), np.random.default_rng(0)
    target = ik.on_plane([0.02, 0.03], CHI)
    for _ in range(5):
        c = rng.uniform(-0.5, 0.5, 10)
        found = residual(ik.arm, target, c, whole)
        assert found.J.shape == ((5, 10) if whole else (3, 8))
        for i in range(found.J.shape[1]):
            ahead, behind = (
                residual(ik.arm, target, c + sign * STEP_RAD * np.eye(10)[i], whole).e
                for sign in (1.0, -1.0)
            )
            slope = (ahead - behind) / (2.0 * STEP_RAD)
            np.testing.assert_allclose(found.J[:, i], -slope, atol=DIFFERENCE)
        np.testing.assert_allclose(found.W, found.J @ found.J.T, atol=EXACT)
        if whole:
            np.testing.assert_allclose(target - found.e[:3], robot.tip(c), atol=EXACT)


@kernel
def pinv_step(scratch: task.Scratch) -> None:
    pseudo_inverse(scratch)


def test_newtons_step_is_that_of_the_pseudo_inverse() -> None:
    ik, rng = GeometricIK(QIN), np.random.default_rng(1)
    target = ik.on_plane([0.02, 0.03], CHI)
    for c in (rng.uniform(-0.5, 0.5, 10), ik.reference(CHI)):  # the second is singular
        scratch = residual(ik.arm, target, c, True)
        J, e = scratch.J.copy(), scratch.e.copy()
        pinv_step(scratch)
        np.testing.assert_allclose(J.T @ scratch.f, np.linalg.pinv(J, rcond=1e-5) @ e, atol=1e-9)


def test_motion_is_by_the_way_and_does_not_cross_from_path_to_path() -> None:
    targets = np.array([[0.0, 0.0, 0.0], [STEP, 0.0, 0.0]])
    one = IKAnswers(
        targets=targets, c=np.array([[0.0, 0.0], [0.003, -0.004]]), time=np.zeros(2),
        iterations=np.zeros(2, dtype=np.int64), follows=np.array([False, True]),
    )  # fmt: skip
    both = IKAnswers.joined([one, replace(one, targets=targets + 1.0, c=one.c + 1.0)])
    np.testing.assert_allclose(joint_motion(both), [[3.0, -4.0], [3.0, -4.0]])
    assert smoothness(both) == {
        "motion_rms_rad_mm": pytest.approx(0.005),
        "motion_max_rad_mm": pytest.approx(0.004),
    }
