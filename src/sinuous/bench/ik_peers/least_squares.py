"""Damped least squares, and Newton's method with the pseudo-inverse, on the analytic Jacobian.

Damping is half the squared error plus a little, after Sugihara, "Solvability-unconcerned inverse
kinematics by the Levenberg-Marquardt method" (2011): careful far away, Newton's method close by.
The pseudo-inverse leaves out directions that the chain can hardly move into.
"""

from sinuous.arrays import Array
from sinuous.bench.ik_peers.solver import TOLERANCE, IKSolver
from sinuous.bench.ik_peers.task import (
    Scratch,
    differentiate,
    forward,
    goal_of,
    left_to_do,
    move,
    new_scratch,
    solve_damped,
    straighten_last,
)
from sinuous.compiled import inner, kernel
from sinuous.control.geometric_ik_kernels import Arm
from sinuous.control.step.eigen import decompose

# Tuned on other targets than those that count: fewest failures first, then shortest times.
LIMIT = 200  # iterations
MOST = 0.3  # change of an angle in one of them [rad]
DAMPING, LEAST_DAMPING = 0.5, 1e-8  # of the squared error; [m^2]
CUT = 1e-5  # singular values left out, by the largest


@kernel
def dls_reduced(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """Damped least squares on the reduced task."""
    return _iterate(arm, target, start, c, repeats, new_scratch(arm, False), True)


@kernel
def dls_whole(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """Damped least squares on the whole task."""
    return _iterate(arm, target, start, c, repeats, new_scratch(arm, True), True)


@kernel
def newton_reduced(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """Newton's method on the reduced task."""
    return _iterate(arm, target, start, c, repeats, new_scratch(arm, False), False)


@kernel
def newton_whole(arm: Arm, target: Array, start: Array, c: Array, repeats: int) -> int:
    """Newton's method on the whole task."""
    return _iterate(arm, target, start, c, repeats, new_scratch(arm, True), False)


@inner
def _iterate(
    arm: Arm, target: Array, start: Array, c: Array, repeats: int, scratch: Scratch, damped: bool
) -> int:
    iteration, joints = 0, scratch.axes.shape[0]
    for _ in range(repeats):
        for i in range(c.size):
            c[i] = start[i]
        iteration, goal = 0, goal_of(arm, target, scratch)
        frame = forward(arm, c, joints, scratch.p, scratch.axes)
        square = left_to_do(arm, goal, frame, scratch)
        while square > TOLERANCE * TOLERANCE and iteration < LIMIT:
            differentiate(arm, frame, scratch)
            if damped:
                solve_damped(scratch.W, scratch.e, DAMPING * square + LEAST_DAMPING, scratch.f)
            else:
                pseudo_inverse(scratch)
            move(arm, scratch, MOST, c)
            frame = forward(arm, c, joints, scratch.p, scratch.axes)
            square = left_to_do(arm, goal, frame, scratch)
            iteration += 1
        straighten_last(arm, frame, scratch, c)
    return iteration


@inner
def pseudo_inverse(scratch: Scratch) -> None:
    """f = (J J')^+ e by the eigenvalues of J J'; those below the cut count as zeros."""
    W, e, f, values = scratch.W, scratch.e, scratch.f, scratch.values
    decompose(W, values, scratch.spare)
    largest = 0.0
    for k in range(values.size):
        largest = max(largest, values[k])
        f[k] = 0.0
    for k in range(values.size):
        if values[k] > CUT * CUT * largest:
            share = 0.0
            for i in range(e.size):
                share += W[i, k] * e[i]
            for i in range(f.size):
                f[i] += W[i, k] * share / values[k]


_STEPS = f"steps of at most {MOST} rad per angle, {LIMIT} iterations"
_DAMPED = f"damping {DAMPING} |e|^2 + {LEAST_DAMPING} m^2, {_STEPS}"
_CUT = f"singular values below {CUT} of the largest left out, {_STEPS}"

LEAST_SQUARES = (
    IKSolver(name="DLS", solve=dls_reduced, settings=f"reduced task, {_DAMPED}"),
    IKSolver(name="DLS, 5 rows", solve=dls_whole, settings=f"whole task, {_DAMPED}"),
    IKSolver(name="Newton", solve=newton_reduced, settings=f"reduced task, {_CUT}"),
    IKSolver(name="Newton, 5 rows", solve=newton_whole, settings=f"whole task, {_CUT}"),
)
