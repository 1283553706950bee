"""Walls that a controller knows of, as planes at the tip: a local model between its steps.

A force that is computed at the controller's rate and held until its next step is late by half a
step, and a held spring makes energy. What is handed over is therefore no force but a plane: where
walls would stop the tip, and in which direction. The spring acts on the desired or the real point
as it is in every tick.
"""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import zero_or_more
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.motion import Motion, Plane


@dataclass(frozen=True, kw_only=True, eq=False)
class HeldForce:
    """A spring and a damper that hold the desired point back from beyond the walls' plane.

    F = K n max(n . (place - p_sd), 0), with the unit vector n along the way: at the step's own
    target that is K times the way. Its damping acts on motion into the wall only.

    Arguments:
        mapping: from the wave side to the world
        stiffness: K [N/m]
        damping: of the desired motion into the wall [N s/m]; below twice the wave impedance,
            because what it acts on is a tick old

    Raises:
        ValueError: if a number is negative or not finite
    """

    mapping: Mapping
    stiffness: float = 50.0
    damping: float = 1.0

    def __post_init__(self) -> None:
        zero_or_more("stiffness", self.stiffness)
        zero_or_more("damping", self.damping)

    def force(self, motion: Motion) -> Array:
        """F (A,) [N]."""
        return _push(self.mapping, self.stiffness, self.damping, motion.held, motion.X_sd, motion)


@dataclass(frozen=True, kw_only=True, eq=False)
class NearForce:
    """A spring that keeps the real tip from where some part of the body comes close to a wall.

    It grows from a distance of the whole body on and is largest at the margin, beyond which the
    controller does not go: it warns, and does not tell how hard a wall is pushed.

    Arguments:
        mapping: from the wave side to the world
        stiffness: K [N/m]

    Raises:
        ValueError: if the stiffness is negative or not finite
    """

    mapping: Mapping
    stiffness: float = 50.0

    def __post_init__(self) -> None:
        zero_or_more("stiffness", self.stiffness)

    def force(self, motion: Motion) -> Array:
        """F (A,) [N]."""
        return _push(self.mapping, self.stiffness, 0.0, motion.near, motion.X_s, motion)


def _push(
    mapping: Mapping, stiffness: float, damping: float, plane: Plane, X: Array, motion: Motion
) -> Array:
    out = np.zeros(mapping.scale.size)
    size = float(np.linalg.norm(plane.way))
    if size > 0.0:
        n = plane.way / size
        depth = float(n @ (plane.place - mapping.place(X)))
        if depth > 0.0:
            kernels.wall(mapping.axes, depth * n, stiffness, damping, motion.V_sd, out)
    return out
