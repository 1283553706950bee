"""Cables of jointed robots: lengths (5)-(7), their inverse (8) and what three cables agree on."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings

from sinuous.arrays import Array
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.jointed_cables import hole_angles
from sinuous.robots.robot_file import load_jointed

from .random_jointed import angles, jointed_configurations, jointed_robots
from .random_robots import seeds
from .test_jointed import literal_poses
from .test_pcc import JACOBIAN

ROBOT = load_jointed("qin2020")
ROUNDING = 1e-14  # [m] of sums of a dozen lengths below 1 m
INVERSE = 1e-10  # [rad] what the issue asks for
STEP = 1e-4  # [rad] of extrapolated differences; shorter cables in a joint are 1 mm long
CONFIGURATIONS = 6
WRONG = 1e-3  # [m] what one cable reads too much
NONLINEAR = 5e-6  # [m] by what the residual of a wrong cable differs from that of small angles
STATIONARY = 1e-12  # [m^2] slope of the squared residual after the last step of least squares


def literal_lengths(robot: JointedRobot, c: Array, alpha: Array) -> Array:
    """Lengths (N, 3) by (5)-(7) in the world frame, without the derivation of `routing`.

    Arguments:
        alpha: of (4), for module k in plate i (N, N + 1, 3); plate 0 is the base plate
    """
    _, rear = literal_poses(robot, c)
    if robot.insertion:  # the base plate is pushed, and cables count from it
        rear = [np.array(T) for T in rear]
    base = robot.T_w_b.copy()
    if robot.insertion:
        base[:3, 3] += base[:3, 1] * c[0]
    rear = [base, *rear]
    back = np.eye(4)
    back[1, 3] = -robot.tube_length
    lengths = np.zeros((robot.joints, 3))
    for k in range(robot.joints):
        for i in range(1, k + 2):
            front = rear[i] @ back
            for j in range(3):
                hole = [np.array([robot.radius * np.cos(a), 0.0, robot.radius * np.sin(a), 1.0])
                        for a in (alpha[k, i - 1, j], alpha[k, i, j])]  # fmt: skip
                gap = (front @ hole[1] - rear[i - 1] @ hole[0])[:3]
                lengths[k, j] += np.linalg.norm(gap) + robot.tube_length
    return lengths


def kept(robot: JointedRobot) -> Array:
    """Hole angles if a cable keeps its hole (N, N + 1, 3)."""
    k, j = np.arange(1, robot.joints + 1)[:, None, None], np.arange(3)
    alpha = k * 2 * np.pi / robot.holes + j * 2 * np.pi / 3
    return np.tile(alpha, (1, robot.joints + 1, 1))


def printed(robot: JointedRobot) -> Array:
    """Hole angles if i of (4) numbers the plates, as it is printed (N, N + 1, 3)."""
    i, j = np.arange(robot.joints + 1)[:, None], np.arange(3)
    alpha = i * 2 * np.pi / robot.holes + j * 2 * np.pi / 3
    return np.tile(alpha, (robot.joints, 1, 1))


def cables(robot: JointedRobot, lengths: Array) -> Array:
    """Those of the actuators that are cables, by module (..., N, 3)."""
    return lengths[..., -3 * robot.joints :].reshape(*lengths.shape[:-1], robot.joints, 3)


# --- lengths --------------------------------------------------------------------------------


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=40)
def test_lengths_are_distances_between_the_holes(robot: JointedRobot, seed: int) -> None:
    for c in jointed_configurations(robot, np.random.default_rng(seed), 3):
        expected = literal_lengths(robot, c, kept(robot))
        np.testing.assert_allclose(cables(robot, robot.lengths(c)), expected, rtol=0, atol=1e-13)


def test_read_literally_cables_change_their_holes_at_every_plate() -> None:
    """Notes A1, the other side: up to 17.6 mm in one random pose."""
    rng, differ = np.random.default_rng(0), list[float]()
    for c in rng.uniform(-0.3, 0.3, (300, 10)):
        ours = cables(ROBOT, ROBOT.lengths(c))
        np.testing.assert_allclose(ours, literal_lengths(ROBOT, c, kept(ROBOT)), atol=1e-13)
        differ.append(float(np.max(np.abs(literal_lengths(ROBOT, c, printed(ROBOT)) - ours))))
    assert np.median(differ) > 0.010
    assert max(differ) > 0.0176


@pytest.mark.parametrize("bend", [0.05, 0.34, 0.68])
@pytest.mark.parametrize(
    ("module", "cable", "column", "hole"),
    [(2, 2, 0, 180.0), (3, 1, 1, 90.0)],
    ids=["about Z, towards -x", "about X, towards z"],
)
def test_one_joint_bent_in_the_plane_of_a_hole(
    module: int, cable: int, column: int, hole: float, bend: float
) -> None:
    """A cable on the inner side is 2 (D cos(b/2) - R sin(b/2)) long, on the outer with a plus."""
    robot = replace(ROBOT, joints=4, holes=12, orders=ROBOT.orders[:4])
    assert np.degrees(hole_angles(4, 12))[module - 1, cable - 1] == pytest.approx(hole)
    row = 3 * (module - 1) + cable - 1
    for side in (1.0, -1.0):
        c = robot.home
        c[2 * (module - 1) + column] = side * bend
        stretch = 2 * (0.012 * np.cos(bend / 2) - side * 0.0338 * np.sin(bend / 2))
        straight = robot.lengths(robot.home)[row]
        assert straight == pytest.approx(module * 0.130, abs=ROUNDING)
        assert robot.lengths(c)[row] == pytest.approx(straight - 0.024 + stretch, abs=ROUNDING)


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=60)
def test_jacobian_matches_differences(robot: JointedRobot, seed: int) -> None:
    """At most half way to the limit: where plates touch a cable's length is a cone."""
    for c in jointed_configurations(robot, np.random.default_rng(seed), 4):
        c = 0.5 * c
        steps = STEP * np.eye(len(c))
        wide = (robot.lengths(c + steps) - robot.lengths(c - steps)) / (2 * STEP)
        half = (robot.lengths(c + steps / 2) - robot.lengths(c - steps / 2)) / STEP
        expected = ((4 * half - wide) / 3).T
        error = np.max(np.abs(robot.lengths_jacobian(c) - expected))
        assert error < JACOBIAN * np.max(np.abs(expected))


