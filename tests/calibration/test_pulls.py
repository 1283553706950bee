"""Single pulls say which motor is which cable, whatever the order and direction of the columns."""

import os
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from tests.calibration.made import (
    LENGTH,
    ORDER,
    ROBOT,
    SIGNS,
    commands,
    recording,
    simulated,
    single_pulls,
    truth,
)

from sinuous.calibration.parameters import parameters
from sinuous.calibration.pulls import are_pulls, body_axis, identify, middle
from sinuous.calibration.recording import Recording, read_recording
from sinuous.errors import InputError
from sinuous.robots.robot_file import load_pcc

REPOSITORY = "github.com/ContinuumRoboticsLab/opencr-mujoco"
DATA = Path(os.environ.get("SINUOUS_DATA", "../shared/data")) / "opencr"
# Of the axis, which other errors of the robot tilt [rad].
TILT = np.deg2rad(12.0)


@cache
def made(seed: int = 1) -> Recording:
    x = truth(seed, parameters(ROBOT, own_zeros=True))
    problem = simulated(x, commands(), single_pulls(), seed=seed)
    return recording(problem, 0, start=0.0)


def is_same_robot(motors: np.ndarray, expected: np.ndarray) -> bool:
    """Whether cables are numbered alike, or alike but for a base turned by 120 degrees."""
    by_segment, wanted = motors.reshape(3, 3), expected.reshape(3, 3)
    return any(np.array_equal(by_segment, np.roll(wanted, k, axis=1)) for k in range(3))


@settings(max_examples=12)
@given(
    st.integers(1, 6), st.permutations(range(9)), st.lists(st.booleans(), min_size=9, max_size=9)
)
def test_motors_are_found(seed: int, order: list[int], flips: list[bool]) -> None:
    pulls, signs = made(seed), np.where(flips, -1.0, 1.0)
    readings = (pulls.readings * SIGNS)[:, np.argsort(ORDER)]  # in the order of the cables
    mixed = replace(pulls, readings=(readings * signs)[:, order])
    found = identify(mixed, ROBOT)
    assert is_same_robot(np.array(order)[found.motors], np.arange(9))
    np.testing.assert_array_equal(found.directions, signs[order][found.motors])


def test_of_equal_numberings_the_one_of_the_columns_is_taken() -> None:
    pulls = made()
    ordered = replace(pulls, readings=(pulls.readings * SIGNS)[:, np.argsort(ORDER)])
    np.testing.assert_array_equal(identify(ordered, ROBOT).motors, np.arange(9))


@given(st.integers(0, 10**6))
@settings(max_examples=5)
def test_it_does_not_matter_how_the_tracker_stands(seed: int) -> None:
    pulls = made()
    turned = Rotation.random(random_state=seed).as_matrix()
    found = identify(replace(pulls, tips=pulls.tips @ turned.T + 0.3), ROBOT)
    assert is_same_robot(found.motors, np.argsort(ORDER))
    assert np.arccos(np.clip(found.T_t_b[:3, 2] @ turned[:, 2], -1, 1)) < TILT


def test_the_axis_points_from_base_to_tip() -> None:
    bend = np.random.default_rng(0).normal(0, 0.4, (200, 6))
    tips = ROBOT.tip(bend)
    axis = body_axis(tips, np.array([0.0, 0.0, LENGTH]), LENGTH)
    assert axis[2] > np.cos(TILT)


def test_the_middle_does_not_follow_what_is_far_away() -> None:
    points = np.zeros((10, 3))
    points[0] = 1.0
    assert np.linalg.norm(middle(points)) < 1e-3


def test_a_motor_that_never_pulls_alone_is_named() -> None:
    pulls = made()
    kept = pulls.patterns != pulls.patterns[np.argmax(pulls.readings[:, 4] * SIGNS[4])]
    with pytest.raises(InputError, match=r"motor_4_mm.*this motor alone pulls"):
        identify(pulls.rows(kept), ROBOT)


def test_single_pulls_are_told_from_other_movements() -> None:
    x = truth(1, parameters(ROBOT, own_zeros=True))
    problem = simulated(x, commands(), single_pulls(), seed=1)
    assert np.all(are_pulls(recording(problem, 0, start=0.0)))
    assert not np.any(are_pulls(recording(problem, 1, start=0.0)))


@pytest.mark.parametrize("version", ["v4", "v6"])
def test_real_robots_pull_where_their_files_say(version: str) -> None:
    path = DATA / f"ftdcr_{version}_tendon_pull.csv"
    if not path.exists():
        pytest.skip(f"no {path}: get it from {REPOSITORY}, or name its folder by SINUOUS_DATA")
    found = identify(read_recording(path), load_pcc(f"opencr_{version}"))
    np.testing.assert_array_equal(found.motors, np.arange(9))
    np.testing.assert_array_equal(found.directions, 1.0)
    assert found.mismatch < np.deg2rad(6.0)
