"""Paper A, 2.2: both sides of every misprint, and numbers that theory knows."""

from dataclasses import replace

import numpy as np
import pytest
from tests.control.geometric_arms import joint_centres as written_once_more

from sinuous.control.geometric_ik import CHI
from sinuous.papers.qin2020.kinematics import disc, paths, printed
from sinuous.papers.qin2020.runs import BOUNDARY, inverse

ROBOT = inverse().robot
EXACT = 1e-13  # [m], [rad]
D, R, M = 0.012, 0.0338, 18  # printed [m]


def random_poses(count: int, seed: int) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-0.3, 0.3, (count, 10))


# --- the disc ---------------------------------------------------------------------------------


def test_joint_centres_agree_with_those_written_once_more() -> None:
    poses = random_poses(20, 0)
    found = disc.joint_centres(inverse(), poses)
    for pose, centres in zip(poses, found, strict=True):
        np.testing.assert_allclose(centres, written_once_more(ROBOT, pose)[0], atol=EXACT)


def test_targets_in_a_disc_are_spread_evenly() -> None:
    points = disc.in_disc(20_000, 2.0, np.random.default_rng(1))
    r = np.hypot(*points.T)
    assert np.max(r) <= 2.0
    assert np.mean(r < 1.0) == pytest.approx(0.25, abs=0.02)
    np.testing.assert_allclose(points.mean(axis=0), 0.0, atol=0.05)


def test_the_whole_disc_is_reached_and_most_of_it_within_the_limit() -> None:
    found = disc.whole_disc(5000, CHI)
    assert found["tip_error_m"] < 1e-9
    assert found["tube_tilt_rad"] < 1e-9
    assert found["within_limit_share"] == pytest.approx(0.97, abs=0.01)
    assert found["largest_bend_rad"] == pytest.approx(2.0 * CHI, abs=0.01)
    assert found["moved_before_k_rad"] == 0.0
    # The regions of (11) are discs of radius j L sin(chi) that touch at the reference point.
    area = np.diff([0.0, *((np.array([2, 3, 4]) / 4.0) ** 2)])[::-1]
    np.testing.assert_allclose(found["share_by_k"], area, atol=0.02)


def test_half_the_limit_is_the_largest_chi_without_a_breach() -> None:
    half = ROBOT.bend_limit / 2.0
    assert disc.CHIS.min() < half < disc.CHIS.max()
    for row in disc.by_chi(4000):
        assert (row["within_limit_share"] == 1.0) == (row["chi_rad"] <= half)


def test_no_plane_has_the_whole_square_within_the_limit() -> None:
    """The square's corners are sqrt(2) farther out than its sides."""
    corner = np.sqrt(2.0) * BOUNDARY
    rows = disc.by_chi(4000)
    for row in rows:
        whole = row["square_in_disc_share"] == 1.0
        assert whole == (row["radius_m"] >= corner) or abs(row["radius_m"] - corner) < 0.005
        assert row["square_share"] <= row["square_in_disc_share"]
    assert 0.7 < max(row["square_share"] for row in rows) < 0.8


def test_drawn_poses_start_with_the_reference_pose() -> None:
    first, *others = disc.poses(CHI)
    centres = np.array(first["joints_m"])
    links = np.diff(centres[:-1], axis=0)
    np.testing.assert_allclose(links, links[:1].repeat(4, axis=0), atol=1e-4)
    assert {pose["first_joint"] for pose in others} == {1, 2, 3}


# --- misprints --------------------------------------------------------------------------------


def test_a1_a_straight_cable_that_changes_its_hole_is_too_long() -> None:
    """Between two plates 2 D apart it goes over a chord of 2 R sin(pi / M)."""
    gap = np.hypot(2.0 * D, 2.0 * R * np.sin(np.pi / M))
    found = printed.hole_angles(50)
    expected = np.arange(1, 6) * (gap - 2.0 * D)
    np.testing.assert_allclose(found["straight_by_module_m"], expected, atol=EXACT)
    assert found["largest_m"] > 0.0176  # notes A1
    assert found["round_trip_rad"] < 1e-10


def test_a1_both_readings_agree_for_holes_side_by_side() -> None:
    """Where neighbouring holes are next to each other, it does not matter which one it is."""
    fine = replace(ROBOT, holes=3_000_000)
    poses = random_poses(20, 2)
    found = printed.literal_lengths(fine, poses)
    np.testing.assert_allclose(found, fine.lengths(poses), atol=1e-6)


def test_a3_angles_in_the_world_agree_in_a_plane_and_not_beside_it() -> None:
    ik = inverse()
    z = np.linspace(-0.17, 0.17, 30)
    c = ik.solve(ik.on_plane(np.stack([0.0 * z, z], axis=1), CHI)).c
    links = np.diff(disc.joint_centres(ik, c), axis=1)
    found = printed.angles_in_the_world(links / np.linalg.norm(links, axis=2, keepdims=True))
    np.testing.assert_allclose(found, c, atol=1e-12)
    beside = printed.link_directions(200)
    assert beside["ours_largest_m"] < 1e-12
    assert beside["printed_median_m"] > 0.001


def test_a5_the_printed_points_are_a_line_and_the_farther_intersection_jumps() -> None:
    found = printed.plane(200)
    assert found["width_of_printed_points_m"] < EXACT
    assert found["length_of_printed_points_m"] > 0.3
    assert found["without_point_in_the_plane_share"] > 0.2
    for row in found["farther_intersection"]:
        assert row["nearer_m"] < 1e-4
        assert row["farther_m"] > 0.05


def test_a5_the_solution_lies_on_the_circle() -> None:
    ik, rng = inverse(), np.random.default_rng(3)
    found = ik.solve(ik.on_plane(disc.in_disc(50, ik.radius(CHI), rng), CHI))
    for centres, k in zip(disc.joint_centres(ik, found.c), found.first_joint, strict=True):
        middle, radius, axis = printed.circle(ik, centres, int(k))
        away = centres[k] - middle
        assert np.linalg.norm(away) == pytest.approx(radius, abs=1e-9)
        assert away @ axis == pytest.approx(0.0, abs=1e-9)


# --- paths ------------------------------------------------------------------------------------


def test_no_path_is_steeper_than_the_constant_allows() -> None:
    found = paths.continuity(60)
    assert found["switches"] > 30
    assert 0.8 < found["largest_share"] < 1.0
    assert len(found["change_rad"]) == 60


def test_at_switches_a_cable_would_have_to_be_the_faster_the_shorter_the_period() -> None:
    found = paths.cable_rates()
    peaks = [row["cable_m_s"] for row in found["peak_by_period"]]
    assert np.all(np.diff(peaks) > 0.0)
    assert peaks[-1] > 10.0 * peaks[0]
    mild, slow = found["limited"]
    assert mild["cable_speed_m_s"] > slow["cable_speed_m_s"]
    assert mild["steps_slowed"] < slow["steps_slowed"]
    assert 0.0 < max(mild["tip_error_m"]) < max(slow["tip_error_m"]) < 0.005
    assert slow["tip_error_m"][-1] < 1e-9
