"""What the operator shall feel of the follower (23), (24): forces that resist.

The paper's forces act on the hand, but its waves take F_s for the reaction that opposes motion:
put together as printed, contact is unstable. All forces here have the sign of a reaction: positive
where the follower's desired point is beyond the real one, or the follower beyond a boundary (notes
A7).
"""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import energy_kernels, kernels
from sinuous.teleop.checks import positive, zero_or_more
from sinuous.teleop.motion import Motion


class VirtualForce(Protocol):
    """A force made up of how the follower moves."""

    def force(self, motion: Motion) -> Array:
        """The force F_s, or a part of it, that opposes the follower's desired motion (A,) [N]."""
        ...


@dataclass(frozen=True)
class Together:
    """The sum of forces (23).

    Arguments:
        parts: one or more

    Raises:
        ValueError: if there is none
    """

    parts: tuple[VirtualForce, ...]

    def __post_init__(self) -> None:
        if not self.parts:
            raise ValueError("a sum of forces needs one part or more")

    def force(self, motion: Motion) -> Array:
        """The sum (A,) [N]."""
        total = self.parts[0].force(motion)
        for part in self.parts[1:]:
            total = total + part.force(motion)
        return total


@dataclass(frozen=True, kw_only=True)
class ErrorForce:
    """F_e of the tracking error e = X_sd - X_s, per axis (24): k_f (1/2 - 1/(1 + exp(e/s))).

    At most k_f / 2; k_f / 4s per metre where the error is small.

    Arguments:
        gain: k_f [N]
        length: s, which the printed argument lacks [m] (notes A8)

    Raises:
        ValueError: if the gain is negative or the length not positive
    """

    gain: float = 3.0
    length: float = 0.01

    def __post_init__(self) -> None:
        zero_or_more("gain", self.gain)
        positive("length", self.length)

    def force(self, motion: Motion) -> Array:
        """F_e (A,) [N]."""
        out = np.empty(motion.X_s.size)
        kernels.error_per_axis(self.gain, self.length, motion.X_sd, motion.X_s, out)
        return out


@dataclass(frozen=True, kw_only=True)
class ErrorForceAlong:
    """F_e of (24) along the error vector: the same in every direction of space.

    Arguments and errors as for `ErrorForce`; at most k_f / 2 in all.
    """

    gain: float = 3.0
    length: float = 0.01

    def __post_init__(self) -> None:
        zero_or_more("gain", self.gain)
        positive("length", self.length)

    def force(self, motion: Motion) -> Array:
        """F_e (A,) [N]."""
        out = np.empty(motion.X_s.size)
        kernels.error_along(self.gain, self.length, motion.X_sd, motion.X_s, out)
        return out


@dataclass(frozen=True, kw_only=True, eq=False)
class CappedForce:
    """Another force, of a size within bounds: beyond, only its direction is kept.

    Arguments:
        part: the other force
        largest: F_max [N]

    Raises:
        ValueError: if the largest is not positive
    """

    part: VirtualForce
    largest: float

    def __post_init__(self) -> None:
        positive("largest", self.largest)

    def force(self, motion: Motion) -> Array:
        """The force, at most F_max long (A,) [N]."""
        force = self.part.force(motion)
        out = np.empty(force.size)
        energy_kernels.capped(self.largest, force, out)
        return out
