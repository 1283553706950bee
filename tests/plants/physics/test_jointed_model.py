"""The MuJoCo model of a jointed robot: same cables, same frames, the masses that were stated."""

from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.plants.physics.assembly import assembled, compiled
from sinuous.plants.physics.engine import require_mujoco
from sinuous.plants.physics.jointed_model import JointedBody
from sinuous.robots.jointed import JointedRobot, contact_bend
from sinuous.robots.mechanics import JointedMechanics
from sinuous.robots.parts import Insertion, JointOrder, SpeedLimits, Tool
from sinuous.robots.robot_file import load_jointed

AGREE = 1e-12  # [m] MuJoCo computes with the same 16 digits
POSES = 1000
DIFFERS = 0.015  # [m] typically, between the two readings of (4) in poses of +-0.3 rad


def made(joints: int, holes: int, orders: tuple[JointOrder, ...], **fields: Any) -> JointedRobot:
    return JointedRobot(
        name="made", joints=joints, holes=holes, radius=0.021, plate_offset=0.0093,
        tube_length=0.047, orders=orders, bend_limit=contact_bend(0.021, 0.0093),
        speed=SpeedLimits(cable=0.1), **fields,
    )  # fmt: skip


ZX, XZ = JointOrder.ZX, JointOrder.XZ
ROBOTS = {
    "qin2020": load_jointed("qin2020"),
    "alternate": made(4, 12, (ZX, XZ, ZX, XZ)),
    "other order": made(7, 21, (XZ,) * 7),
}


class Posed:
    """A robot's model in one configuration after the other, without any physics."""

    def __init__(self, robot: JointedRobot) -> None:
        self.body = JointedBody(robot=robot)
        self.mujoco = require_mujoco()
        self.model = compiled(assembled(self.body))
        self.data = self.mujoco.MjData(self.model)

    def at(self, c: Array) -> Any:
        """What MuJoCo makes of a configuration (n,)."""
        self.body.pose(self.model, self.data, c)
        self.mujoco.mj_kinematics(self.model, self.data)
        self.mujoco.mj_comPos(self.model, self.data)
        self.mujoco.mj_tendon(self.model, self.data)
        return self.data


@pytest.mark.parametrize("name", ROBOTS)
def test_tendons_are_as_long_as_cables(name: str) -> None:
    robot = ROBOTS[name]
    posed = Posed(robot)
    c = np.random.default_rng(0).uniform(-0.45, 0.45, (POSES, 2 * robot.joints))
    tendons = np.array([posed.at(one).ten_length.copy() for one in c])
    wanted = posed.body.cable_lengths(robot.lengths(c))
    np.testing.assert_allclose(tendons, wanted, rtol=0, atol=AGREE)


def test_read_literally_the_hole_angle_makes_other_cables() -> None:
    """Notes A1: with i of (4) for the plate, as printed, (6) is no cable through fixed holes."""
    robot = ROBOTS["qin2020"]
    posed = Posed(robot)
    c = np.random.default_rng(1).uniform(-0.3, 0.3, (200, 10))
    tendons = np.array([posed.at(one).ten_length.copy() for one in c])
    apart = np.max(np.abs(as_printed(robot, c) - tendons), axis=1)
    assert np.min(apart) > 0.001
    assert np.median(apart) > DIFFERS


def as_printed(robot: JointedRobot, c: Array) -> Array:
    """(4)-(7) word by word: L_kj = sum of |T p_ij - p_(i-1)j| + H for i from 1 to k (B, P)."""
    i, j = np.arange(robot.joints + 1)[:, None], np.arange(3)
    alpha = i * 2 * np.pi / robot.holes + j * 2 * np.pi / 3
    p = robot.radius * np.stack([np.cos(alpha), 0 * alpha, np.sin(alpha)], axis=-1)
    half = np.array([0.0, robot.plate_offset, 0.0])
    theta, phi = c[:, ::2, None], c[:, 1::2, None]
    x, y, z = np.moveaxis(p[1:] + half, -1, 0)
    y, z = np.cos(phi) * y - np.sin(phi) * z, np.sin(phi) * y + np.cos(phi) * z
    x, y = np.cos(theta) * x - np.sin(theta) * y, np.sin(theta) * x + np.cos(theta) * y
    gap = np.stack([x, y, z], axis=-1) + half - p[:-1]
    stretches = np.linalg.norm(gap, axis=-1) + robot.tube_length
    return np.cumsum(stretches, axis=1).reshape(len(c), -1)


