"""Random passages and targets, to look for the slowest step and for a margin that is broken."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from sinuous.bench.scene import Scene
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot_file import load_pcc

RADIUS, ROUGHNESS, LENGTH, BENDING = 0.020, 0.1, 0.20, 9.0  # of the tube [m], [], [m], [1/m]
BODY, MARGIN = 0.005, 0.0015  # [m]
BASE = -0.1  # height of the robot's base, in the guide before the entrance [m]
SHORT = 0.045  # of each segment at the start [m]
OBSTACLE = 0.003  # radius of the keep-out in every other passage [m]
HELD = (5, 40)  # steps that a target stays
ASIDE, OUTSIDE = 0.008, 0.04  # how far targets are off the axis; one in three is outside [m]
DT = 1 / 30


def random_scenes(seed: int, count: int, steps: int) -> Iterator[Scene]:
    """Passages with bends, rough walls and obstacles; a target jumps about in each."""
    for number in range(count):
        yield random_scene(np.random.default_rng([seed, number]), steps, number % 2 == 1)


def random_scene(rng: np.random.Generator, steps: int, obstacle: bool) -> Scene:
    """One of them."""
    axis = shapes.wandering_path(rng, length=LENGTH, bend=BENDING)
    mesh = shapes.bumpy_tube(rng, path=axis, radius=RADIUS, roughness=ROUGHNESS)
    zone = SafeZone.from_mesh(mesh, name="passage", entrance=axis[0], approach=0.05 - BASE)
    if obstacle:
        side = rng.normal(size=3)
        place = axis[2 * len(axis) // 3] + 0.6 * RADIUS * side / np.linalg.norm(side)
        zone = zone.minus(shapes.sphere(OBSTACLE, centre=place), name="obstacle")
    robot = load_pcc("hachen2025")
    T_w_b = np.eye(4)
    T_w_b[2, 3] = BASE
    thin = tuple(replace(segment, body_radius=BODY) for segment in robot.segments)
    targets, k = np.empty((steps, 3)), 0
    while k < steps:
        held, side = int(rng.integers(*HELD)), rng.normal(size=3)
        away = OUTSIDE if rng.uniform() < 1 / 3 else rng.uniform(0.0, ASIDE)
        middle = axis[rng.integers(len(axis) // 3, len(axis))]
        targets[k : k + held] = middle + away * side / np.linalg.norm(side)
        k += held
    return Scene(
        robot=replace(robot, segments=thin, T_w_b=T_w_b),
        zone=zone,
        margin=MARGIN,
        start=np.array([0.0, 0.0, SHORT] * len(robot.segments)),
        targets=targets,
        dt=DT,
    )
