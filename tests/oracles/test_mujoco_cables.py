"""Cables and frames of jointed robots against MuJoCo: tendons through the same holes."""

from typing import Any, cast

import mujoco
import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.robots.jointed import JointedRobot, contact_bend
from sinuous.robots.parts import JointOrder, SpeedLimits
from sinuous.robots.robot_file import load_jointed

AGREE = 1e-12  # [m] what the issue asks for; MuJoCo computes with the same 16 digits
POSES = 1000
DIFFERS = 0.015  # [m] typically, between the two readings of (4) in poses of +-0.3 rad
AXES = {"theta": "0 0 1", "phi": "1 0 0"}


def model(robot: JointedRobot, alpha: Array) -> Any:
    """A robot for MuJoCo.

    Arguments:
        alpha: hole angles of the cables of module k in plate i (N, N + 1, 3), 0 the base plate
    """
    D, H, N = robot.plate_offset, robot.tube_length, robot.joints
    bodies = ""
    for i in range(N, 0, -1):
        hinges = "".join(f'<joint axis="{AXES[a]}"/>' for a in robot.orders[i - 1].angles)
        front = sites(robot, alpha, i, "front", D)
        rear = sites(robot, alpha, i, "rear", D + H)
        place = D if i == 1 else H + 2 * D
        bodies = (f'<body name="{i}" pos="0 {place!r} 0">{hinges}<geom size="0.01"/>'
                  f"{front}{rear}{bodies}</body>")  # fmt: skip
    tendons = ""
    for k in range(1, N + 1):
        for j in range(3):
            holes = [f"0 rear {k} {j}"]
            holes += [f"{i} {side} {k} {j}" for i in range(1, k + 1) for side in ("front", "rear")]
            way = "".join(f'<site site="{hole}"/>' for hole in holes)
            tendons += f"<spatial>{way}</spatial>"
    xml = (f'<mujoco><compiler angle="radian"/><worldbody>{sites(robot, alpha, 0, "rear", 0.0)}'
           f"{bodies}</worldbody><tendon>{tendons}</tendon></mujoco>")  # fmt: skip
    return cast(Any, mujoco).MjModel.from_xml_string(xml)


def sites(robot: JointedRobot, alpha: Array, plate: int, side: str, y: float) -> str:
    """Holes in a plate at y [m] in the frame of its body, for all cables that pass it."""
    found = ""
    for k in range(max(plate, 1), robot.joints + 1):
        for j in range(3):
            angle = alpha[k - 1, plate, j]
            x, z = float(robot.radius * np.cos(angle)), float(robot.radius * np.sin(angle))
            found += f'<site name="{plate} {side} {k} {j}" pos="{x!r} {y!r} {z!r}"/>'
    return found


def kept(robot: JointedRobot) -> Array:
    """A cable keeps its hole: k in (4) numbers its module."""
    k, j = np.arange(1, robot.joints + 1)[:, None, None], np.arange(3)
    alpha = k * 2 * np.pi / robot.holes + j * 2 * np.pi / 3
    return np.tile(alpha, (1, robot.joints + 1, 1))


def tendons_and_plates(robot: JointedRobot, alpha: Array, c: Array) -> tuple[Array, Array]:
    """Lengths of the tendons (B, P) and centres of the rear endplates (B, N, 3) [m]."""
    engine = cast(Any, mujoco)
    compiled = model(robot, alpha)
    data = engine.MjData(compiled)
    lengths, plates = list[Array](), list[Array]()
    back = np.array([0.0, robot.plate_offset + robot.tube_length, 0.0])
    for one in c:
        data.qpos[:] = one
        engine.mj_kinematics(compiled, data)
        engine.mj_comPos(compiled, data)
        engine.mj_tendon(compiled, data)
        lengths.append(data.ten_length.copy())
        R = data.xmat[1:].reshape(-1, 3, 3)
        plates.append(data.xpos[1:] + R @ back)
    return np.array(lengths), np.array(plates)


def made(joints: int, holes: int, orders: tuple[JointOrder, ...]) -> JointedRobot:
    return JointedRobot(
        name="made", joints=joints, holes=holes, radius=0.021, plate_offset=0.0093,
        tube_length=0.047, orders=orders, bend_limit=contact_bend(0.021, 0.0093),
        speed=SpeedLimits(cable=0.1),
    )  # fmt: skip


ZX, XZ = JointOrder.ZX, JointOrder.XZ
ROBOTS = {
    "qin2020": load_jointed("qin2020"),
    "alternate": made(4, 12, (ZX, XZ, ZX, XZ)),
    "other order": made(7, 21, (XZ,) * 7),
}


@pytest.mark.parametrize("name", ROBOTS)
def test_cables_are_tendons_through_the_same_holes(name: str) -> None:
    robot = ROBOTS[name]
    c = np.random.default_rng(0).uniform(-0.45, 0.45, (POSES, 2 * robot.joints))
    lengths, plates = tendons_and_plates(robot, kept(robot), c)
    np.testing.assert_allclose(robot.lengths(c), lengths, rtol=0, atol=AGREE)
    ours = robot.module_poses(c)[:, :, :3, 3]
    np.testing.assert_allclose(ours, plates, rtol=0, atol=AGREE)


def test_read_literally_the_hole_angle_makes_other_cables() -> None:
    """Notes A1: with i of (4) for the plate, as printed, (6) is no cable through fixed holes."""
    robot = ROBOTS["qin2020"]
    c = np.random.default_rng(1).uniform(-0.3, 0.3, (200, 10))
    lengths, _ = tendons_and_plates(robot, kept(robot), c)
    np.testing.assert_allclose(robot.lengths(c), lengths, rtol=0, atol=AGREE)
    literal = as_printed(robot, c)
    assert np.min(np.max(np.abs(literal - lengths), axis=1)) > 0.001
    assert np.median(np.max(np.abs(literal - lengths), axis=1)) > DIFFERS


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
