"""Geometric inverse kinematics with a PID for every cable, around a plant and without one."""

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.cable_loop import CableLoop
from sinuous.control.geometric_ik import CHI, GeometricIK
from sinuous.control.pid import Pid
from sinuous.control.report import Status
from sinuous.control.transmission import Transmission
from sinuous.measurement import Measurement
from sinuous.plants.kinematic import KinematicPlant
from sinuous.robots.bending import bends
from sinuous.robots.robot_file import load_jointed

ROBOT = load_jointed("qin2020")
IK = GeometricIK(ROBOT)
LOOP = CableLoop(IK)
START, GOAL = IK.on_plane([[0.0, 0.15], [0.05, 0.14]], CHI)
CLOSE = 5e-4  # what the integral leaves of the way after 8 s [m]
ENCODER = 1e-6  # [m]


def follow(loop: CableLoop, targets: Array, encoder_step: float = ENCODER) -> list[Measurement]:
    """What is measured while the targets (K, 3) are followed from the pose of the first."""
    start = IK.solve_one(targets[0]).c
    plant = KinematicPlant(ROBOT, seed=0, start=start, encoder_step=encoder_step)
    state, measured, seen = loop.init(start), None, list[Measurement]()
    for target in targets:
        state, command = loop.step(state, target, measured)
        measured = plant.step(command.rates, loop.dt)
        seen.append(measured)
    return seen


def test_a_target_is_reached_and_cables_keep_their_limits() -> None:
    seen = follow(LOOP, np.concatenate([START[None], np.tile(GOAL, (8000, 1))]))
    assert np.linalg.norm(seen[-1].tip - GOAL) < CLOSE
    rates = np.diff([one.lengths for one in seen], axis=0) / LOOP.dt
    assert np.max(np.abs(rates)) <= ROBOT.rate_limits[0, 1] + 2 * ENCODER / LOOP.dt


def test_a_slow_motor_limits_the_cables() -> None:
    slow = Transmission(lead=0.001, ratio=1.0, speed=2.0 * np.pi * 5.0)  # 5 mm/s
    loop = CableLoop(IK, transmission=slow, pid=Pid(proportional=50.0))
    state = loop.init(IK.solve_one(START).c)
    fastest, clipped = 0.0, 0.0
    for _ in range(200):
        state, command = loop.step(state, GOAL)
        fastest = max(fastest, float(np.max(np.abs(command.rates))))
        clipped = max(clipped, command.clipped)
    assert fastest == pytest.approx(0.005)
    assert clipped > 0.5


def test_without_a_measurement_the_cables_are_taken_to_move_as_told() -> None:
    state = LOOP.init(IK.solve_one(START).c)
    for _ in range(8000):
        state, command = LOOP.step(state, GOAL)
    assert np.linalg.norm(ROBOT.tip(state.c) - GOAL) < CLOSE
    np.testing.assert_allclose(command.report.points, ROBOT.points(state.c))


def test_a_target_out_of_reach_is_answered_with_the_nearest() -> None:
    far = IK.on_plane([0.3, 0.0], CHI)
    seen = follow(LOOP, np.tile(far, (10, 1)))
    nearest = IK.solve_one(far).target
    assert np.linalg.norm(seen[-1].tip - nearest) < CLOSE
    state = LOOP.init(IK.solve_one(far).c)
    _, command = LOOP.step(state, far)
    assert command.report.status is Status.BLOCKED


def test_joints_are_not_bent_beyond_their_limit() -> None:
    """At the disc's centre the arm would have to fold by 2 chi, more than the plates allow."""
    centre = IK.on_plane([0.0, 0.0], CHI)
    assert IK.solve_one(centre).bend > ROBOT.bend_limit
    way = IK.on_plane(np.linspace([0.0, 0.15], [0.0, 0.0], 3000), CHI)
    state = LOOP.init(IK.solve_one(way[0]).c)
    for target in way:
        state, _ = LOOP.step(state, target)
        assert np.max(bends(ROBOT.bend_limits, state.desired)) <= ROBOT.bend_limit + 1e-9


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_what_is_not_finite_holds_the_cables_still(bad: float) -> None:
    state = LOOP.init(IK.solve_one(START).c)
    after, command = LOOP.step(state, [0.0, bad, 0.0])
    assert command.report.status is Status.HOLDING
    assert "target" in command.report.reason
    assert after is state
    np.testing.assert_array_equal(command.rates, 0.0)
    lengths = ROBOT.lengths(state.c)
    lengths[3] = bad
    seen = Measurement(tip=START, lengths=lengths)
    after, command = LOOP.step(state, GOAL, seen)
    assert command.report.status is Status.HOLDING
    assert "measurement" in command.report.reason
    np.testing.assert_array_equal(command.rates, 0.0)


def test_a_bad_period_and_a_bad_start_are_refused() -> None:
    with pytest.raises(ValueError, match="dt must be"):
        CableLoop(IK, dt=0.0)
    with pytest.raises(ValueError, match="10 coordinates"):
        LOOP.init(np.zeros(3))
