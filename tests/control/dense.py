"""The QP of a step solved by PIQP, a library's interior-point method: the oracle."""

from typing import NamedTuple

import numpy as np
import piqp

from sinuous.arrays import Array
from sinuous.control.qp import DenseProblem


class Solution(NamedTuple):
    """y, and the multipliers of the lower sides of the rows."""

    y: Array
    lower: Array


def solved(problem: DenseProblem) -> Solution:
    """Solve with an explicit violation s >= 0 for every soft row, at its price."""
    soft = np.flatnonzero(np.isfinite(problem.price))
    n, m, s = len(problem.f), len(problem.lower), len(soft)
    P, c = np.zeros((n + s, n + s)), np.concatenate([problem.f, problem.price[soft]])
    P[:n, :n] = problem.H
    G = np.zeros((m, n + s))
    G[:, :n] = problem.A
    G[soft, n + np.arange(s)] = 1.0
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = 1e-9
    least = np.concatenate([np.full(n, -np.inf), np.zeros(s)])
    solver.setup(
        np.asfortranarray(P), c, None, None, np.asfortranarray(G), problem.lower, problem.upper,
        least,
    )  # fmt: skip
    assert solver.solve() == piqp.PIQP_SOLVED
    return Solution(solver.result.x[:n], np.asarray(solver.result.z_l))
