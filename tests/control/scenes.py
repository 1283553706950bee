"""Scenes for closed loops: a robot, a zone and where to start."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

MARGIN = 0.002
START = np.array([0.0, 0.0, 0.045] * 3)  # straight and short


@dataclass(frozen=True, kw_only=True)
class Scene:
    """A robot with its base in the guide before a passage."""

    robot: PccRobot
    zone: SafeZone
    axis: Array  # (K, 3) of the passage [m]

    def mpc(self, horizon: int = 5) -> ShapeConstrainedMPC:
        """The controller with the margin all scenes use."""
        return ShapeConstrainedMPC(self.robot, self.zone, margin=MARGIN, horizon=horizon)


def robot_at(z: float, limits: str = "simulation") -> PccRobot:
    """The preset of paper B with its base at a height [m]."""
    T_w_b = np.eye(4)
    T_w_b[2, 3] = z
    return load_robot("hachen2025", limits=limits).at(T_w_b)


def bent_tube(limits: str = "simulation") -> Scene:
    """A straight stretch and then a bend of 69 deg, 22 mm in radius."""
    straight = np.linspace([0.0, 0.0, 0.0], [0.0, 0.0, 0.1], 6)[:-1]
    axis = np.concatenate([straight, shapes.arc_path(0.12, 1.2, stations=24) + [0.0, 0.0, 0.1]])
    zone = SafeZone.from_mesh(shapes.tube(axis, 0.022), entrance=[0.0, 0.0, 0.0])
    return Scene(robot=robot_at(-0.05, limits), zone=zone, axis=axis)


def bumpy_tube(rng: np.random.Generator) -> Scene:
    """A random winding tube with rough walls."""
    axis = shapes.wandering_path(rng, length=0.2, bend=9.0)
    mesh = shapes.bumpy_tube(rng, path=axis, radius=0.022, roughness=0.1)
    zone = SafeZone.from_mesh(mesh, entrance=axis[0])
    return Scene(robot=robot_at(-0.1), zone=zone, axis=axis)
