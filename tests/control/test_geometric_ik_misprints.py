"""Where the paper's inverse kinematics cannot be taken at its word (notes A3, A5, A6)."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tests.control.geometric_arms import IK, QIN, L, Y, in_disc, joint_centres, reference

from sinuous.arrays import Array
from sinuous.control.geometric_ik import CHI

EXACT = 1e-13  # [m], [rad]
ROOT = 1e-7  # [rad]: the root of the rounding of a length, where a bend begins with a root
N = QIN.joints
TARGETS = IK.on_plane(in_disc(np.random.default_rng(0), IK.radius(CHI), 300), CHI)


def without_accumulated_frame(directions: Array) -> Array:
    """Angles (N, 2) of (14) as printed: Rot(Z) Rot(X) turns a link's direction into the next's.

    Both directions are in the world frame. From Rot(X, phi) v = Rot(Z, -theta) w follow v_y sin
    phi + v_z cos phi = w_z, and then theta.
    """
    angles = np.empty((len(directions), 2))
    for i, (v, w) in enumerate(zip(np.vstack([Y, directions[:-1]]), directions, strict=True)):
        size = np.hypot(v[1], v[2])
        phi = np.arcsin(np.clip(w[2] / size, -1.0, 1.0)) - np.arctan2(v[2], v[1])
        tilted = Rotation.from_euler("X", phi).apply(v)
        angles[i] = np.arctan2(w[1], w[0]) - np.arctan2(tilted[1], tilted[0]), phi
    return angles


def test_a3_without_the_frame_of_the_links_before_the_tip_misses() -> None:
    found = IK.solve(TARGETS)
    misses, exact = list[float](), list[float]()
    for c, target in zip(found.c, TARGETS, strict=True):
        places, directions = joint_centres(QIN, c)
        printed = without_accumulated_frame(directions)
        np.testing.assert_allclose(printed[0], c[:2], atol=EXACT)  # joint 1 has no link before
        for i, (theta, phi) in enumerate(printed[1:], 1):  # it does solve (14) as printed
            turned = Rotation.from_euler("ZX", [theta, phi]).apply(directions[i - 1])
            np.testing.assert_allclose(turned, directions[i], atol=1e-12)
        misses.append(float(np.linalg.norm(joint_centres(QIN, printed.ravel())[0][-1] - target)))
        exact.append(float(np.linalg.norm(places[-1] - target)))
    assert np.median(misses) > 0.003
    assert max(misses) > 0.01
    assert max(exact) < EXACT


def test_a3_both_agree_as_long_as_all_bends_are_about_one_axis() -> None:
    x_z = np.array([[0.0, z] for z in np.linspace(-0.17, 0.17, 20)])
    for c in IK.solve(IK.on_plane(x_z, CHI)).c:
        printed = without_accumulated_frame(joint_centres(QIN, c)[1])
        np.testing.assert_allclose(printed.ravel(), c, atol=1e-12)


def test_a5_the_printed_points_are_on_one_line_and_define_no_plane() -> None:
    A = reference(QIN, CHI)
    first, third, last = A[0], A[N - 3], A[N - 1]
    area = np.linalg.norm(np.cross(third - first, last - first))
    assert area < EXACT * L
    # The reference line and A_N,d do, for all targets but the reference point itself.
    for target in TARGETS:
        assert np.linalg.norm(np.cross(last - first, target - L * Y + A[0] - first)) > 1e-6


def test_a5_all_joints_are_in_the_plane_of_the_reference_line_and_the_target() -> None:
    A, found = reference(QIN, CHI), IK.solve(TARGETS)
    line = (A[-1] - A[0]) / np.linalg.norm(A[-1] - A[0])
    for c in found.c:
        places = joint_centres(QIN, c)[0][:N] - A[0]
        normal = np.cross(line, places[-1])
        np.testing.assert_allclose(places @ normal / np.linalg.norm(normal), 0.0, atol=EXACT)


def test_a5_no_fixed_plane_through_the_line_would_do() -> None:
    """(12) and (13) have no common point for most targets, whichever plane the paper means."""
    A, found = reference(QIN, CHI), IK.solve(TARGETS)
    across = np.array([[1.0, 0.0, 0.0], [0.0, -np.sin(CHI), np.cos(CHI)]])
    for angle in np.linspace(0.0, np.pi, 7):
        normal = np.cos(angle) * across[0] + np.sin(angle) * across[1]
        without = 0
        for c, k in zip(found.c, found.first_joint, strict=True):
            way = joint_centres(QIN, c)[0][N - 1] - A[k - 1]
            middle, radius = circle(way, k)
            flat = np.linalg.norm(normal - (normal @ way) * way / (way @ way))
            without += abs(normal @ middle) > radius * flat
        assert without > 0.3 * len(TARGETS)


def circle(way: Array, k: int) -> tuple[Array, float]:
    """Middle (3,) and radius of the circle (12) of A_k+1, seen from A_k."""
    s, m = np.linalg.norm(way), N - k - 1
    along = (s**2 + L**2 - (m * L) ** 2) / (2.0 * s)
    return along * way / s, float(np.sqrt(max(L**2 - along**2, 0.0)))


def test_a5_the_nearer_intersection_is_continuous_across_switches_the_other_is_not() -> None:
    """From disc k to disc k+1, through its rim: link k comes from its reference place, or jumps."""
    A, rng = reference(QIN, CHI), np.random.default_rng(1)
    for k in (1, 2):
        inner = IK.radius(CHI) * (N - k - 1) / (N - 1)
        for angle in rng.uniform(0.0, 2.0 * np.pi, 40):
            rim = np.array([inner * np.cos(angle), IK.radius(CHI) - inner + inner * np.sin(angle)])
            outwards = np.array([np.cos(angle), np.sin(angle)])
            if np.hypot(*(rim - [0.0, IK.radius(CHI)])) < 0.02:
                continue  # where the discs touch, both intersections are one
            targets = IK.on_plane([rim + 1e-9 * outwards, rim - 1e-9 * outwards], CHI)
            found = IK.solve(targets)
            assert tuple(found.first_joint) == (k, k + 1)
            before, after = (joint_centres(QIN, c)[0] for c in found.c)
            np.testing.assert_allclose(before, after, atol=1e-4)  # the root of 1e-9 m
            np.testing.assert_allclose(before[k], A[k], atol=1e-6)
            way = before[N - 1] - before[k - 1]
            middle, _ = circle(way, k)
            other = before[k - 1] + 2.0 * middle - (before[k] - before[k - 1])
            assert np.linalg.norm(other - before[k - 1]) == pytest.approx(L)
            assert np.linalg.norm(other - before[N - 1]) == pytest.approx((N - k - 1) * L)
            assert np.linalg.norm(other - A[k]) > 1e-3


def test_a5_on_the_line_nothing_bends_and_no_plane_is_needed() -> None:
    c = IK.reference(CHI)
    np.testing.assert_allclose(np.delete(c, [1, 9]), 0.0, atol=ROOT)


def test_a6_with_a_smaller_k_more_joints_move_than_need_to() -> None:
    """Every k up to the chosen one could reach, none above it could: (11) alone names several."""
    A = reference(QIN, CHI)
    several = 0
    for target, k in zip(TARGETS, IK.solve(TARGETS).first_joint, strict=True):
        far = np.linalg.norm(target - (QIN.plate_offset + QIN.tube_length) * Y - A, axis=1)
        could = [i for i in range(1, N - 1) if far[i - 1] <= (N - i) * L]
        assert could == list(range(1, k + 1))
        several += len(could) > 1
    assert several > 0.3 * len(TARGETS)
