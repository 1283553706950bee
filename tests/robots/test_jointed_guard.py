"""Guarding tubes, plates and cables of jointed robots from some points on the centre line."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.jointed_cables import hole_angles, hole_offsets
from sinuous.robots.parts import Insertion, Tool
from sinuous.robots.robot_file import load_jointed

from .random_jointed import angles, jointed_configurations, jointed_robots
from .random_robots import seeds
from .test_jointed import literal_poses
from .test_pcc import ROUNDING

ROBOT = load_jointed("qin2020")
ALONG = np.linspace(0.0, 1.0, 17)
AROUND = np.linspace(0.0, 2.0 * np.pi, 25)[:-1]


def surface(robot: JointedRobot, c: Array) -> Array:
    """Points (K, 3) [m] on tubes with their plates, and of all cables between plates."""
    _, rear = literal_poses(robot, c)
    base = np.array(robot.T_w_b)
    if robot.insertion:
        base[:3, 3] += c[0] * base[:3, 1]
    found = list[Array]()
    holes = hole_offsets(hole_angles(robot.joints, robot.holes), robot.radius)
    around = hole_offsets(AROUND, robot.radius)
    for i, (before, T) in enumerate(zip([base, *rear], rear, strict=False)):
        y = np.array([0.0, robot.tube_length, 0.0])
        for share in ALONG:
            found.append((around - share * y) @ T[:3, :3].T + T[:3, 3])
        own = np.concatenate([holes[i:].reshape(-1, 3), around])  # any hole may have a cable
        start = own @ before[:3, :3].T + before[:3, 3]
        end = (own - y) @ T[:3, :3].T + T[:3, 3]
        found += [start + share * (end - start) for share in ALONG]
    return np.concatenate(found)


def least_room(robot: JointedRobot, required: Array, c: Array, places: Array) -> float:
    """By how much places (K, 3) are inside the balls of `required` (S,) around the points [m]."""
    gaps = np.linalg.norm(places[:, None] - robot.points(c), axis=2)
    return float(np.min(np.max(required - gaps, axis=1)))


def outward(robot: JointedRobot, c: Array, places: Array) -> Array:
    """Unit vectors (K, 3) away from the centre line, which has its corners at the joints."""
    centres, rear = literal_poses(robot, c)
    start = centres[0] - robot.plate_offset * robot.T_w_b[:3, 1]
    corners = np.array([start, *centres, rear[-1][:3, 3]])
    way = np.diff(corners, axis=0)
    share = np.einsum("ksd,sd->ks", places[:, None] - corners[:-1], way) / np.sum(way**2, axis=1)
    feet = corners[:-1] + np.clip(share, 0.0, 1.0)[..., None] * way
    away = places[:, None] - feet
    nearest = np.argmin(np.linalg.norm(away, axis=2), axis=1)
    away = away[np.arange(len(places)), nearest]
    return away / np.linalg.norm(away, axis=1, keepdims=True)


@given(robot=jointed_robots, seed=seeds, margin=st.sampled_from([0.0, 0.003, 0.02]))
@settings(max_examples=40)
def test_guarded_points_keep_the_whole_body_at_the_margin(
    robot: JointedRobot, seed: int, margin: float
) -> None:
    """All that is within the margin of the body is within the distances of guarded points."""
    rng, required = np.random.default_rng(seed), robot.required_distance(margin)
    for c in jointed_configurations(robot, rng, 3):
        body = surface(robot, c)
        for spread in (0.0, 0.3):
            towards = outward(robot, c, body) + spread * rng.normal(size=body.shape)
            towards /= np.linalg.norm(towards, axis=1, keepdims=True)
            assert least_room(robot, required, c, body + margin * towards) > -2 * ROUNDING


def bent_at_a_hole(bend: float) -> Array:
    """All joints bent towards the first cable of their module."""
    alpha = hole_angles(5, 18)[:, 0]
    return angles(np.full(5, bend), np.arctan2(np.sin(alpha), -np.cos(alpha))).ravel()


def test_cables_bow_out_beyond_the_tubes() -> None:
    """The other side: with the tubes' radius alone a cable leaves the guarded region."""
    bend = np.arctan(ROBOT.plate_offset / ROBOT.radius)  # where cables bow out most
    c = bent_at_a_hole(bend)
    body = surface(ROBOT, c)
    half = 0.5 * ROBOT.spacing
    naive = np.full(len(ROBOT.radii), np.hypot(ROBOT.radius, half))
    assert least_room(ROBOT, naive, c, body) < -0.5e-3
    assert least_room(ROBOT, ROBOT.required_distance(0.0), c, body) > -ROUNDING


def test_the_bow_is_the_one_derived() -> None:
    """R cos^2(b/2) + D sin(b/2) cos(b/2) from the link's axis, at most (R + hypot(R, D)) / 2."""
    R, D = ROBOT.radius, ROBOT.plate_offset
    largest = 0.5 * (R + np.hypot(R, D))
    robot = replace(ROBOT, joints=4, holes=12, orders=ROBOT.orders[:4])
    hole = hole_offsets(hole_angles(4, 12), R)[2, 0]  # of module 3, towards z: no twist
    bows = list[float]()
    for b in np.linspace(0.0, robot.bend_limit, 200):
        c = robot.home
        c[5] = b
        before, beyond = robot.module_poses(c)[[1, 2]]
        end = beyond[:3, :3] @ (hole - [0.0, robot.tube_length, 0.0]) + beyond[:3, 3]
        middle = 0.5 * (end + before[:3, 3] + before[:3, :3] @ hole)
        bows.append(np.hypot(middle[0], middle[2]))  # the link before lies on the y axis
        expected = R * np.cos(b / 2) ** 2 + D * np.sin(b / 2) * np.cos(b / 2)
        assert abs(bows[-1] - expected) < ROUNDING
    assert max(bows) <= largest + ROUNDING
    assert max(bows) > largest - 1e-6


@pytest.mark.parametrize("margin", [0.0, 0.003])
def test_required_distance_wastes_little(margin: float) -> None:
    """0.6 mm along the tubes, 1.6 mm at the joints, where cables may bow out by 1 mm."""
    waste = ROBOT.required_distance(margin) - margin - ROBOT.radius
    names = [ROBOT.point_name(i) for i in range(len(waste))]
    at_joints = np.array(["joint" in name for name in names])
    at_joints[ROBOT.disk_indices[1::2]] = True  # plates belong to tube and joint
    at_joints[-1] = False
    assert np.all(waste > 0.0)
    assert np.max(waste[~at_joints]) < 0.6e-3
    assert np.max(waste) < 1.6e-3


def test_tubes_are_the_stretches_between_plates() -> None:
    stage = Insertion(travel=(0.0, 0.1), home=0.0, radius=0.01)
    robot = replace(ROBOT, insertion=stage, tool=Tool(offset=(0.0, 0.05, 0.0), radius=0.01))
    shaft, *tubes = robot.tubes.tolist()
    plates = robot.disk_indices.reshape(-1, 2)
    assert tubes == plates.tolist()
    assert shaft == [0, 9]  # 12 mm apart at most
    lengths = np.linalg.norm(np.diff(robot.points(robot.home)[plates], axis=1), axis=2)
    np.testing.assert_allclose(lengths, 0.106, rtol=0, atol=ROUNDING)
    assert np.count_nonzero(~robot.movable) == 1  # the base plate, where the shaft begins
