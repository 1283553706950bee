"""Actuator lengths: the sum rule (19), both ways of counting cables, limits and names."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.linalg import expm, null_space

from sinuous.arrays import Array
from sinuous.robots.parts import CableConvention
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

from .random_robots import SPREAD, configurations, robots, seeds, twin

ROUNDING = 1e-14  # [m] a dozen products and sums of lengths below 1 m
INVERSE = 1e-10  # [rad or m]: rounding over a pitch radius of 2 mm, six segments one on another
POLYLINE = 2000  # pieces of the polyline that stands for a cable
CHORDS = 2 * (2 * np.pi / POLYLINE) ** 2 / 24  # relative shortness of chords of a full turn


def rows_of(robot: PccRobot) -> list[tuple[slice, int]]:
    """Rows of each segment's cables and of its backbone, -1 if there is none."""
    rows, row = list[tuple[slice, int]](), 1 if robot.insertion else 0
    for segment in robot.segments:
        cables = slice(row, row + len(segment.cable_angles))
        rows.append((cables, cables.stop if segment.extensible else -1))
        row = cables.stop + segment.extensible
    return rows


def parts(robot: PccRobot, c: Array) -> list[tuple[Array, float]]:
    """Bend vector and length of every segment."""
    values, column = list[tuple[Array, float]](), 1 if robot.insertion else 0
    for segment in robot.segments:
        gamma = c[column + 2] if segment.extensible else segment.home_length
        values.append((c[column : column + 2], float(gamma)))
        column += 3 if segment.extensible else 2
    return values


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_lengths_are_affine_with_an_exact_jacobian(robot: PccRobot, seed: int) -> None:
    a, b, origin = configurations(robot, np.random.default_rng(seed), 3)
    J = robot.lengths_jacobian(a)
    assert np.array_equal(J, robot.lengths_jacobian(b))
    straight = robot.lengths(origin + (a - origin) + (b - origin))
    summed = robot.lengths(a) + robot.lengths(b) - robot.lengths(origin)
    np.testing.assert_allclose(straight, summed, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(robot.lengths(b), robot.lengths(a) + J @ (b - a), rtol=0,
                               atol=ROUNDING)  # fmt: skip


@pytest.mark.parametrize("convention", CableConvention)
def test_sum_rule_holds_for_balanced_cables(convention: CableConvention) -> None:
    robot = twin(load_robot("hachen2025"), convention)
    for c in 5.0 * np.random.default_rng(2).normal(size=(200, len(robot.home))):  # any c at all
        q = robot.lengths(c)
        for cables, backbone in rows_of(robot):
            assert abs(3 * q[backbone] - np.sum(q[cables])) < 10 * ROUNDING * np.max(np.abs(q))


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_sum_rule_holds_in_its_general_form(robot: PccRobot, seed: int) -> None:
    """Any weights that balance the holes, sum w h = 0, give sum w q = (sum w) length."""
    for c in configurations(robot, np.random.default_rng(seed), 3):
        q, length = robot.lengths(c), 0.0
        for (cables, backbone), segment, (_, gamma) in zip(
            rows_of(robot), robot.segments, parts(robot, c), strict=True
        ):
            length = gamma + (length if robot.convention is CableConvention.MOTOR else 0.0)
            for weights in null_space(segment.holes.T / 1e-3).T:
                assert abs(weights @ q[cables] - np.sum(weights) * length) < 10 * ROUNDING
            if backbone >= 0:
                assert abs(q[backbone] - length) < ROUNDING


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_configuration_inverts_lengths(robot: PccRobot, seed: int) -> None:
    c = configurations(robot, np.random.default_rng(seed), 6)
    np.testing.assert_allclose(robot.configuration(robot.lengths(c)), c, rtol=0,
                               atol=INVERSE / SPREAD)  # fmt: skip


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_configuration_is_least_squares_when_the_sum_rule_is_violated(
    robot: PccRobot, seed: int
) -> None:
    rng = np.random.default_rng(seed)
    c = configurations(robot, rng, 1)[0]
    q = robot.lengths(c) + 1e-3 * rng.normal(size=len(robot.actuator_names))
    left = q - robot.lengths(robot.configuration(q))
    if robot.insertion:
        assert abs(left[0]) < ROUNDING
    for (cables, backbone), segment in zip(rows_of(robot), robot.segments, strict=True):
        # What is left over can be explained by no bend; the backbone's reading is kept.
        assert np.max(np.abs(segment.holes.T @ left[cables])) < ROUNDING
        if backbone >= 0:
            assert abs(left[backbone]) < ROUNDING


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_what_no_bend_explains_does_not_change_the_shape(robot: PccRobot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    c = configurations(robot, rng, 4)[-1]
    q = robot.lengths(c)
    for (cables, _), segment in zip(rows_of(robot), robot.segments, strict=True):
        unexplained = null_space(segment.holes.T / 1e-3)
        q[cables] += 1e-3 * unexplained @ rng.normal(size=unexplained.shape[1])
    assert np.max(np.abs(q - robot.lengths(c))) > 0.0
    np.testing.assert_allclose(robot.configuration(q), c, rtol=0, atol=INVERSE / SPREAD)


@given(robot=robots, seed=seeds)
@settings(max_examples=60)
def test_motor_lengths_add_up_the_segments_a_cable_passes(robot: PccRobot, seed: int) -> None:
    c = configurations(robot, np.random.default_rng(seed), 4)[-1]
    inside = twin(robot, CableConvention.SEGMENT).lengths(c)
    at_motor = twin(robot, CableConvention.MOTOR).lengths(c)
    passed = list[tuple[Array, float]]()
    for (cables, backbone), segment, part in zip(
        rows_of(robot), robot.segments, parts(robot, c), strict=True
    ):
        own = part[1] - segment.holes @ part[0]
        np.testing.assert_allclose(inside[cables], own, rtol=0, atol=ROUNDING)
        passed.append(part)
        through = sum(gamma - segment.holes @ theta for theta, gamma in passed)
        np.testing.assert_allclose(at_motor[cables], through, rtol=0, atol=ROUNDING)
        if backbone >= 0:
            assert abs(at_motor[backbone] - sum(gamma for _, gamma in passed)) < ROUNDING


@given(robot=robots, seed=seeds)
@settings(max_examples=40)
def test_conversion_between_the_conventions_both_ways(robot: PccRobot, seed: int) -> None:
    inside, motor = (twin(robot, convention) for convention in CableConvention)
    c = configurations(robot, np.random.default_rng(seed), 4)
    q = inside.lengths(c)
    at_motor = motor.lengths(inside.configuration(q))
    back = inside.lengths(motor.configuration(at_motor))
    np.testing.assert_allclose(at_motor, motor.lengths(c), rtol=0, atol=INVERSE)
    np.testing.assert_allclose(back, q, rtol=0, atol=INVERSE)


def test_aligned_cables_of_equal_segments_add_up_directly() -> None:
    inside = load_robot("hachen2025")
    motor = twin(inside, CableConvention.MOTOR)
    c = configurations(inside, np.random.default_rng(5), 8)
    q, Q = inside.lengths(c).reshape(8, 3, 4), motor.lengths(c).reshape(8, 3, 4)
    np.testing.assert_allclose(Q, np.cumsum(q, axis=1), rtol=0, atol=ROUNDING)


@given(robot=robots, seed=seeds)
@settings(max_examples=15)
def test_motor_lengths_are_the_lengths_of_curves_through_the_holes(
    robot: PccRobot, seed: int
) -> None:
    """A cable drawn through the body, measured piece by piece."""
    robot = twin(robot, CableConvention.MOTOR)
    c = configurations(robot, np.random.default_rng(seed), 4)[-1]
    T = np.eye(4)
    frames = list[Array]()
    for (x, y), gamma in parts(robot, c):
        twist = np.array([[0, 0, x, 0], [0, 0, y, 0], [-x, -y, 0, gamma], [0, 0, 0, 0]])
        step = expm(twist / POLYLINE)
        frames.append(T)
        for _ in range(POLYLINE):
            frames.append(frames[-1] @ step)
        T = frames.pop()
    frames.append(T)
    path = np.array(frames)
    q = robot.lengths(c)
    for j, ((cables, _), segment) in enumerate(zip(rows_of(robot), robot.segments, strict=True), 1):
        passed = path[: j * POLYLINE + 1]
        for hole, length in zip(segment.holes, q[cables], strict=True):
            drawn = passed[:, :3, 3] + passed[:, :3, :2] @ hole
            pieces = np.linalg.norm(np.diff(drawn, axis=0), axis=1)
            assert abs(np.sum(pieces) - length) < CHORDS * np.sum(pieces)


@given(robot=robots)
@settings(max_examples=40)
def test_limits_and_names_follow_the_same_order(robot: PccRobot) -> None:
    names, rates, lengths = robot.actuator_names, robot.rate_limits, robot.length_limits
    count = len(robot.lengths(robot.home))
    assert len(names) == len(set(names)) == len(rates) == len(lengths) == count
    assert np.array_equal(rates[:, 0], -rates[:, 1])
    expected = {"insertion": 0.03, "cable": 0.02, "backbone": 0.01}
    reach = np.zeros(2)
    for j, (cables, backbone) in enumerate(rows_of(robot), 1):
        segment = robot.segments[j - 1]
        reach = np.array(segment.length) + (
            reach if robot.convention is CableConvention.MOTOR else 0.0
        )
        for m, row in enumerate(range(cables.start, cables.stop), 1):
            assert names[row] == f"segment {j} cable {m}"
            assert tuple(lengths[row]) == segment.cable_length
            assert rates[row, 1] == expected["cable"]
        if backbone >= 0:
            assert names[backbone] == f"segment {j} backbone"
            np.testing.assert_allclose(lengths[backbone], reach, rtol=0, atol=ROUNDING)
            assert rates[backbone, 1] == expected["backbone"]
    if robot.insertion:
        assert names[0] == "insertion"
        assert tuple(lengths[0]) == robot.insertion.travel
        assert rates[0, 1] == expected["insertion"]


def test_motor_backbone_limits_hold_with_a_fixed_segment_below() -> None:
    """The backbone of a segment behind a fixed one is counted from the base as well."""
    robot = load_robot("hachen2025")
    fixed = replace(robot.segments[0], length=(0.05, 0.05), home_length=0.05)
    robot = replace(robot, segments=(fixed, *robot.segments[1:]), convention=CableConvention.MOTOR)
    row = robot.actuator_names.index("segment 2 backbone")
    np.testing.assert_allclose(robot.length_limits[row], [0.09, 0.14], rtol=0, atol=ROUNDING)
    assert robot.lengths(robot.home)[row] == pytest.approx(0.05 + 0.065, abs=ROUNDING)