# --- the inverse ----------------------------------------------------------------------------


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=100)
def test_configuration_inverts_lengths(robot: JointedRobot, seed: int) -> None:
    c = jointed_configurations(robot, np.random.default_rng(seed), CONFIGURATIONS)
    q = robot.lengths(c)
    np.testing.assert_allclose(robot.configuration(q), c, rtol=0, atol=INVERSE)
    assert np.max(robot.consistency(q)) < INVERSE


def test_configuration_inverts_lengths_at_the_limit() -> None:
    """Plates touch, half of the joints at the very hole of a cable, which has no length there."""
    rng, count = np.random.default_rng(1), 2000
    towards = rng.uniform(-np.pi, np.pi, (count, 5))
    hole = hole_angles(5, 18)[np.arange(5), rng.integers(3, size=(count, 5))]
    towards[::2] = np.arctan2(np.sin(hole), -np.cos(hole))[::2]
    c = angles(np.full((count, 5), ROBOT.bend_limit), towards).reshape(count, 10)
    assert np.max(np.abs(ROBOT.bend_slack(c))) < ROUNDING
    np.testing.assert_allclose(ROBOT.configuration(ROBOT.lengths(c)), c, rtol=0, atol=INVERSE)


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=60)
def test_configuration_is_least_squares(robot: JointedRobot, seed: int) -> None:
    """Module by module (notes A4): what is left of its three cables, no two angles explain."""
    rng = np.random.default_rng(seed)
    c = 0.5 * jointed_configurations(robot, rng, 3)[-1]
    q = robot.lengths(c) + 1e-4 * rng.normal(size=len(robot.actuator_names))
    found = robot.configuration(q)
    left, J = q - robot.lengths(found), robot.lengths_jacobian(found)
    stage = len(q) - 3 * robot.joints
    for k in range(robot.joints):
        own = slice(stage + 3 * k, stage + 3 * k + 3)
        slope = J[own, robot.columns[k] : robot.columns[k] + 2].T @ left[own]
        assert np.max(np.abs(slope)) < STATIONARY
        rms = np.sqrt(np.mean(left[own] ** 2))
        assert abs(robot.consistency(q)[k] - rms) < INVERSE
    if robot.insertion:
        assert left[0] == 0.0


