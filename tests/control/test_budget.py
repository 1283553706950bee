"""A step whose time is limited: safe whatever the limit, and no different where it is ample."""

import numpy as np
import pytest

from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.report import Status

from .loops import assert_limits_kept, drive
from .scenes import MARGIN, START, Scene, bent_tube

AMPLE = 10.0  # [s]


def limited(scene: Scene, budget: float | None) -> ShapeConstrainedMPC:
    return ShapeConstrainedMPC(scene.robot, scene.zone, margin=MARGIN, horizon=2, budget=budget)


@pytest.mark.parametrize("budget", [1e-9, 5e-5, 1e-4, 3e-4])
def test_no_budget_is_too_small_to_be_safe(budget: float) -> None:
    scene, rng = bent_tube(), np.random.default_rng(5)
    targets = scene.axis[rng.integers(5, len(scene.axis), 150)] + rng.normal(0.0, 0.02, (150, 3))
    mpc = limited(scene, budget)
    _, judged = drive(mpc, mpc.init(START), list(targets), steps=1)
    assert judged.worst_margin >= 0.0
    assert judged.holds == 0
    assert_limits_kept(judged)


def test_without_time_the_robot_stands_still_and_says_so() -> None:
    scene = bent_tube()
    mpc = limited(scene, 1e-9)
    state = mpc.init(START)
    after, command = mpc.step(state, scene.axis[20])
    assert not command.report.workload.in_time
    assert command.report.status is Status.TRACKING  # nothing has failed, nothing is in the way
    assert command.report.step_fraction == 0.0
    assert np.all(command.rates == 0.0)
    np.testing.assert_array_equal(after.c, state.c)


def test_an_ample_budget_changes_nothing() -> None:
    scene = bent_tube()
    free, ample = limited(scene, None), limited(scene, AMPLE)
    a, b = free.init(START), ample.init(START)
    for target in (scene.axis[12], scene.axis[20]):
        for _ in range(20):
            a, _ = free.step(a, target)
            b, command = ample.step(b, target)
            assert command.report.workload.in_time
            np.testing.assert_array_equal(a.c, b.c)


def test_a_tight_budget_still_makes_its_way() -> None:
    # Planes that there was no time for are remembered, so that steps add up to a solution.
    scene = bent_tube()
    mpc = limited(scene, 4e-4)
    state, start = mpc.init(START), scene.robot.tip(START)
    for _ in range(400):
        state, _ = mpc.step(state, scene.axis[14])
    left = np.linalg.norm(scene.robot.tip(state.c) - scene.axis[14])
    assert left < 0.5 * np.linalg.norm(start - scene.axis[14])
