"""Guarding the whole body from some of its points, and bend limits."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.robots.parts import CableConvention
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

from .random_robots import configurations, robots, seeds

PRESETS = ("hachen2025", "opencr_v4", "opencr_v6")

SURFACE = 0.00025  # [m] spacing at which the issue judges margins
TIGHT = 0.2e-3  # [m] that hachen2025 may keep too far: hypot(8, 1.5) - 8 mm plus 0.03 mm sagitta
ROUNDING = 1e-12  # [m] of distances below 2 m, bisected to the last digit
BISECTIONS = 60
FAR = 2.0  # [m] an obstacle so far away is no obstacle
JACOBIAN = 1e-6  # relative error against differences
STEP = 1e-3  # [rad or m] of extrapolated differences, as for the body
BENDS = 1e-12  # [m] of cable travel: rounding


def worst_obstacles(
    robot: PccRobot, c: Array, required: Array, rng: np.random.Generator, count: int
) -> Array:
    """Point obstacles (count, 3) that the guarded points only just stay away from.

    Each comes in along a ray to the body, half of them to the outside of an arc between two
    guarded points, where the sagitta counts.
    """
    guarded, dense = robot.points(c), robot.sampled(SURFACE).points(c)
    feet, rays = dense[rng.integers(len(dense), size=count)], rng.normal(size=(count, 3))
    between = rng.integers(len(guarded) - 1, size=count // 2)
    chord = 0.5 * (guarded[between] + guarded[between + 1])
    nearest = np.argmin(np.linalg.norm(dense[None] - chord[:, None], axis=2), axis=1)
    outward = dense[nearest] - chord
    curved = np.linalg.norm(outward, axis=1) > 1e-9
    feet[: count // 2] = dense[nearest]
    rays[: count // 2][curved] = outward[curved]
    rays /= np.linalg.norm(rays, axis=1, keepdims=True)
    near, far = np.zeros(count), np.full(count, FAR)
    for _ in range(BISECTIONS):
        middle = 0.5 * (near + far)
        gaps = np.linalg.norm((feet + middle[:, None] * rays)[:, None] - guarded, axis=2)
        kept = np.all(gaps >= required, axis=1)
        near, far = np.where(kept, near, middle), np.where(kept, middle, far)
    return feet + far[:, None] * rays


def body_clearance(robot: PccRobot, c: Array, obstacles: Array) -> Array:
    """Distance of obstacles (K, 3) from the surface of the densely sampled body (K,)."""
    dense = robot.sampled(SURFACE)
    gaps = np.linalg.norm(obstacles[:, None] - dense.points(c), axis=2)
    return np.min(gaps - dense.radii, axis=1)


@given(robot=robots, seed=seeds, margin=st.sampled_from([0.0, 0.001, 0.0055]))
@settings(max_examples=40)
def test_guarded_points_keep_the_whole_body_at_the_margin(
    robot: PccRobot, seed: int, margin: float
) -> None:
    rng = np.random.default_rng(seed)
    required = robot.required_distance(margin)
    for c in configurations(robot, rng, 4):
        obstacles = worst_obstacles(robot, c, required, rng, 40)
        assert np.min(body_clearance(robot, c, obstacles)) > margin - ROUNDING


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("margin", [0.0, 0.0055])
def test_required_distance_wastes_little(name: str, margin: float) -> None:
    robot, rng = load_robot(name), np.random.default_rng(7)
    # What hypot and sagitta add, from the robot's own numbers: thin bodies pay a little more.
    allowed = {"hachen2025": TIGHT}.get(name, 0.3e-3)
    required = robot.required_distance(margin)
    for c in configurations(robot, rng, 30):
        clearance = body_clearance(robot, c, worst_obstacles(robot, c, required, rng, 60))
        assert np.min(clearance) > margin - ROUNDING
        assert np.max(clearance) < margin + allowed


def test_guarding_points_only_lets_the_body_between_them_through() -> None:
    """The other side: with radius + margin alone an obstacle between two points comes closer."""
    robot, rng, margin = load_robot("hachen2025"), np.random.default_rng(8), 0.0
    c = configurations(robot, rng, 6)[-1]
    naive = worst_obstacles(robot, c, robot.radii + margin, rng, 400)
    half = 0.0015  # [m] half the largest arc between two guarded points
    assert np.min(body_clearance(robot, c, naive)) < margin - 0.25 * half**2 / (2 * 0.008)


def test_required_distance_is_that_of_the_worse_section_at_joints() -> None:
    robot = load_robot("hachen2025")
    first, second, third = robot.segments
    thick = replace(first, body_radius=0.012)
    fine = replace(third, disks=29, disk_thickness=0.0005)  # points every 1.6 mm, not every 3 mm
    robot = replace(robot, segments=(thick, second, fine))
    required = robot.required_distance(0.0)
    for disks in (10, 20):
        joint = robot.disk_indices[disks - 1]
        before, after = required[joint - 1], required[joint + 1]
        assert required[joint] == max(before, after)
        assert before > after
    assert np.all(required > robot.radii)


# --- bend limits ---------------------------------------------------------------------------


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_bend_slack_is_the_cable_travel_to_the_limit(robot: PccRobot, seed: int) -> None:
    """Positive where curvature and disks allow more, zero at the limit, negative beyond."""
    c = configurations(robot, np.random.default_rng(seed), 4)[-1]
    slack, row, column = robot.bend_slack(c), 0, 1 if robot.insertion else 0
    for segment in robot.segments:
        gamma = c[column + 2] if segment.extensible else segment.home_length
        spacing = gamma / segment.disks
        contact = (1.0 - segment.disk_thickness / spacing) / segment.body_radius
        limits = [k for k in (segment.max_curvature, contact) if k < np.inf]
        bend = np.hypot(c[column], c[column + 1])
        for curvature in limits:
            travel = max(segment.pitch_radii) * (curvature * gamma - bend)
            assert abs(slack[row] - travel) < BENDS
            at_limit = c.copy()
            at_limit[column : column + 2] *= curvature * gamma / bend
            assert abs(robot.bend_slack(at_limit)[row]) < BENDS
            beyond = c.copy()
            beyond[column : column + 2] *= 1.01 * curvature * gamma / bend
            assert robot.bend_slack(beyond)[row] < 0.0
            row += 1
        column += 3 if segment.extensible else 2
    assert row == len(slack) == len(robot.bend_names)


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_bend_slack_jacobian_matches_differences(robot: PccRobot, seed: int) -> None:
    # |theta| is not smooth at zero: bends there are larger than the step by far.
    rng = np.random.default_rng(seed)
    for c in configurations(robot, rng, 3)[1:]:
        steps = 1e-2 * STEP * np.eye(len(c))
        wide = (robot.bend_slack(c + steps) - robot.bend_slack(c - steps)) / (2e-2 * STEP)
        half = (robot.bend_slack(c + steps / 2) - robot.bend_slack(c - steps / 2)) / (1e-2 * STEP)
        expected = ((4 * half - wide) / 3).T
        error = np.max(np.abs(robot.bend_slack_jacobian(c) - expected))
        if np.min(bends(robot, c)) > 10 * STEP:
            assert error < JACOBIAN * np.max(np.abs(expected))


def bends(robot: PccRobot, c: Array) -> Array:
    columns = [i for i, name in enumerate(robot.coordinate_names) if name.endswith("theta_x")]
    return np.hypot(c[columns], c[np.array(columns) + 1])


@pytest.mark.parametrize(("length", "degrees"), [(0.040, 143.0), (0.090, 501.0)])
def test_disks_alone_allow_the_bends_of_the_notes(length: float, degrees: float) -> None:
    """Notes B10; the preset's stated curvature allows less."""
    robot = load_robot("hachen2025")
    bare = replace(robot.segments[0], max_curvature=np.inf)
    free = replace(robot, segments=(bare,))
    bend = np.radians(degrees)
    half_a_degree = 0.007 * np.radians(0.5)  # the notes round to whole degrees
    assert abs(free.bend_slack([bend, 0.0, length])[0]) < half_a_degree
    stated = replace(robot, segments=robot.segments[:1])
    assert np.min(stated.bend_slack([bend, 0.0, length])) < -10 * half_a_degree


