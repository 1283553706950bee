"""Offset-free control: what the model is wrong by, learned from the measured tip."""

from dataclasses import dataclass
from enum import Enum
from math import exp

import numpy as np

from sinuous.arrays import Array


class When(Enum):
    """When an offset is learned."""

    TIP_ONLY = "where only the tip is measured"
    ALWAYS = "from every measurement"
    NEVER = "never"


@dataclass(frozen=True, kw_only=True)
class OffsetFree:
    """Learns the offset d of the measured tip from the nominal one and aims that much aside.

    y = f(x) + d with a constant d: its estimate follows the measured offset with a first-order
    lag, and the plan is given the target p_d - d.  The tip then comes to rest on p_d however
    wrong the model is, as long as p_d - d can be reached.

    What that means for margins: the *nominal* body keeps its margin as ever, because only the
    target moves.  The real body is as far from the nominal one as the model is wrong, at the tip
    by |d|, so it keeps at least the margin less the largest offset of any of its points.

    Where the robot does not follow at all, a cable being slack or a wall in its way, the offset
    grows as far as the plan is sent aside, and the plan is sent aside as far as the offset grows.
    A limit ends that.

    Arguments:
        time_constant: of the lag [s]
        limit: largest length of the estimate [m]
        when: see `When`

    Raises:
        ValueError: if the time constant or the limit is not positive
    """

    time_constant: float = 0.5
    limit: float = 0.015
    when: When = When.TIP_ONLY

    def __post_init__(self) -> None:
        if not self.time_constant > 0.0:
            raise ValueError(f"time_constant must be positive, not {self.time_constant}")
        if not self.limit > 0.0:
            raise ValueError(f"limit must be positive, not {self.limit}")

    def applies(self, *, has_shape: bool) -> bool:
        """Whether an offset is learned from a measurement with or without the whole shape."""
        return self.when is When.ALWAYS or (self.when is When.TIP_ONLY and not has_shape)

    def updated(self, offset: Array, seen: Array, dt: float) -> Array:
        """The estimate (3,) [m] after a time dt [s] in which the offset seen was (3,) [m]."""
        offset = offset + (1.0 - exp(-dt / self.time_constant)) * (seen - offset)
        return offset * min(1.0, self.limit / max(float(np.linalg.norm(offset)), self.limit))
