"""Closed-form inverse kinematics of the jointed robot (paper A, eq. 10-15)."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.control.geometric_arms import (
    IK,
    QIN,
    D,
    H,
    L,
    Y,
    arms,
    in_disc,
    joint_centres,
    reference,
    to_world,
)

from sinuous.arrays import Array
from sinuous.control.geometric_ik import CHI, GeometricIK, IKStatus
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.parts import Insertion, Tool

TIP = 1e-9  # [m], what the issue asks for
EXACT = 1e-13  # [m], [rad]: rounding of a dozen operations on lengths below 2 m
ROOT = 1e-7  # [rad]: the root of the rounding of a length, where a bend begins with a root
RIM = 1e-12  # [m] beyond the reach that still counts as on it
SPREAD = 0.004  # of a share of 0.97 of 100,000 random targets: seven standard deviations


def judge(ik: GeometricIK, targets: Array) -> None:
    """The tip is where the answer says, the last tube parallel to the base's axis."""
    found = ik.solve(targets)
    for c, place, bend in zip(found.c, found.targets, found.bend, strict=True):
        assert np.all(np.isfinite(c))
        places, directions = joint_centres(ik.robot, c)
        np.testing.assert_allclose(to_world(ik.robot, places[-1]), place, rtol=0.0, atol=RIM)
        np.testing.assert_allclose(directions[-1], Y, rtol=0.0, atol=EXACT)
        cosines = np.sum(directions * np.vstack([Y, directions[:-1]]), axis=1)
        assert bend == pytest.approx(np.arccos(np.clip(cosines.min(), -1.0, 1.0)), abs=1e-7)
    reached = found.status != IKStatus.UNREACHABLE
    np.testing.assert_array_equal(found.targets[reached], targets[reached])


@pytest.mark.parametrize(("degrees", "share"), [(20.3, 0.967), (19.5, 1.0)])
def test_a_hundred_thousand_targets_in_the_disc_are_met(degrees: float, share: float) -> None:
    chi = np.radians(degrees)
    targets = IK.on_plane(in_disc(np.random.default_rng(0), IK.radius(chi), 100_000), chi)
    found = IK.solve(targets)
    pose = QIN.tip_pose(found.c)
    assert np.max(np.linalg.norm(pose[:, :3, 3] - targets, axis=1)) < TIP
    np.testing.assert_allclose(pose[:, :3, 1], np.broadcast_to(Y, targets.shape), atol=EXACT)
    assert not np.any(found.status == IKStatus.UNREACHABLE)
    np.testing.assert_array_equal(found.status == IKStatus.JOINT_LIMIT, found.bend > QIN.bend_limit)
    assert np.mean(found.status == IKStatus.REACHED) == pytest.approx(share, abs=SPREAD)
    # The arm folds by 2 chi at the disc's centre, and nowhere by more.
    assert found.bend.max() == pytest.approx(2.0 * chi, abs=1e-2)
    assert found.bend.max() < 2.0 * chi + EXACT
    centre = IK.solve_one(IK.on_plane([0.0, 0.0], chi))
    assert centre.bend == pytest.approx(2.0 * chi, abs=EXACT)


def test_at_nineteen_and_a_half_degrees_no_target_breaches_at_twenty_the_centre_does() -> None:
    for chi, status in ((19.5, IKStatus.REACHED), (20.0, IKStatus.JOINT_LIMIT)):
        assert IK.solve_one(IK.on_plane([0.0, 0.0], np.radians(chi))).status is status


@settings(max_examples=60, deadline=None)
@given(robot=arms, seed=st.integers(0, 2**32 - 1))
def test_any_robot_anywhere_meets_targets_in_any_plane(robot: JointedRobot, seed: int) -> None:
    ik, rng = GeometricIK(robot), np.random.default_rng(seed)
    chis = rng.uniform(0.0, 0.5 * np.pi, 6)
    targets = [ik.on_plane(in_disc(rng, 1.2 * ik.radius(chi), 1)[0], chi) for chi in chis]
    judge(ik, np.array([*targets, rng.uniform(-1.0, 1.0, 3)]))