@given(robot=robots, seed=seeds)
@settings(max_examples=40)
def test_bend_slack_is_concave(robot: PccRobot, seed: int) -> None:
    """So its least value on a straight way is at an end, and tangents allow too much."""
    a, b = configurations(robot, np.random.default_rng(seed), 6)[-2:]
    chord = 0.5 * (robot.bend_slack(a) + robot.bend_slack(b))
    assert np.all(robot.bend_slack(0.5 * (a + b)) >= chord - BENDS)
    tangent = robot.bend_slack(a) + robot.bend_slack_jacobian(a) @ (b - a)
    assert np.all(robot.bend_slack(b) <= tangent + BENDS)


def test_bend_slack_jacobian_is_finite_when_straight() -> None:
    robot = load_robot("hachen2025")
    J = robot.bend_slack_jacobian(robot.home)
    assert np.all(np.isfinite(J))
    assert np.count_nonzero(J) == len(J)  # only the length matters there


def test_both_conventions_have_the_same_body() -> None:
    robot = load_robot("opencr_v4")
    other = replace(robot, convention=CableConvention.SEGMENT)
    c = configurations(robot, np.random.default_rng(6), 5)
    assert np.array_equal(robot.points(c), other.points(c))
    assert np.array_equal(robot.bend_slack(c), other.bend_slack(c))