def test_holes_are_where_the_paper_puts_them() -> None:
    """Module k's cable j at k 2 pi / M + j 2 pi / 3 in every plate that it passes (4), (5)."""
    robot = ROBOTS["alternate"]
    data = Posed(robot).at(robot.home)
    for k in range(1, 5):
        for j in range(3):
            angle = 2 * np.pi * (k / robot.holes + j / 3)
            x, z = robot.radius * np.cos(angle), robot.radius * np.sin(angle)
            plates = [f"plate 0 rear hole {k} {j + 1}"]
            plates += [f"plate {i} {s} hole {k} {j + 1}" for i in range(1, k + 1) for s in SIDES]
            y = [0.0, *(i * robot.link_length + d for i in range(k) for d in sides(robot))]
            found = [data.site(name).xpos for name in plates]
            np.testing.assert_allclose(found, [[x, at, z] for at in y], rtol=0, atol=AGREE)


SIDES = ("front", "rear")


def sides(robot: JointedRobot) -> tuple[float, float]:
    """Where the plates of a module are, from the rear plate before it [m]."""
    front = 2 * robot.plate_offset
    return front, front + robot.tube_length


def test_stage_tool_and_pose_of_the_base_are_in_the_model() -> None:
    stage, tool = Insertion(travel=(0.0, 0.2), home=0.05, radius=0.004), (0.01, 0.02, -0.015)
    T_w_b = np.eye(4)
    T_w_b[:3, :3] = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_matrix()
    T_w_b[:3, 3] = 0.1, -0.2, 0.3
    robot = made(
        3, 9, (ZX, XZ, ZX), insertion=stage, tool=Tool(offset=tool, radius=0.003), T_w_b=T_w_b
    )
    posed, rng = Posed(robot), np.random.default_rng(2)
    for travel in (0.0, 0.05, 0.2):
        c = np.concatenate([[travel], rng.uniform(-0.4, 0.4, 6)])
        data = posed.at(c)
        wanted = posed.body.cable_lengths(robot.lengths(c))
        np.testing.assert_allclose(data.ten_length, wanted, rtol=0, atol=AGREE)
        points, T_w_t = posed.body.shape(data)
        np.testing.assert_allclose(points, robot.points(c), rtol=0, atol=AGREE)
        tip = data.body(posed.body.tip_body)
        np.testing.assert_allclose(tip.xpos, robot.tip(c), rtol=0, atol=AGREE)
        np.testing.assert_allclose(tip.xmat.reshape(3, 3), T_w_t[:3, :3], rtol=0, atol=AGREE)


def test_modules_weigh_what_was_stated_and_turn_like_thin_tubes() -> None:
    """A ring of many point masses has the same inertia about the tube's centre."""
    mechanics = JointedMechanics(module_mass=0.3)
    robot = made(3, 9, (ZX,) * 3, mechanics=mechanics)
    posed = Posed(robot)
    data, model = posed.at(robot.home), posed.model
    assert np.sum(model.body_mass) == pytest.approx(0.9)
    angle = np.linspace(0, 2 * np.pi, 400, endpoint=False)
    along = (np.arange(400) + 0.5) / 400 - 0.5
    x, y = np.meshgrid(robot.radius * np.cos(angle), robot.tube_length * along)
    z = np.meshgrid(robot.radius * np.sin(angle), along)[0]
    ring = 0.3 * np.array([np.mean(y**2 + z**2), np.mean(x**2 + z**2), np.mean(x**2 + y**2)])
    for i in range(1, 4):
        body = data.body(f"module {i}")
        np.testing.assert_allclose(model.body_inertia[body.id], ring, rtol=1e-5)
        centre = i * robot.link_length - 0.5 * robot.tube_length
        assert body.xipos[1] == pytest.approx(centre, abs=AGREE)
