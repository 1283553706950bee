"""The virtual force with the printed signs, to show what they do."""

from dataclasses import dataclass, field

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop import kernels
from sinuous.teleop.boundary import box_sides
from sinuous.teleop.force import Motion


@dataclass(frozen=True, kw_only=True, eq=False)
class PrintedForce:
    """F_e + F_b as (24) and (25) are printed: only to show that they diverge (notes A7, A9).

    F_e is negative where the follower lags, F_b points inward, both as forces on the hand, and
    c_b (v . N), a number, is the same for the lower and the upper boundary of an axis but for
    the sign of N. Put into (18) they push X_sd on where they should hold it back.

    Arguments:
        low, high: of X_u (A,) [m]
        gain, length: k_f [N], and s [m]
        stiffness, damping: k_b [N/m], c_b [N s/m]

    Raises:
        ValueError: if the box is inside out
    """

    low: ArrayLike
    high: ArrayLike
    gain: float = 3.0
    length: float = 0.01
    stiffness: float = 50.0
    damping: float = 1.0
    _sides: tuple[Array, Array] = field(init=False, repr=False)

    def __post_init__(self) -> None:
        object.__setattr__(self, "_sides", box_sides(self.low, self.high))

    def force(self, motion: Motion) -> Array:
        """F_e + F_b (A,) [N]."""
        out = np.empty(self._sides[0].size)
        kernels.error_per_axis(self.gain, self.length, motion.X_s, motion.X_sd, out)
        X, V = motion.X_s, motion.V_s
        kernels.printed_box(*self._sides, self.stiffness, self.damping, X, V, out)
        return out
