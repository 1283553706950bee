"""Walls that the operator feels (25): of a box, and of any safe zone."""

from dataclasses import dataclass, field

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.geometry.safe_zone import SafeZone
from sinuous.teleop import kernels, walls
from sinuous.teleop.checks import vector, zero_or_more
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.motion import Motion


@dataclass(frozen=True, kw_only=True, eq=False)
class BoxForce:
    """F_b of the follower beyond a boundary, per axis (25): a spring and a damper.

    F_b = k_b (X_s - X_b) + c_b (v . N) N where X_s has reached or passed X_b, resistive on both
    sides and never towards the wall (notes A9).

    Arguments:
        low, high: of X_u, the room without force (A,) [m]
        stiffness: k_b [N/m], printed as 0.5 per cm
        damping: c_b [N s/m]

    Raises:
        ValueError: if the box is inside out, or stiffness or damping negative
    """

    low: ArrayLike
    high: ArrayLike
    stiffness: float = 50.0
    damping: float = 1.0
    _low: Array = field(init=False, repr=False)
    _high: Array = field(init=False, repr=False)

    def __post_init__(self) -> None:
        low, high = box_sides(self.low, self.high)
        zero_or_more("stiffness", self.stiffness)
        zero_or_more("damping", self.damping)
        object.__setattr__(self, "_low", low)
        object.__setattr__(self, "_high", high)

    def force(self, motion: Motion) -> Array:
        """F_b (A,) [N]."""
        out = np.empty(self._low.size)
        X, V = motion.X_s, motion.V_s
        kernels.box(self._low, self._high, self.stiffness, self.damping, X, V, out)
        return out


def box_sides(low: ArrayLike, high: ArrayLike) -> tuple[Array, Array]:
    """Both sides (A,) of a box.

    Raises:
        ValueError: if they do not fit each other, or the box is inside out
    """
    below, above = vector("low", low), vector("high", high)
    if below.shape != above.shape or np.any(below >= above):
        raise ValueError(
            f"a box needs low below high on every axis, not {below.tolist()} and {above.tolist()}"
        )
    return below, above


@dataclass(frozen=True, kw_only=True, eq=False)
class ZoneForce:
    """F_b of a desired point that is nearer to a safe zone's wall than the follower may be.

    A controller that keeps the zone never lets the follower pass the margin, so a force on its
    own depth would never be felt: this one acts on the depth of X_sd below the margin. Direction
    and depth are those of the way to the nearest place that keeps the margin, see `walls`; what of
    the force is off the wave side's axes the operator does not feel.

    Arguments:
        zone: the room the follower may use
        mapping: from the wave side to the zone's frame
        distance: from the wall that the follower's tip keeps: its radius and the margin [m]
        stiffness: k_b [N/m]
        damping: c_b, of the desired motion into the wall [N s/m]; below twice the wave impedance,
            because what it acts on is a tick old

    Raises:
        ValueError: if a number is negative or not finite
    """

    zone: SafeZone
    mapping: Mapping
    distance: float
    stiffness: float = 50.0
    damping: float = 1.0

    def __post_init__(self) -> None:
        zero_or_more("distance", self.distance)
        zero_or_more("stiffness", self.stiffness)
        zero_or_more("damping", self.damping)

    def force(self, motion: Motion) -> Array:
        """F_b (A,) [N]."""
        way, out = np.empty(3), np.zeros(self.mapping.scale.size)
        walls.way_back(self.zone.arrays, self.mapping.place(motion.X_sd), self.distance, way)
        axes, V = self.mapping.axes, motion.V_sd
        kernels.wall(axes, way, self.stiffness, self.damping, V, out)
        return out