@settings(max_examples=200, deadline=None)
@given(
    robot=arms,
    chi=st.sampled_from([0.0, 1e-9, 1e-4, 0.35, 1.2, np.pi / 2.0]),
    place=st.sampled_from(["rim", "reference", "opposite", "centre", "switch", "line"]),
    share=st.floats(0.0, 1.0),
    off=st.sampled_from([0.0, 1e-300, 1e-17, 1e-16, 1e-13, 1e-12, 1e-9, 1e-6, 1e-3]),
    angle=st.floats(0.0, 6.3),
)
def test_no_number_is_wrong_where_cases_meet(
    robot: JointedRobot, chi: float, place: str, share: float, off: float, angle: float
) -> None:
    ik = GeometricIK(robot)
    radius, N = ik.radius(chi), robot.joints
    k = 1 + int(share * (N - 2))  # the disc of the targets that joints k to N reach
    rim = radius * np.array([np.cos(angle), np.sin(angle)])
    centre, size = np.array([0.0, (k - 1) / (N - 1) * radius]), (N - k) / (N - 1)
    points = {
        "rim": rim,
        "reference": np.array([0.0, radius]),
        "opposite": np.array([0.0, -radius]),
        "centre": np.zeros(2),
        "switch": centre + size * rim,
        "line": np.array([0.0, (2.0 * share - 1.0) * radius]),
    }
    x_z = points[place] + off * np.array([np.cos(7.0 * angle), np.sin(7.0 * angle)])
    target = ik.on_plane(x_z, chi)
    judge(ik, np.array([target, target + off, target - off * robot.T_w_b[:3, 1]]))


@pytest.mark.parametrize("size", [1e3, 1e30, 1e150, 1e200, 1e300])
def test_targets_at_any_distance_have_the_nearest_of_their_plane(size: float) -> None:
    for way in np.vstack([np.eye(3), -np.eye(3), np.ones(3)]):
        found = IK.solve_one(size * way)
        assert found.status is IKStatus.UNREACHABLE
        assert np.all(np.isfinite(found.c))
        np.testing.assert_allclose(QIN.tip(found.c), found.target, rtol=0.0, atol=RIM)


def test_outside_the_disc_the_nearest_of_the_plane_is_offered_and_reached() -> None:
    rng, radius = np.random.default_rng(1), IK.radius(CHI)
    angle, beyond = rng.uniform(0.0, 2.0 * np.pi, 200), rng.uniform(1e-9, 0.5, 200)
    way = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    found = IK.solve(IK.on_plane((radius + beyond[:, None]) * way, CHI))
    assert np.all(found.status == IKStatus.UNREACHABLE)
    np.testing.assert_allclose(found.targets, IK.on_plane(radius * way, CHI), atol=EXACT)
    # One joint is bent, towards the target, and the last one back.
    np.testing.assert_allclose(found.bend, CHI, atol=1e-5)
    again = IK.solve(found.targets)
    assert np.all(again.status == IKStatus.REACHED)
    just_inside = IK.solve(IK.on_plane((radius - 1e-9) * way, CHI))
    assert not np.any(just_inside.status == IKStatus.UNREACHABLE)


def test_beyond_the_robots_length_it_is_straight() -> None:
    longest = IK.plane(0.0)
    assert longest == pytest.approx(5.0 * L)
    found = IK.solve_one([0.0, longest + 0.1, 0.0])
    assert found.status is IKStatus.UNREACHABLE
    np.testing.assert_allclose(found.target, longest * Y, atol=EXACT)
    np.testing.assert_allclose(found.c, 0.0, atol=EXACT)
    np.testing.assert_allclose(IK.solve_one(longest * Y).c, 0.0, atol=EXACT)


def test_as_few_joints_move_as_can_and_the_others_stay_in_the_reference_pose() -> None:
    """(11), (12) and notes A6: k is the largest with |A_N,d - A_k,r| <= (N-k) L, at most N-2."""
    A_r, N = reference(QIN, CHI), QIN.joints
    targets = IK.on_plane(in_disc(np.random.default_rng(2), IK.radius(CHI), 500), CHI)
    found = IK.solve(targets)
    assert set(found.first_joint) == {1, 2, 3}
    for c, target, k in zip(found.c, targets, found.first_joint, strict=True):
        places, _ = joint_centres(QIN, c)
        A_d = places[:N]
        np.testing.assert_allclose(A_d[N - 1], target - (D + H) * Y, atol=EXACT)  # (10)
        reaches = [np.linalg.norm(A_d[N - 1] - A_r[i - 1]) <= (N - i) * L for i in range(1, N - 1)]
        assert k == 1 + np.flatnonzero(reaches)[-1]
        np.testing.assert_allclose(A_d[:k], A_r[:k], atol=EXACT)
        assert np.linalg.norm(A_d[k] - A_d[k - 1]) == pytest.approx(L)
        assert np.linalg.norm(A_d[N - 1] - A_d[k]) == pytest.approx((N - k - 1) * L)


