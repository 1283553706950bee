"""Solvers for the controller's quadratic programs, each given them in the form it likes best."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, Self

import daqp
import numpy as np
import piqp
from scipy.sparse import csc_matrix

from sinuous.arrays import Array, IntArray
from sinuous.bench.qp_participant import OURS, Answer, Solver, Task
from sinuous.bench.qp_problems import KeptProblem

# DAQP adds s^2 / (2 SOFTNESS) to the price of a violation s: too little to see.
SOFTNESS = 1e6
DAQP_SOFT, DAQP_SOLVED, DAQP_ITERATIONS = 8, (1, 2), 5000
# PIQP's costs then are about as exact as ours. Scaling twice instead of ten times saves a tenth;
# these problems are scaled well.
PIQP_TOLERANCE, PIQP_SCALINGS = 1e-6, 2


def _ours(problem: KeptProblem) -> Task:
    def task() -> Answer:
        solved, y = problem.solve()
        return Answer(solved=solved, y=y)

    return task


def _daqp(problem: KeptProblem) -> Task:
    dense = problem.dense
    soft = np.isfinite(dense.price)
    sense = np.where(soft, DAQP_SOFT, 0).astype(np.int32)
    linear, softness = np.where(soft, dense.price, 1.0), np.full(len(sense), SOFTNESS)

    def task() -> Answer:
        model = daqp.Model()
        flag, setup = model.setup(dense.H, dense.f, dense.A, dense.upper, dense.lower, sense)
        if flag < 0:
            return Answer(solved=False, y=np.zeros_like(dense.f))
        model.settings = {"iter_limit": DAQP_ITERATIONS}
        # Row by row: the settings w_soft and rho_soft would weigh rows that DAQP has normalised.
        model.soft_weights(rho_l=softness, rho_u=softness, w_l=linear, w_u=linear)
        y, _, flag, info = model.solve()
        own = float(setup) + float(info["solve_time"])
        return Answer(solved=int(flag) in DAQP_SOLVED, y=np.array(y), own=own)

    return task


@dataclass(frozen=True, kw_only=True, eq=False)
class Extended:
    """minimise 1/2 x'P x + c'x with lower <= G x <= upper, x >= least, over y and the violations.

    They stand stage by stage, and so do the rows, so that all coupling is between neighbours.

    Arguments:
        back: where the entries of y are among x (N n,)
    """

    P: Array
    c: Array
    G: Array
    lower: Array
    upper: Array
    least: Array
    back: IntArray

    @classmethod
    def of(cls, problem: KeptProblem) -> Self:
        """One violation for every soft row."""
        dense, soft = problem.dense, problem.soft
        n, s, m = len(dense.f), len(soft), len(dense.lower)
        P, G = np.zeros((n + s, n + s)), np.zeros((m, n + s))
        P[:n, :n], G[:, :n] = dense.H, dense.A
        G[soft, n + np.arange(s)] = 1.0
        c = np.concatenate([dense.f, dense.price[soft]])
        least = np.concatenate([np.full(n, -np.inf), np.zeros(s)])
        own = np.repeat(np.arange(problem.stages), problem.size)
        columns = np.argsort(np.concatenate([own, problem.stage[soft]]), kind="stable")
        rows = np.argsort(problem.stage, kind="stable")
        return cls(
            P=np.asfortranarray(P[np.ix_(columns, columns)]),
            c=c[columns],
            G=np.asfortranarray(G[np.ix_(rows, columns)]),
            lower=dense.lower[rows],
            upper=dense.upper[rows],
            least=least[columns],
            back=np.argsort(columns)[:n],
        )


def _piqp_dense(problem: KeptProblem) -> Task:
    x = Extended.of(problem)

    def task() -> Answer:
        solver = piqp.DenseSolver()
        _tune(solver)
        solver.setup(x.P, x.c, None, None, x.G, x.lower, x.upper, x.least)
        return _piqp_answer(solver, x)

    return task


def _piqp_sparse(kkt: Any) -> Callable[[KeptProblem], Task]:
    def prepare(problem: KeptProblem) -> Task:
        x = Extended.of(problem)
        P, G = csc_matrix(x.P), csc_matrix(x.G)

        def task() -> Answer:
            solver = piqp.SparseSolver()
            _tune(solver)
            solver.settings.kkt_solver = kkt
            solver.setup(P, x.c, None, None, G, x.lower, x.upper, x.least)
            return _piqp_answer(solver, x)

        return task

    return prepare


def _tune(solver: Any) -> None:
    settings = solver.settings
    settings.eps_abs = settings.eps_rel = PIQP_TOLERANCE
    settings.eps_duality_gap_abs = settings.eps_duality_gap_rel = PIQP_TOLERANCE
    settings.preconditioner_iter = PIQP_SCALINGS
    settings.compute_timings = True


def _piqp_answer(solver: Any, x: Extended) -> Answer:
    solved = solver.solve() == piqp.PIQP_SOLVED
    info = solver.result.info
    own = float(info.setup_time) + float(info.solve_time)
    return Answer(solved=solved, y=np.array(solver.result.x)[x.back], own=own)


PIQP_SETTINGS: dict[str, object] = {
    "eps_abs, eps_rel, eps_duality_gap_abs, eps_duality_gap_rel": PIQP_TOLERANCE,
    "preconditioner_iter": PIQP_SCALINGS,
    "soft rows": "one more variable each, stage by stage",
}

SOLVERS = (
    Solver(
        name=OURS,
        prepare=_ours,
        settings={"form": "structured, as the controller has it; nothing is allocated"},
    ),
    Solver(
        name="DAQP",
        prepare=_daqp,
        settings={
            "rho": SOFTNESS,
            "iter_limit": DAQP_ITERATIONS,
            "soft rows": "DAQP's own, priced row by row",
        },
    ),
    Solver(name="PIQP dense", prepare=_piqp_dense, settings=PIQP_SETTINGS),
    Solver(
        name="PIQP sparse", prepare=_piqp_sparse(piqp.KKTSolver.sparse_ldlt), settings=PIQP_SETTINGS
    ),
    Solver(
        name="PIQP multistage",
        prepare=_piqp_sparse(piqp.KKTSolver.sparse_multistage),
        settings=PIQP_SETTINGS,
    ),
)