@pytest.mark.parametrize("cable", range(15))
def test_a_cable_that_reads_wrong_is_reported(cable: int) -> None:
    """Straight, an error of one of three cables leaves a third of it; no other module notices."""
    q = ROBOT.lengths(ROBOT.home)
    q[cable] += WRONG
    expected = np.zeros(5)
    expected[cable // 3] = WRONG / 3
    np.testing.assert_allclose(ROBOT.consistency(q), expected, rtol=0, atol=NONLINEAR)
    assert np.max(ROBOT.consistency(ROBOT.lengths(ROBOT.home))) < ROUNDING


def test_a_cable_that_reads_wrong_is_reported_in_bent_poses() -> None:
    """Up to 0.7 of the limit: where plates touch, a cable in between may explain the error."""
    rng = np.random.default_rng(2)
    for c in 0.7 * jointed_configurations(ROBOT, rng, 200):
        q, cable = ROBOT.lengths(c), int(rng.integers(15))
        q[cable] += rng.choice([-WRONG, WRONG])
        reported = ROBOT.consistency(q)
        assert 0.27 * WRONG < reported[cable // 3] < 0.4 * WRONG
        assert np.all(reported[: cable // 3] < INVERSE)


@pytest.mark.parametrize("size", [1e-2, 0.1, 1.0, 1e9, 1e100])
def test_lengths_that_make_no_sense_end_too(size: float) -> None:
    rng = np.random.default_rng(3)
    q = np.concatenate([rng.uniform(-size, size, (500, 15)), np.full((1, 15), size),
                        np.zeros((1, 15))])  # fmt: skip
    c = ROBOT.configuration(q)
    assert np.all(np.isfinite(c))
    assert np.max(np.abs(c)) <= np.pi / 2
    assert np.min(np.max(ROBOT.consistency(q), axis=-1)) > WRONG


def test_a_length_that_is_no_number_spoils_what_depends_on_it() -> None:
    c = jointed_configurations(ROBOT, np.random.default_rng(4), 2)[-1]
    q = ROBOT.lengths(c)
    q[7] = np.nan  # of module 3
    found = ROBOT.configuration(q)
    np.testing.assert_allclose(found[:4], c[:4], rtol=0, atol=INVERSE)
    assert np.all(np.isnan(found[4:]))
    assert np.all(np.isnan(ROBOT.consistency(q)[2:]))


# --- bend limits ----------------------------------------------------------------------------


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=60)
def test_plates_touch_at_the_largest_bend_allowed(robot: JointedRobot, seed: int) -> None:
    """At 2 atan(D / R) a point of the rim beyond is in the plane of the plate before."""
    rng = np.random.default_rng(seed)
    robot = replace(robot, insertion=None, T_w_b=np.eye(4))
    contact = 2 * np.arctan(robot.plate_offset / robot.radius)
    around = np.linspace(0.0, 2 * np.pi, 3601)
    rim = np.stack([robot.radius * np.cos(around), np.full_like(around, robot.plate_offset),
                    robot.radius * np.sin(around)], axis=1)  # fmt: skip
    for share in (0.9, 1.0, 1.1):
        c = np.zeros(2 * robot.joints)
        c[:2] = angles(np.array(share * contact), rng.uniform(-np.pi, np.pi))
        beyond = rim @ robot.module_poses(c)[0, :3, :3].T
        room = np.min(beyond[:, 1]) + robot.plate_offset
        assert np.sign(room) == np.sign(1.0 - share) or abs(room) < 1e-5 * robot.radius
        slack = robot.radius * (robot.bend_limit - share * contact)
        assert abs(robot.bend_slack(c)[0] - slack) < ROUNDING
