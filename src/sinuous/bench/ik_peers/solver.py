"""What takes part in `sinuous bench ik`."""

from collections.abc import Callable
from dataclasses import dataclass

from sinuous.arrays import Array
from sinuous.control.geometric_ik_kernels import Arm

# Of the tip, and of the direction of the last tube times its length [m]. CCD and FABRIK converge
# linearly and slowly near the straight pose; a micrometre is what all can reach.
TOLERANCE = 1e-6

Solve = Callable[[Arm, Array, Array, Array, int], int]
"""Solves for a target (3,) from a start (n,), writes the configuration (n,), so many times over;
returns the number of iterations."""


@dataclass(frozen=True, kw_only=True)
class IKSolver:
    """A participant.

    Arguments:
        name: of it
        solve: compiled
        starts: whether it needs a configuration to start from
        settings: how it is tuned
    """

    name: str
    solve: Solve
    starts: bool = True
    settings: str = ""
