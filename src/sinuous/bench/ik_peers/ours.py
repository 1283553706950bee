"""The geometric solution as a participant."""

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.ik_peers.solver import IKSolver
from sinuous.compiled import kernel
from sinuous.control.geometric_ik import GeometricIK
from sinuous.control.geometric_ik_kernels import Arm, solve


@kernel
def geometric(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """The closed form, so many times over; where it starts from does not matter."""
    nearest = np.empty(3)
    for _ in range(repeats):
        solve(arm, target, c, nearest)
    return 0


OURS = IKSolver(name="sinuous", solve=geometric, starts=False, settings="closed form")


def called_from_python(ik: GeometricIK) -> IKSolver:
    """The same as a control loop calls it, target by target."""

    def solve(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
        for _ in range(repeats):
            c[:] = ik.solve_one(target).c
        return 0

    settings = "closed form, `GeometricIK.solve_one`"
    return IKSolver(name="from Python", solve=solve, starts=False, settings=settings)
