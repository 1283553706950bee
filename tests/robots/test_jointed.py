"""The body of jointed robots: against products of rotations, closed forms and differences."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given, settings
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.plants.fibre import ShapeSensing
from sinuous.plants.kinematic import KinematicPlant
from sinuous.plants.mismatched import MismatchedPlant
from sinuous.robots.jointed import JointedRobot, contact_bend
from sinuous.robots.parts import Insertion, JointOrder, SpeedLimits, Tool
from sinuous.robots.robot_file import load_jointed

from .random_jointed import jointed_configurations, jointed_robots
from .random_robots import random_pose, seeds
from .test_pcc import JACOBIAN, ROUNDING, jacobian_error, translation

CONFIGURATIONS = 4  # per generated robot, two of them near the straight shape
INTEGRATED = 1e-9  # [m or rad] 500 sums of lengths, over a pitch radius, times the arm
ROBOT = load_jointed("qin2020")
AXES = {"theta": "Z", "phi": "X"}


def literal_poses(robot: JointedRobot, c: Array) -> tuple[list[Array], list[Array]]:
    """Joint centres, and poses of the rear endplates, multiplied out as (1), (2) and (9) say."""
    T, values = robot.T_w_b, list(c)
    if robot.insertion:
        T = T @ translation(0.0, values.pop(0), 0.0)
    half, tube = translation(0.0, robot.plate_offset, 0.0), translation(0.0, robot.tube_length, 0.0)
    centres, poses = list[Array](), list[Array]()
    for order in robot.orders:
        turn = np.eye(4)
        named = "".join(AXES[angle] for angle in order.angles)  # capitals: about the moving axes
        turn[:3, :3] = Rotation.from_euler(named, [values.pop(0), values.pop(0)]).as_matrix()
        centres.append((T @ half)[:3, 3])
        T = T @ half @ turn @ half @ tube
        poses.append(T)
    return centres, poses


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=60)
def test_module_frames_are_the_printed_products(robot: JointedRobot, seed: int) -> None:
    """(1), (2), (9), with scipy's rotations for (3)."""
    for c in jointed_configurations(robot, np.random.default_rng(seed), CONFIGURATIONS):
        centres, poses = literal_poses(robot, c)
        np.testing.assert_allclose(robot.module_poses(c), poses, rtol=0, atol=ROUNDING)
        gaps = np.linalg.norm(robot.points(c)[:, None] - np.array(centres), axis=2)
        assert np.max(np.min(gaps, axis=0)) < ROUNDING  # every joint is a guarded point
        last = poses[-1] @ translation(*robot.tool.offset) if robot.tool else poses[-1]
        np.testing.assert_allclose(robot.tip_pose(c), last, rtol=0, atol=ROUNDING)
        np.testing.assert_allclose(robot.points(c)[-1], last[:3, 3], rtol=0, atol=ROUNDING)


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=60)
def test_jacobian_matches_differences(robot: JointedRobot, seed: int) -> None:
    for c in jointed_configurations(robot, np.random.default_rng(seed), CONFIGURATIONS):
        assert jacobian_error(robot, c) < JACOBIAN


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=30)
def test_base_pose_carries_everything_along(robot: JointedRobot, seed: int) -> None:
    rng = np.random.default_rng(seed)
    c, T = jointed_configurations(robot, rng, CONFIGURATIONS), random_pose(rng)
    plain, moved = robot.at(np.eye(4)), robot.at(T)
    expected = plain.points(c) @ T[:3, :3].T + T[:3, 3]
    np.testing.assert_allclose(moved.points(c), expected, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(
        moved.module_poses(c), T @ plain.module_poses(c), rtol=0, atol=ROUNDING
    )
    assert np.array_equal(moved.lengths(c), robot.lengths(c))


@given(robot=jointed_robots, seed=seeds)
@settings(max_examples=30)
def test_leading_batch_dimensions(robot: JointedRobot, seed: int) -> None:
    c = jointed_configurations(robot, np.random.default_rng(seed), 6).reshape(2, 3, -1)
    functions = (robot.points, robot.points_jacobian, robot.tip, robot.tip_pose,
                 robot.module_poses, robot.lengths, robot.bend_slack,
                 lambda c: robot.shape(c)[0], lambda c: robot.shape(c)[1],
                 lambda c: robot.configuration(robot.lengths(c)),
                 lambda c: robot.consistency(robot.lengths(c)))  # fmt: skip
    for function in functions:
        batch = function(c)
        assert batch.shape[:2] == (2, 3)
        for i, j in np.ndindex(2, 3):
            np.testing.assert_allclose(batch[i, j], function(c[i, j]), rtol=0, atol=ROUNDING)
    points, T_w_t = robot.shape(c)
    assert np.array_equal(points, robot.points(c))
    assert np.array_equal(T_w_t, robot.tip_pose(c))


# --- closed forms ---------------------------------------------------------------------------


def test_the_straight_robot_lies_on_the_y_axis() -> None:
    points, L = ROBOT.points(ROBOT.home), 0.130
    assert np.all(points[:, [0, 2]] == 0.0)
    assert np.all(np.diff(points[:, 1]) > 0.0)
    assert np.all(np.diff(points[:, 1]) <= ROBOT.spacing + ROUNDING)
    np.testing.assert_allclose(points[-1], [0.0, 5 * L, 0.0], rtol=0, atol=ROUNDING)
    plates = np.ravel([[k * L + 0.024, (k + 1) * L] for k in range(5)])
    np.testing.assert_allclose(points[ROBOT.disk_indices, 1], plates, rtol=0, atol=ROUNDING)


@pytest.mark.parametrize("joint", range(5))
@pytest.mark.parametrize(("angle", "towards"), [(0, [-1.0, 0.0, 0.0]), (1, [0.0, 0.0, 1.0])])
def test_one_joint_bent_in_one_plane(joint: int, angle: int, towards: list[float]) -> None:
    """What is beyond the joint swings about its centre: theta towards -x, phi towards z."""
    c, bend = ROBOT.home, 0.4
    c[2 * joint + angle] = bend
    reach = (5 - joint) * 0.130 - 0.012
    swung = np.cos(bend) * np.array([0.0, 1.0, 0.0]) + np.sin(bend) * np.array(towards)
    centre = np.array([0.0, joint * 0.130 + 0.012, 0.0])
    np.testing.assert_allclose(ROBOT.tip(c), centre + reach * swung, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(ROBOT.tip_pose(c)[:3, 1], swung, rtol=0, atol=ROUNDING)


def test_alternate_joints_turn_in_the_other_order() -> None:
    """Notes A2: (15) is no other way to write (14); each joint has its own order."""
    theta, phi = 0.5, 0.4
    zx = replace(ROBOT, joints=1, orders=(JointOrder.ZX,))
    xz = replace(ROBOT, joints=1, orders=(JointOrder.XZ,))
    s, c = np.sin([theta, phi]), np.cos([theta, phi])
    np.testing.assert_allclose(
        zx.tip_pose([theta, phi])[:3, 1], [-s[0] * c[1], c[0] * c[1], s[1]], rtol=0, atol=ROUNDING
    )
    np.testing.assert_allclose(
        xz.tip_pose([phi, theta])[:3, 1], [-s[0], c[0] * c[1], c[0] * s[1]], rtol=0, atol=ROUNDING
    )
    assert np.linalg.norm(zx.tip([theta, phi]) - xz.tip([phi, theta])) > 0.007  # of 118 mm
    assert zx.coordinate_names == ("joint 1 theta", "joint 1 phi")
    assert xz.coordinate_names == ("joint 1 phi", "joint 1 theta")


@pytest.mark.parametrize("travel", [0.0, 0.03, 0.2])
def test_stage_and_tool(travel: float) -> None:
    """The stage pushes along y; the tool sits in the frame of the last plate."""
    T, offset = random_pose(np.random.default_rng(4)), (0.004, 0.05, -0.002)
    robot = replace(
        ROBOT,
        insertion=Insertion(travel=(0.0, 0.2), home=0.1, radius=0.01),
        tool=Tool(offset=offset, radius=0.002),
        T_w_b=T,
    )
    c = jointed_configurations(robot, np.random.default_rng(5), 2)[-1]
    c[0] = travel
    bare = ROBOT.at(T @ translation(0.0, travel, 0.0))
    last = bare.tip_pose(c[1:])
    expected = last[:3, 3] + last[:3, :3] @ offset
    np.testing.assert_allclose(robot.tip(c), expected, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(robot.module_poses(c), bare.module_poses(c[1:]), rtol=0,
                               atol=ROUNDING)  # fmt: skip
    assert np.array_equal(robot.lengths(c)[1:], ROBOT.lengths(c[1:]))
    assert (robot.actuator_names[0], robot.coordinate_names[0]) == ("insertion", "insertion")
    assert robot.home[0] == 0.1
    assert robot.length_limits[0].tolist() == [0.0, 0.2]
    assert robot.point_name(len(robot.radii) - 1) == "100% of the tool"


# --- the preset -----------------------------------------------------------------------------


def test_qin2020() -> None:
    assert (ROBOT.joints, ROBOT.holes) == (5, 18)
    assert (ROBOT.radius, ROBOT.plate_offset, ROBOT.tube_length) == (0.0338, 0.012, 0.106)
    assert ROBOT.link_length == pytest.approx(0.130, rel=1e-15)
    assert ROBOT.orders == (JointOrder.ZX,) * 5
    assert np.degrees(ROBOT.bend_limit) == pytest.approx(39.1, abs=0.05)  # as the notes round it
    assert len(ROBOT.home) == 10
    assert len(ROBOT.actuator_names) == 15
    assert ROBOT.actuator_names[3] == "module 2 cable 1"
    assert ROBOT.bend_names[-1] == "joint 5 bend"
    assert np.all(np.isinf(ROBOT.length_limits))
    assert np.all(np.isinf(ROBOT.coordinate_limits))
    assert np.array_equal(ROBOT.rate_limits, np.tile([-0.2, 0.2], (15, 1)))
    names = [ROBOT.point_name(i) for i in (1, 2, 3, len(ROBOT.radii) - 1)]
    assert names == ["100% of the near half of joint 1", "100% of the far half of joint 1",
                     "11% of module 1", "100% of module 5"]  # fmt: skip


def test_cable_limits_of_each_module() -> None:
    pairs = tuple((0.1 * k, 0.2 * k) for k in range(1, 6))
    limits = replace(ROBOT, cable_lengths=pairs).length_limits
    assert np.array_equal(limits, np.repeat(pairs, 3, axis=0))


# --- what it does not allow -----------------------------------------------------------------


@pytest.mark.parametrize(
    ("fields", "message"),
    [
        ({"joints": 0, "orders": ()}, "a robot needs a joint or more, not 0"),
        ({"holes": 17}, "holes must be a multiple of 3 and at least 15"),
        ({"holes": 12}, "holes must be a multiple of 3 and at least 15"),
        ({"radius": -0.01}, "radius must be a positive length, not -0.01"),
        ({"plate_offset": 0.0}, "plate_offset must be a positive length, not 0.0"),
        ({"tube_length": np.nan}, "tube_length must be a positive length, not nan"),
        ({"bend_limit": 0.69}, "bend_limit must be above 0 and at most 0.682297"),
        ({"bend_limit": 0.0}, "bend_limit must be above 0"),
        ({"orders": (JointOrder.ZX,) * 4}, "5 joints have as many orders, not 4"),
        ({"cable_lengths": ((0.1, 0.2),)}, "cable_lengths must be none or one pair for each of 5"),
    ],
)
def test_numbers_that_make_no_robot(fields: dict[str, object], message: str) -> None:
    with pytest.raises(ValueError, match=message):
        replace(ROBOT, **fields)


def test_fewest_modules_and_holes() -> None:
    robot = JointedRobot(
        name="one", joints=1, holes=3, radius=0.03, plate_offset=0.01, tube_length=0.1,
        orders=(JointOrder.XZ,), bend_limit=contact_bend(0.03, 0.01), speed=SpeedLimits(cable=0.1),
    )  # fmt: skip
    np.testing.assert_allclose(robot.lengths(robot.home), [0.12] * 3, rtol=1e-15)


def test_instruments_of_smooth_robots_refuse_it() -> None:
    with pytest.raises(ValueError, match="a mismatch is one of bending segments"):
        MismatchedPlant(ROBOT, seed=0)
    with pytest.raises(ValueError, match="a fibre follows bending segments"):
        ShapeSensing(robot=ROBOT)


def test_the_exact_plant_follows_cables_and_knows_no_curvature() -> None:
    plant, rng = KinematicPlant(ROBOT, seed=0), np.random.default_rng(3)
    c = jointed_configurations(ROBOT, rng, 2)[-1]
    rates = (ROBOT.lengths(c) - ROBOT.lengths(ROBOT.home)) / 0.5
    for _ in range(500):
        plant.step(rates, 1e-3)
    np.testing.assert_allclose(plant.truth.points, ROBOT.points(c), rtol=0, atol=INTEGRATED)
    np.testing.assert_allclose(plant.truth.T_w_t, ROBOT.tip_pose(c), rtol=0, atol=INTEGRATED)
    assert plant.truth.curvature.shape == (0, 2)
