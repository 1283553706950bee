"""Building the quadratic program of one step, and solving it: two things, kept apart.

Variables are y = M delta / s, stage by stage: changes of the actuators counted in the
largest step s.  All numbers are then of order one, whatever the robot's size and rate.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import daqp
import numpy as np

from sinuous.arrays import Array
from sinuous.control.shape import Cuts
from sinuous.control.terms import Rows

SOFT, HARD = 8, 0  # DAQP's codes for a constraint
OPTIMAL = (1, 2)  # solved; solved with soft constraints violated

# A soft row costs this many times the largest cost gradient per unit of violation. It must
# exceed the row's multiplier for the penalty to be exact; in closed loops those stay below 3.
PENALTY = 100.0

# The quadratic part of the penalty, as the reciprocal weight DAQP asks for. The linear part
# makes the penalty exact; this one keeps the factorisations well conditioned.
SOFTNESS = 1e-2

# Active-set changes before the solver gives up: at least so many, and so many per variable.
ITERATIONS, ITERATIONS_PER_VARIABLE = 1000, 30

# Eigenvalues of a stage's scaled Hessian are kept above this share of the largest.
CONVEX = 1e-9


@dataclass(frozen=True, kw_only=True)
class Problem:
    """minimise 1/2 y'H y + f'y with lower <= A y <= upper, the last rows soft."""

    H: Array
    f: Array
    A: Array
    lower: Array
    upper: Array
    value: Array  # (m,) factor from a row's multiplier to [cost / m]
    size: float  # cost that counts as one
    hard: int  # the first rows must hold; the others may be violated at the price of the penalty
    penalty: float

    def with_cuts(self, scale: "Scale", placed: Sequence[tuple[int, Cuts]]) -> "Problem":
        """The same problem with soft rows cut.slack + A delta >= 0 for some stages."""
        n, count = len(scale.inverse), sum(len(cuts) for _, cuts in placed)
        A, lower, norms, row = np.zeros((count, len(self.f))), np.empty(count), np.empty(count), 0
        for stage, cuts in placed:
            rows = slice(row, row + len(cuts))
            scaled = scale.rows(cuts.jacobian)
            norms[rows] = np.linalg.norm(scaled, axis=1)  # of order one per actuator step
            A[rows, stage * n : (stage + 1) * n] = scaled / norms[rows, None]
            lower[rows] = -cuts.slack / (scale.step * norms[rows])
            row = rows.stop
        return replace(
            self,
            A=np.concatenate([self.A, A]),
            lower=np.concatenate([self.lower, lower]),
            upper=np.concatenate([self.upper, np.full(count, np.inf)]),
            value=np.concatenate([self.value, self.size / (scale.step * norms)]),
        )

    @property
    def soft_rows(self) -> int:
        """How many rows may be violated."""
        return len(self.lower) - self.hard

    def multipliers(self, solution: "Solution") -> Array:
        """Multipliers (m,) without sign in [cost / m]."""
        return np.abs(solution.multipliers) * self.value


@dataclass(frozen=True, kw_only=True)
class Solution:
    """y, the multipliers of the rows and how it went; y is of no use if `failure` is not empty."""

    y: Array
    multipliers: Array
    failure: str

    @classmethod
    def nothing(cls, failure: str = "nothing was solved") -> "Solution":
        """No solution, and why."""
        return cls(y=np.zeros(0), multipliers=np.zeros(0), failure=failure)


@dataclass(frozen=True, kw_only=True)
class Scale:
    """delta = s M^-1 y."""

    step: float  # s [m]
    inverse: Array  # M^-1 (n, n)

    def rows(self, A: Array) -> Array:
        """A M^-1: rows by y, per s."""
        return A @ self.inverse

    def hessian(self, H: Array) -> Array:
        return self.step**2 * self.inverse.T @ H @ self.inverse

    def delta(self, y: Array) -> Array:
        """Coordinates delta (N, n) of the solution (N n,)."""
        return self.step * y.reshape(-1, len(self.inverse)) @ self.inverse.T


def build(
    *,
    scale: Scale,
    hessians: Sequence[Array],
    gradients: Sequence[Array],
    effort: Array,
    increments: Array,
    rows: Sequence[tuple[Rows, Sequence[Rows]]],
) -> Problem:
    """The problem of one linearisation, without the cuts.

    Arguments:
        hessians, gradients: of the state costs, one (n, n) and (n,) per stage
        effort: Hessian (n, n) of the increment costs
        increments: predicted increments (N, n), the first one from the current configuration
        rows: hard limits of every stage and of every increment
    """
    N, n = increments.shape
    H, f = np.zeros((N, n, N, n)), np.zeros((N, n))
    E = scale.hessian(effort)
    for i in range(N):
        H[i, :, i] += convex(scale.hessian(hessians[i])) + E
        pull = scale.step * scale.inverse.T @ effort @ increments[i]
        f[i] += scale.step * gradients[i] @ scale.inverse + pull
        if i > 0:
            H[i - 1, :, i - 1] += E
            H[i, :, i - 1] -= E
            H[i - 1, :, i] -= E
            f[i - 1] -= pull
    A, lower, upper = _hard_rows(scale, increments, rows)
    size = float(np.trace(H.reshape(N * n, N * n))) / (N * n)
    return Problem(
        H=H.reshape(N * n, N * n) / size,
        f=f.ravel() / size,
        A=A,
        lower=lower,
        upper=upper,
        value=np.full(len(A), size / scale.step),
        size=size,
        hard=len(A),
        penalty=PENALTY * (1.0 + float(np.max(np.abs(f))) / size),
    )


def _hard_rows(
    scale: Scale, increments: Array, rows: Sequence[tuple[Rows, Sequence[Rows]]]
) -> tuple[Array, Array, Array]:
    """A, lower and upper of the hard rows, stage by stage."""
    N, n = increments.shape
    A, lower, upper = list[Array](), list[Array](), list[Array]()
    for i, (state, increment) in enumerate(rows):
        block = np.zeros((len(state.lower), N, n))
        block[:, i] = scale.rows(state.jacobian)
        A.append(block)
        lower.append(state.lower / scale.step)
        upper.append(state.upper / scale.step)
        for limit in increment:
            block = np.zeros((len(limit.lower), N, n))
            block[:, i] = scale.rows(limit.jacobian)
            if i > 0:
                block[:, i - 1] = -block[:, i]
            predicted = limit.jacobian @ increments[i]
            A.append(block)
            # The prediction itself stays allowed when it is out of limits by rounding.
            lower.append(np.minimum(limit.lower - predicted, 0.0) / scale.step)
            upper.append(np.maximum(limit.upper - predicted, 0.0) / scale.step)
    return np.concatenate(A).reshape(-1, N * n), np.concatenate(lower), np.concatenate(upper)


def convex(H: Array) -> Array:
    """The nearest matrix without negative curvature."""
    values, vectors = np.linalg.eigh(H)
    floor = CONVEX * max(abs(float(values[0])), abs(float(values[-1])))
    return (vectors * np.maximum(values, floor)) @ vectors.T


def solve(problem: Problem) -> Solution:
    """Solve with DAQP (dual active set); soft rows carry an L1 penalty."""
    numbers = (problem.H, problem.f, problem.A)
    bounds = (problem.lower, problem.upper)
    if not all(np.all(np.isfinite(x)) for x in numbers) or any(np.any(np.isnan(x)) for x in bounds):
        return Solution.nothing("the QP is not finite")
    y, multipliers, flag = _daqp(problem)
    if flag not in OPTIMAL:
        return Solution.nothing(FAILURES.get(flag, f"the QP solver ended with {flag}"))
    if not (np.all(np.isfinite(y)) and np.all(np.isfinite(multipliers))):
        return Solution.nothing("the QP solution is not finite")
    return Solution(y=y, multipliers=multipliers, failure="")


def _daqp(problem: Problem) -> tuple[Array, Array, int]:
    """Solution, multipliers and exit flag of DAQP."""
    sense = np.full(len(problem.A), SOFT, dtype=np.int32)
    sense[: problem.hard] = HARD
    model = daqp.Model()
    bounds = (problem.upper, problem.lower)
    flag, _ = model.setup(problem.H, problem.f, problem.A, *bounds, sense)
    if flag < 0:
        return problem.f, problem.lower, int(flag)
    most = max(ITERATIONS, ITERATIONS_PER_VARIABLE * len(problem.f))
    model.settings = {"iter_limit": most}
    # Row by row: the settings w_soft and rho_soft would weigh rows that DAQP has normalised.
    linear, softness = np.full(len(sense), problem.penalty), np.full(len(sense), SOFTNESS)
    model.soft_weights(rho_l=softness, rho_u=softness, w_l=linear, w_u=linear)
    y, _, flag, info = model.solve()
    return np.array(y), np.array(info["lam"]), int(flag)


FAILURES = {
    -1: "the QP has no solution",
    -2: "the QP solver cycled",
    -3: "the QP is unbounded",
    -4: "the QP solver reached its iteration limit",
    -5: "the QP is not convex",
    -6: "the QP solver could not start",
}
