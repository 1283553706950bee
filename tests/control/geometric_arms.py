"""Jointed robots, their kinematics written once more, and targets for the geometric solution."""

from dataclasses import replace

import numpy as np
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.control.geometric_ik import GeometricIK
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.parts import Insertion, JointOrder, Tool
from sinuous.robots.robot_file import load_jointed

QIN = load_jointed("qin2020")
IK = GeometricIK(QIN)
D, H = 0.012, 0.106  # printed [m]
L = H + 2.0 * D
Y = np.array([0.0, 1.0, 0.0])


def random_arm(*, seed: int, orders: list[JointOrder], insertion: bool, tool: bool) -> JointedRobot:
    """A robot of other sizes anywhere in the world."""
    rng = np.random.default_rng(seed)
    T = np.eye(4)
    T[:3, :3] = Rotation.random(rng=rng).as_matrix()
    T[:3, 3] = rng.uniform(-0.3, 0.3, 3)
    plate_offset = rng.uniform(0.005, 0.02)
    return replace(
        QIN,
        joints=len(orders),
        orders=tuple(orders),
        holes=3 * len(orders),
        radius=2.0 * plate_offset,
        plate_offset=plate_offset,
        tube_length=rng.uniform(0.02, 0.2),
        bend_limit=0.9,
        insertion=Insertion(travel=(0.0, 0.2), home=0.05, radius=0.01) if insertion else None,
        tool=Tool(offset=(0.0, rng.uniform(0.01, 0.1), 0.0), radius=0.003) if tool else None,
        T_w_b=T,
    )


arms = st.builds(
    random_arm,
    seed=st.integers(0, 2**32 - 1),
    orders=st.lists(st.sampled_from(JointOrder), min_size=3, max_size=8),
    insertion=st.booleans(),
    tool=st.booleans(),
)


def joint_centres(robot: JointedRobot, c: Array) -> tuple[Array, Array]:
    """A_1 to A_N and the tip (N + 1, 3) [m], and directions of the links (N, 3), in the base."""
    angles = c[-2 * robot.joints :].reshape(-1, 2)
    held = c[0] if robot.insertion else 0.0
    end = robot.tool.offset[1] if robot.tool else 0.0
    turned, places = Rotation.identity(), [(held + robot.plate_offset) * Y]
    directions = list[Array]()
    for order, pair in zip(robot.orders, angles, strict=True):
        turned = turned * Rotation.from_euler(order.value.upper(), pair)
        directions.append(turned.apply(Y))
        places.append(places[-1] + (robot.tube_length + 2.0 * robot.plate_offset) * directions[-1])
    places[-1] += (end - robot.plate_offset) * directions[-1]
    return np.array(places), np.array(directions)


def to_world(robot: JointedRobot, points: Array) -> Array:
    """Points (..., 3) of the base in the world."""
    return points @ robot.T_w_b[:3, :3].T + robot.T_w_b[:3, 3]


def reference(robot: JointedRobot, chi: float, held: float = 0.0) -> Array:
    """A_1,r to A_N,r (N, 3) [m] in the base."""
    step = (robot.tube_length + 2.0 * robot.plate_offset) * np.array(
        [0.0, np.cos(chi), np.sin(chi)]
    )
    return (held + robot.plate_offset) * Y + np.arange(robot.joints)[:, None] * step


def in_disc(rng: np.random.Generator, radius: float, count: int) -> Array:
    """Points (count, 2) [m] spread evenly over a disc."""
    r, a = radius * np.sqrt(rng.uniform(size=count)), rng.uniform(0.0, 2.0 * np.pi, count)
    return np.stack([r * np.cos(a), r * np.sin(a)], axis=1)