def test_the_reference_pose_is_that_of_the_paper() -> None:
    for chi in (0.0, CHI, 1.0):
        c = np.zeros(2 * QIN.joints)
        c[1], c[-1] = chi, -chi
        np.testing.assert_allclose(IK.reference(chi), c, atol=ROOT)
        assert IK.plane(chi) == pytest.approx(4.0 * L * np.cos(chi) + L)  # beside (10)
        assert IK.radius(chi) == pytest.approx(4.0 * L * np.sin(chi))
        assert IK.chi(IK.plane(chi)) == pytest.approx(chi, abs=1e-7)


def test_a_stage_is_held_where_it_is_said_and_a_tools_end_is_the_tip() -> None:
    stage = Insertion(travel=(0.0, 0.1), home=0.02, radius=0.03)
    robot = replace(QIN, insertion=stage, tool=Tool(offset=(0.0, 0.05, 0.0), radius=0.003))
    for ik, held in ((GeometricIK(robot), 0.02), (GeometricIK(robot, insertion=0.07), 0.07)):
        target = ik.on_plane([0.03, -0.05], CHI)
        found = ik.solve_one(target)
        assert found.c[0] == held
        np.testing.assert_allclose(robot.tip(found.c), target, atol=EXACT)
        plain = IK.solve_one(IK.on_plane([0.03, -0.05], CHI))
        np.testing.assert_allclose(found.c[1:], plain.c, atol=1e-12)


def test_one_target_and_many_are_answered_alike() -> None:
    targets = IK.on_plane(in_disc(np.random.default_rng(3), 1.3 * IK.radius(CHI), 12), CHI)
    found = IK.solve(targets.reshape(3, 4, 3))
    assert found.c.shape == (3, 4, 10)
    assert found.status.shape == found.first_joint.shape == found.bend.shape == (3, 4)
    for i, target in enumerate(targets):
        one, at = IK.solve_one(target), divmod(i, 4)
        np.testing.assert_array_equal(one.c, found.c[at])
        np.testing.assert_array_equal(one.target, found.targets[at])
        assert one.status is IKStatus(found.status[at])
        assert (one.first_joint, one.bend) == (found.first_joint[at], found.bend[at])
    assert IK.solve(np.empty((0, 3))).c.shape == (0, 10)


def test_bad_input_ends_in_one_sentence() -> None:
    short = replace(QIN, joints=2, orders=QIN.orders[:2])
    with pytest.raises(ValueError, match="3 joints or more, not 2"):
        GeometricIK(short)
    with pytest.raises(ValueError, match="axis of the last tube"):
        GeometricIK(replace(QIN, tool=Tool(offset=(0.01, 0.05, 0.0), radius=0.003)))
    with pytest.raises(ValueError, match="without a stage"):
        GeometricIK(QIN, insertion=0.0)
    stage = Insertion(travel=(0.0, 0.1), home=0.0, radius=0.01)
    for value in (0.2, np.nan):
        with pytest.raises(ValueError, match=r"from 0\.0 to 0\.1 m"):
            GeometricIK(replace(QIN, insertion=stage), insertion=value)
    for target in ([0.0, np.nan, 0.0], [np.inf, 0.0, 0.0]):
        with pytest.raises(ValueError, match="three finite numbers"):
            IK.solve_one(target)
        with pytest.raises(ValueError, match="three finite numbers"):
            IK.solve([[0.0, 0.6, 0.0], target])
    with pytest.raises(ValueError, match=r"\(3,\), not \(2,\)"):
        IK.solve_one([0.0, 0.6])
    with pytest.raises(ValueError, match=r"\(\.\.\., 3\), not \(2,\)"):
        IK.solve([0.0, 0.6])
    for chi in (-0.1, 2.0, np.nan):
        with pytest.raises(ValueError, match="right angle"):
            IK.plane(chi)
    for y0 in (1.0, np.nan):
        with pytest.raises(ValueError, match="robot's length"):
            IK.chi(y0)
