"""What robots are built from."""

from dataclasses import dataclass
from enum import Enum

import numpy as np

from sinuous.arrays import Array


class CableConvention(Enum):
    """Where a cable's length is counted."""

    SEGMENT = "segment"  # inside its own segment, as paper B does
    MOTOR = "motor"  # from the robot's base, through all proximal segments


class JointOrder(Enum):
    """About which axes the two angles of a universal joint turn, in order of rotation."""

    ZX = "zx"  # theta about Z, then phi about X (paper A eq. 1, 14)
    XZ = "xz"  # phi about X, then theta about Z (paper A eq. 15)

    @property
    def axes(self) -> tuple[int, int]:
        """Numbers of the coordinate axes."""
        return (2, 0) if self is JointOrder.ZX else (0, 2)

    @property
    def angles(self) -> tuple[str, str]:
        """Names of the angles."""
        return ("theta", "phi") if self is JointOrder.ZX else ("phi", "theta")


@dataclass(frozen=True, kw_only=True)
class Segment:
    """One bending segment."""

    length: tuple[float, float]  # shortest and longest backbone [m]; equal: fixed length
    home_length: float  # [m]
    disks: int
    cable_angles: tuple[float, ...]  # of the holes about local z [rad], three or more
    pitch_radii: tuple[float, ...]  # from the backbone to each cable [m]
    body_radius: float  # [m]
    disk_thickness: float  # [m]
    max_curvature: float  # [1/m], inf if only the disks limit it
    cable_length: tuple[float, float]  # shortest and longest, in the robot's convention [m]

    @property
    def extensible(self) -> bool:
        """Whether the backbone is an actuator."""
        return self.length[0] < self.length[1]

    @property
    def holes(self) -> Array:
        """Offsets (m, 2) of the cables from the backbone [m]."""
        angles, radii = np.array(self.cable_angles), np.array(self.pitch_radii)
        return radii[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)

    @property
    def bend_planes(self) -> Array:
        """Rows (slope, offset) of the largest bend |theta| <= slope gamma + offset [rad].

        The first is the stated curvature limit, the second the disks touching on the inner
        side: kappa = (1 - t / h) / rho with the spacing h = gamma / n (paper B eq. 20).
        """
        touching = (1.0 / self.body_radius, -self.disks * self.disk_thickness / self.body_radius)
        stated = [(self.max_curvature, 0.0)] if np.isfinite(self.max_curvature) else []
        return np.array([*stated, touching])

    @property
    def largest_curvature(self) -> float:
        """Largest curvature at any length [1/m]: that of the longest segment."""
        slope, offset = self.bend_planes.T
        return float(np.min(slope + offset / self.length[1]))


@dataclass(frozen=True, kw_only=True)
class Insertion:
    """A stage that pushes the robot's base along its axis on a straight shaft."""

    travel: tuple[float, float]  # [m]
    home: float  # [m]
    radius: float  # of the shaft [m]


@dataclass(frozen=True, kw_only=True)
class Tool:
    """A rigid tool or sensor whose end is the tip."""

    offset: tuple[float, float, float]  # from the last disk or plate, in its frame [m]
    radius: float  # [m]


@dataclass(frozen=True, kw_only=True)
class SpeedLimits:
    """Largest actuator speeds [m/s], the same in both directions; 0 of what there is not."""

    cable: float
    backbone: float = 0.0
    insertion: float = 0.0
