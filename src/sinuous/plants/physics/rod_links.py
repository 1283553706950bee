"""A rod as links: the one discretisation that robots and bare rods are built with.

A stretch of length h bends and twists at its middle, where hinges stand for its whole
compliance: their springs have the stiffness E I / h and G J / h. The frame of a link is the
cross-section at the end of its stretch, so that the link reaches half a stretch to both sides of
its frame. Positions, directions and loads are then right to second order in h.

Three turns one after the other are not one turn: two bends of a and b about crossing axes leave a
twist of a b / 2 that no spring feels. In the next link the hinges stand in the opposite order and
take it back; otherwise the rod as a whole would be right to first order only.
"""

from dataclasses import dataclass
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.plants.physics.engine import require_mujoco
from sinuous.robots.rod_mechanics import RoundRod

AXES = np.eye(3)
TWIST = 2  # about z, the direction of the rod


@dataclass(frozen=True, kw_only=True)
class Link:
    """One stretch of a rod.

    Arguments:
        rod: what it is made of
        length: of the stretch, h [m]
        reversed: whether its hinges turn about z, y, x instead of x, y, z
        twist_length: of the rod whose twist this link stands for [m]; 0: it does not twist
        damping: of its springs, as a time that turns their stiffness into damping [s]
        twist_damping: besides, of its twist [N m s/rad]
        last: whether the rod ends at its frame
        disk_mass: of the disk at its frame [kg]
        disk_radius: of that disk, a thin one [m]
    """

    rod: RoundRod
    length: float
    reversed: bool
    twist_length: float
    damping: float = 0.0
    twist_damping: float = 0.0
    last: bool = False
    disk_mass: float = 0.0
    disk_radius: float = 0.0

    @property
    def axes(self) -> list[int]:
        """About which axis each of its hinges turns, in order."""
        axes = [0, 1, TWIST] if self.twist_length > 0.0 else [0, 1]
        return axes[::-1] if self.reversed else axes

    def stiffness(self, axis: int) -> float:
        """Of a hinge [N m/rad]."""
        if axis == TWIST:
            return self.rod.torsion_stiffness / self.twist_length
        return self.rod.bending_stiffness / self.length

    def resistance(self, axis: int) -> float:
        """Damping of a hinge [N m s/rad]."""
        other = self.twist_damping if axis == TWIST else 0.0
        return self.damping * self.stiffness(axis) + other

    def add_to(self, parent: Any, name: str) -> Any:
        """Add the link behind another one (or what holds the rod) and return its body."""
        mujoco = require_mujoco()
        body = parent.add_body(name=name, pos=[0.0, 0.0, self.length])
        for axis in self.axes:
            body.add_joint(
                type=mujoco.mjtJoint.mjJNT_HINGE,
                pos=[0.0, 0.0, -0.5 * self.length],
                axis=AXES[axis],
                stiffness=self.stiffness(axis),
                damping=self.resistance(axis),
            )
        self._weigh(body)
        return body

    def _weigh(self, body: Any) -> None:
        """Give it the mass of what it reaches over, as a thin rod, and of its disk."""
        reach = 0.5 * self.length if self.last else self.length
        rod, disk = self.rod.mass_per_length * reach, self.disk_mass
        middle = -0.25 * self.length if self.last else 0.0
        centre = middle * rod / (rod + disk) if rod + disk > 0.0 else 0.0
        thick, wide = self.rod.radius**2, self.disk_radius**2
        across = rod * (reach**2 / 12.0 + thick / 4.0 + (middle - centre) ** 2)
        across += disk * (wide / 4.0 + centre**2)
        body.explicitinertial, body.mass = True, rod + disk
        body.ipos = [0.0, 0.0, centre]
        body.inertia = [across, across, 0.5 * (rod * thick + disk * wide)]


def cubic(u: Array) -> Array:
    """Weights (4, K) that put points into stretches: cubics that start and end with the frames.

    They belong to the place of the first frame, its direction times the length of the stretch,
    and the same of the second.

    Arguments:
        u: fraction of the stretch (K,)
    """
    v = 1.0 - u
    return np.stack([v * v * (1.0 + 2.0 * u), v * v * u, u * u * (1.0 + 2.0 * v), -u * u * v])
