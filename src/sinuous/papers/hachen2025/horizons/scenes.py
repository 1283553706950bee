"""Scenes with dead ends: a plate with a hole, posts, rough passages; and targets behind them."""

from dataclasses import dataclass, replace

import numpy as np
import trimesh

from sinuous.arrays import Array
from sinuous.bench.random_scenes import random_scene
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc
from sinuous.scenario import Scenario
from sinuous.scenario.path import waypoints

# A round chamber whose robot comes in through its floor, thinner than the preset [m].
RADIUS, HEIGHT, BASE, APPROACH = 0.055, 0.2, -0.05, 0.08
BODY_RADIUS, SHORT, MARGIN = 0.005, 0.043, 0.002

THICKNESS = 0.006  # of a plate [m]
BEFORE = 0.012  # where the way-points on both sides of a hole are, from the plate's middle [m]
ASIDE = 0.025  # how far from the hole's axis targets are, at most [m]
TOP = 0.18  # no target is higher [m]
SPARE = 1e-3  # targets keep so much more than margin and radius [m]

# One plate: its height, hole, a target that only long horizons reach, and how far around the
# hole's axis other targets lie [m].
PLATE, HOLE, HOLE_RADIUS = 0.1047, np.array([0.0032, 0.0019]), 0.0126
TARGET = np.array([0.0032, 0.0189, 0.1382])
MAP_HALF, MAP_HORIZONS = 0.02, (2, 5, 10, 20)
SHOWN_DT, SHOWN_STEPS = 1 / 30, 150


@dataclass(frozen=True, kw_only=True, eq=False)
class DeadEnd:
    """A scene in which a straight way to the target may not exist.

    Arguments:
        robot, zone, margin, start: as for a controller
        targets: (K, 3) [m], with room for the tip
        via: way-points (W, 3) [m] that lead to all of them; none where none are known
    """

    robot: PccRobot
    zone: SafeZone
    margin: float
    start: Array
    targets: Array
    via: Array

    def controller(self, horizon: int, dt: float) -> ShapeConstrainedMPC:
        """The controller with default costs.

        Arguments:
            horizon: N
            dt: time between steps [s]
        """
        return ShapeConstrainedMPC(
            self.robot, self.zone, margin=self.margin, dt=dt, horizon=horizon
        )


def plate(height: float, hole: Array, hole_radius: float) -> trimesh.Trimesh:
    """A plate across the chamber with a round hole.

    Arguments:
        height: of its middle [m]
        hole: middle of the hole (2,) [m]
        hole_radius: [m]
    """
    count = 32
    angle = 2.0 * np.pi * np.arange(count) / count
    circle = np.stack([np.cos(angle), np.sin(angle), np.zeros(count)], axis=1)
    up = np.array([0.0, 0.0, 0.5 * THICKNESS])
    outside = (RADIUS + 1e-3) * circle + [0.0, 0.0, height]
    inside = hole_radius * circle + [*hole, height]
    # Around a cross-section: below inwards, up along the hole, back above, down outside.
    loops = np.stack([outside - up, inside - up, inside + up, outside + up])
    k, m = np.meshgrid(np.arange(4), np.arange(count), indexing="ij")
    after, ahead = (k + 1) % 4 * count, (m + 1) % count
    a, b, c, d = (
        part.ravel() for part in (k * count + m, k * count + ahead, after + ahead, after + m)
    )
    faces = np.concatenate([np.stack([a, c, b], axis=1), np.stack([a, d, c], axis=1)])
    return trimesh.Trimesh(loops.reshape(-1, 3), faces, process=False)


def plate_scene(height: float, hole: Array, hole_radius: float, targets: Array) -> DeadEnd:
    """The chamber behind such a plate; its targets can be reached through the hole."""
    zone = _chamber().minus(plate(height, hole, hole_radius), name="plate")
    via = np.array([[*hole, height - BEFORE], [*hole, height + BEFORE]])
    return _dead_end(zone, targets, via)


