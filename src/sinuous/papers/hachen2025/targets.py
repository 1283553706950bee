"""Targets up to the edge of what the robot reaches, and beyond it."""

import numpy as np

from sinuous.arrays import Array
from sinuous.geometry.safe_zone import SafeZone
from sinuous.papers.hachen2025.undisturbed import Place
from sinuous.robots.pcc import PccRobot

PUSHED = 1.3
"""Targets beyond the edge are up to this many times as far from the base as a place on it."""

DRAWN = 20_000
"""Places in a box that are drawn at once."""


def anywhere(robot: PccRobot, count: int, rng: np.random.Generator) -> Array:
    """Tips (count, 3) [m] of random configurations.

    Lengths and directions of bending are uniform within their limits, and so is where in the disc
    of allowed bends a segment's bend lies.
    """
    return _tips(robot, count, rng, at_limits=False)


def at_the_edge(robot: PccRobot, count: int, rng: np.random.Generator) -> Array:
    """Tips (count, 3) [m] of random extreme configurations.

    Every segment is as short or as long as it gets, and straight or bent as far as it gets.
    """
    return _tips(robot, count, rng, at_limits=True)


def beyond(robot: PccRobot, count: int, rng: np.random.Generator) -> Array:
    """Places (count, 3) [m] farther from the base than one at the edge, most out of reach."""
    base = robot.T_w_b[:3, 3]
    share = rng.uniform(1.0, PUSHED, (count, 1))
    return base + share * (at_the_edge(robot, count, rng) - base)


def along(here: Place, count: int, rng: np.random.Generator) -> Array:
    """Places (count, 3) [m], uniform where the tip keeps the margin in a passage.

    They are farther from the base than the tip at the start: the robot cannot draw back.
    """
    distance = float(here.robot.required_distance(here.margin)[-1])
    base = here.robot.T_w_b[:3, 3]
    nearest = np.linalg.norm(here.robot.tip(here.start) - base)
    places = np.zeros((0, 3))
    while len(places) < count:
        p = inside(here.zone, distance, count, rng)
        places = np.concatenate([places, p[np.linalg.norm(p - base, axis=1) > nearest]])
    return places[:count]


def inside(zone: SafeZone, distance: float, count: int, rng: np.random.Generator) -> Array:
    """Places (count, 3) [m], uniform where the mesh leaves a distance [m] to every wall."""
    return _within(zone, count, rng, distance, np.inf, 0.0)


def outside(
    zone: SafeZone, nearest: float, farthest: float, count: int, rng: np.random.Generator
) -> Array:
    """Places (count, 3) [m], uniform between two distances [m] outside the mesh."""
    return _within(zone, count, rng, -farthest, -nearest, farthest)


def _within(
    zone: SafeZone, count: int, rng: np.random.Generator, least: float, most: float, air: float
) -> Array:
    corners = zone.triangles[~zone.is_guide & ~zone.is_open].reshape(-1, 3)
    low, high = corners.min(axis=0) - air, corners.max(axis=0) + air
    found = np.zeros((0, 3))
    while len(found) < count:
        p = rng.uniform(low, high, (DRAWN, 3))
        near = zone.nearest(p)
        chosen = (near.clearance >= least) & (near.clearance <= most)
        # Before the entrance there is nothing to do.
        chosen &= ~zone.is_guide[near.triangle]
        found = np.concatenate([found, p[chosen]])
    return found[:count]


def _tips(robot: PccRobot, count: int, rng: np.random.Generator, *, at_limits: bool) -> Array:
    low, high = robot.length_limits.T
    found = list[Array]()
    while len(found) < count:
        c = _configuration(robot, rng, at_limits=at_limits)
        lengths = robot.lengths(c)
        if np.all((lengths >= low) & (lengths <= high)):
            found.append(robot.tip(c))
    return np.array(found)


def _configuration(robot: PccRobot, rng: np.random.Generator, *, at_limits: bool) -> Array:
    parts = list[float]()
    for segment in robot.segments:
        share, radius, turn = rng.uniform(size=3)
        if at_limits:
            share, radius = float(share > 0.5), float(radius > 0.5)
        gamma = segment.length[0] + share * (segment.length[1] - segment.length[0])
        slope, offset = segment.bend_planes.T
        bend = float(np.sqrt(radius) * max(np.min(slope * gamma + offset), 0.0))
        angle = 2.0 * np.pi * turn
        parts += [bend * np.cos(angle), bend * np.sin(angle), gamma]
    return np.array(parts)
