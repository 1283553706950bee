"""Jointed robots and their configurations of every kind that the package allows."""

import numpy as np
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.robots.chain_robot import ChainRobot
from sinuous.robots.jointed import JointedRobot, contact_bend
from sinuous.robots.parts import Insertion, JointOrder, SpeedLimits, Tool
from sinuous.robots.pcc import PccRobot

from .random_robots import configurations, random_pose, robots


def random_jointed(*, seed: int, joints: int, insertion: bool, tool: bool) -> JointedRobot:
    """A robot of so many modules of any size, its joints turning in any order."""
    rng = np.random.default_rng(seed)
    x, y, z = rng.uniform(-0.02, 0.02, 3)
    radius = rng.uniform(0.01, 0.05)
    plate_offset = radius * rng.uniform(0.15, 0.6)
    return JointedRobot(
        name="random",
        joints=joints,
        holes=3 * (joints + int(rng.integers(4))),
        radius=radius,
        plate_offset=plate_offset,
        tube_length=rng.uniform(0.02, 0.15),
        orders=tuple(rng.choice(list(JointOrder), joints)),
        bend_limit=contact_bend(radius, plate_offset) * rng.uniform(0.5, 1.0),
        speed=SpeedLimits(cable=0.2, insertion=0.03),
        insertion=Insertion(travel=(0.0, 0.2), home=0.05, radius=0.004) if insertion else None,
        tool=Tool(offset=(x, y, z), radius=0.003) if tool else None,
        spacing=rng.uniform(0.005, 0.02),
        T_w_b=random_pose(rng),
    )


def angles(bend: Array, direction: Array) -> Array:
    """Angles (..., 2) of joints that are bent so far, each towards any side [rad].

    The direction is that of the link beyond, in the plane of the plate before: 0 is where the
    first angle leans it, a quarter turn where the second one does.
    """
    first = np.arctan2(np.sin(bend) * np.cos(direction), np.cos(bend))
    return np.stack([first, np.arcsin(np.sin(bend) * np.sin(direction))], axis=-1)


def jointed_configurations(robot: JointedRobot, rng: np.random.Generator, count: int) -> Array:
    """Configurations (count, n) within the limits of travel and bend.

    In every third one all joints are nearly straight, by 1e-9 to 1e-3 rad; one is straight.
    """
    shape = (count, robot.joints)
    bend = robot.bend_limit * np.sqrt(rng.uniform(size=shape))
    bend[::3] = 10.0 ** rng.uniform(-9.0, -3.0, bend[::3].shape)
    bend[0] = 0.0
    q = angles(bend, rng.uniform(-np.pi, np.pi, shape)).reshape(count, -1)
    if robot.insertion is None:
        return q
    return np.concatenate([rng.uniform(*robot.insertion.travel, (count, 1)), q], axis=1)


jointed_robots = st.builds(
    random_jointed,
    seed=st.integers(0, 2**32 - 1),
    joints=st.integers(1, 6),
    insertion=st.booleans(),
    tool=st.booleans(),
)
any_robots = st.one_of(robots, jointed_robots)


def any_configurations(robot: ChainRobot, rng: np.random.Generator, count: int) -> Array:
    """Configurations (count, n) of either kind of robot."""
    if isinstance(robot, JointedRobot):
        return jointed_configurations(robot, rng, count)
    assert isinstance(robot, PccRobot)
    return configurations(robot, rng, count)
