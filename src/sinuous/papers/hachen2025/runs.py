"""Runs of the paper's scenarios: which controllers, which targets, for how long."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from sinuous.arrays import Array
from sinuous.recording import Recording
from sinuous.robots.robot import Robot
from sinuous.scenario import Scenario, load_scenario
from sinuous.scenario.path import follow
from sinuous.session import run

SCENARIOS = Path(__file__).parent / "scenarios"

# How far random configurations bend [rad] and stretch [m] from home, one standard deviation.
BEND, STRETCH = 0.5, 0.012


def scenario(name: str, *changes: str) -> Scenario:
    """A scenario of the paper, with some of its fields changed."""
    return load_scenario(SCENARIOS / f"{name}.toml", set=changes)


def held(base: Scenario, target: Array, duration: float, seed: int) -> Recording:
    """A run to one target (3,) [m] that lasts a duration [s], at rest or not."""

    def fixed(_: float) -> Array:
        return target

    path = follow(fixed, duration=duration, max_steps=0)
    return run(replace(base, path=path, seed=seed)).recording


def sampled_targets(robot: Robot, count: int, seed: int) -> Array:
    """Tips (count, 3) [m] of random configurations that the robot's limits allow."""
    return np.array([robot.tip(c) for c in sampled_configurations(robot, count, seed)])


def sampled_configurations(robot: Robot, count: int, seed: int) -> Array:
    """Random configurations (count, n) that the robot's limits allow.

    Segments bend by normally distributed angles and have normally distributed lengths.
    """
    rng, found = np.random.default_rng(seed), list[Array]()
    bends = robot.bend_limits.column
    spread = np.full(len(robot.home), STRETCH)
    spread[bends] = spread[bends + 1] = BEND
    low, high = robot.length_limits.T
    while len(found) < count:
        c = robot.home + spread * rng.normal(size=len(spread))
        lengths = robot.lengths(c)
        if np.all((lengths >= low) & (lengths <= high)) and np.min(robot.bend_slack(c)) >= 0.0:
            found.append(c)
    return np.array(found)