def plates(seed: int, number: int, count: int) -> DeadEnd:
    """A random plate, and targets behind it, not far from its hole's axis."""
    rng = np.random.default_rng([seed, number])
    height, angle, aside = rng.uniform(0.09, 0.12), rng.uniform(0.0, 2.0 * np.pi), rng.uniform()
    hole = 0.025 * aside * np.array([np.cos(angle), np.sin(angle)])
    around, away = rng.uniform(0.0, 2.0 * np.pi, 500), ASIDE * np.sqrt(rng.uniform(size=500))
    x, y = hole[:, None] + away * np.array([np.cos(around), np.sin(around)])
    z = rng.uniform(height + BEFORE, TOP, 500)
    scene = plate_scene(height, hole, rng.uniform(0.013, 0.018), np.stack([x, y, z], axis=1))
    return _with_room(scene, count)


def posts(seed: int, number: int, count: int) -> DeadEnd:
    """Three random posts across the chamber, and targets anywhere above its floor."""
    rng, zone = np.random.default_rng([seed, number]), _chamber()
    for k in range(3):
        turn, tilt = rng.uniform(0.0, np.pi), rng.uniform(-0.3, 0.3)
        flat = np.array([np.cos(turn), np.sin(turn), 0.0])
        half = 0.06 * (np.cos(tilt) * flat + np.array([0.0, 0.0, np.sin(tilt)]))
        side = rng.uniform(-0.03, 0.03) * np.array([-flat[1], flat[0], 0.0])
        middle = side + np.array([0.0, 0.0, rng.uniform(0.115, 0.17)])
        post = shapes.capsule(middle - half, middle + half, rng.uniform(0.004, 0.009), sections=12)
        zone = zone.minus(post, name=f"post {k}")
    wide = 0.9 * RADIUS
    targets = rng.uniform([-wide, -wide, 0.06], [wide, wide, TOP], (1000, 3))
    return _with_room(_dead_end(zone, targets, np.empty((0, 3))), count)


def passages(seed: int, number: int, count: int) -> DeadEnd:
    """A random passage, every other one with an obstacle, and targets in it."""
    rng = np.random.default_rng([seed, number])
    scene = random_scene(rng, 400, number % 2 == 1)
    found = DeadEnd(
        robot=scene.robot,
        zone=scene.zone,
        margin=scene.margin,
        start=scene.start,
        targets=rng.permutation(np.unique(scene.targets, axis=0)),
        via=np.empty((0, 3)),
    )
    return _with_room(found, count)


def map_scene(row: int, count: int) -> DeadEnd:
    """One plate with one row of targets, of so many, that lie in a square behind its hole."""
    x = np.linspace(-MAP_HALF, MAP_HALF, count)
    targets = np.stack([HOLE[0] + x, np.full(count, HOLE[1] + x[row])], axis=1)
    places = np.column_stack([targets, np.full(count, TARGET[2])])
    return plate_scene(PLATE, HOLE, HOLE_RADIUS, places)


def shown_scenario(horizon: int) -> Scenario:
    """A target behind the same plate that only long horizons reach."""
    scene = plate_scene(PLATE, HOLE, HOLE_RADIUS, TARGET[None])
    return Scenario(
        name="behind the plate",
        mpc=scene.controller(horizon, SHOWN_DT),
        path=waypoints(scene.targets, max_steps=SHOWN_STEPS),
        start=scene.start,
    )


def _chamber() -> SafeZone:
    axis = np.array([[0.0, 0.0, 0.0], [0.0, 0.0, HEIGHT]])
    mesh = shapes.tube(axis, RADIUS, sections=32)
    return SafeZone.from_mesh(mesh, name="chamber", entrance=axis[0], approach=APPROACH)


def _dead_end(zone: SafeZone, targets: Array, via: Array) -> DeadEnd:
    preset = load_pcc("hachen2025")
    T_w_b = np.eye(4)
    T_w_b[2, 3] = BASE
    thin = tuple(replace(segment, body_radius=BODY_RADIUS) for segment in preset.segments)
    return DeadEnd(
        robot=replace(preset, segments=thin, T_w_b=T_w_b),
        zone=zone,
        margin=MARGIN,
        start=np.array([0.0, 0.0, SHORT] * len(thin)),
        targets=targets,
        via=via,
    )


def _with_room(scene: DeadEnd, count: int) -> DeadEnd:
    """The same scene with the first targets that leave room for the tip."""
    needed = scene.robot.radii[-1] + scene.margin + SPARE
    free = scene.zone.clearance(scene.targets) > needed
    return replace(scene, targets=scene.targets[free][:count])
