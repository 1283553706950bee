"""Walls that a controller knows of, as planes at the tip: a local model between its steps.

A force that is computed at the controller's rate and held until its next step is late by half a
step, and a held spring makes energy. What is handed over is therefore no force but a plane: where
walls would stop the tip, and in which direction. The spring acts on the desired or the real point
as it is in every tick.
"""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels, wall_kernels
from sinuous.teleop.checks import zero_or_more
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.motion import Motion, Plane, Walls

DAMPED = 1e-3
"""Depth from which on a wall damps as much as it can [m]: contact at speed is no jump."""


@dataclass(frozen=True, kw_only=True)
class Settling:
    """What is known of walls settles from tick to tick, without any lag at a wall that stays.

    Where the robot is at a limit of speed, the multipliers of the walls that it slides along
    change from step to step, and a plane that a step brings must not be a jump. So in every tick
    the plane of the tick before says first what it makes of the point now: of a wall that stays,
    pushed further or let go of, that is right already. What it lacks of what is known is added by
    a share per tick. It never says that there is more of a wall than both the controller's plane
    says and there was, else it would go along with a point that moves on when the wall has gone.

    Arguments:
        time: in which it settles [s]; zero for at once

    Raises:
        ValueError: if the time is negative or not finite
    """

    time: float = 0.05

    def __post_init__(self) -> None:
        zero_or_more("time", self.time)

    def step(self, before: Walls, now: Walls, desired: Array, real: Array, dt: float) -> Walls:
        """The walls in a tick.

        Arguments:
            before: in the tick before
            now: as the controller knows them
            desired, real: where the tip should be, and where it is (3,) [m]
            dt: time of a tick [s]
        """
        share = dt / (self.time + dt)
        return Walls(
            _settled(desired, before.held, now.held, share),
            _settled(real, before.near, now.near, share),
        )


def _settled(p: Array, before: Plane, now: Plane, share: float) -> Plane:
    place, way = np.empty(3), np.empty(3)
    wall_kernels.settle(p, *before, *now, share, place, way)
    return Plane(place, way)


@dataclass(frozen=True, kw_only=True, eq=False)
class HeldForce:
    """A spring and a damper that hold the desired point back from beyond the walls' plane.

    F = K n max(n . (place - p_sd), 0), with the unit vector n along the way: at the step's own
    target that is K times the way. Its damping comes in over the first millimetre; it never pulls.

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
    out, way = np.zeros(mapping.scale.size), np.empty(3)
    depth = wall_kernels.beyond(mapping.place(X), plane.place, plane.way, way)
    fading = damping * min(depth / DAMPED, 1.0)
    kernels.wall(mapping.axes, way, stiffness, fading, motion.V_sd, out)
    return out
