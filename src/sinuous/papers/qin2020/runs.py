"""Runs of the paper's scenarios, and the robot of all experiments."""

from functools import lru_cache
from pathlib import Path

from sinuous.control.geometric_ik import GeometricIK
from sinuous.robots.robot_file import load_jointed
from sinuous.scenario import Scenario, load_scenario

SCENARIOS = Path(__file__).parent / "scenarios"

BOUNDARY = 0.18
"""Printed, on both axes and to either side [m]."""


DELAY = 0.2
"""Printed, one way [s]."""

SCALE = 2.25
"""Representative: metres of the follower by metre of the leader."""


def scenario(name: str, *changes: str) -> Scenario:
    """A scenario of the paper, with some of its fields changed."""
    return load_scenario(SCENARIOS / f"{name}.toml", set=changes)


@lru_cache
def inverse() -> GeometricIK:
    """The paper's robot with its inverse kinematics, the same for all in a process."""
    return GeometricIK(load_jointed("qin2020"))
