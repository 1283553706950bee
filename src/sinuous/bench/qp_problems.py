"""The quadratic programs that the controller meets on the stress scene, kept to be solved again."""

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.bench.ours import Ours
from sinuous.bench.scene import Scene
from sinuous.compiled import kernel
from sinuous.control.qp import DenseProblem
from sinuous.control.step import interior, plan, rows
from sinuous.control.step.data import Work
from sinuous.control.step.memory import new_work
from sinuous.control.step.step import first_problem


@dataclass(frozen=True, kw_only=True, eq=False)
class KeptProblem:
    """A problem as the controller has it, and as plain matrices.

    Arguments:
        work: the controller's scratch with the problem in it
        dense: the same as plain matrices
        size: n, variables of a stage
        stage: of every row (m,)
    """

    work: Work
    dense: DenseProblem
    size: int
    stage: IntArray

    @property
    def stages(self) -> int:
        """N."""
        return len(self.dense.f) // self.size

    @cached_property
    def soft(self) -> IntArray:
        """Rows that may be violated at a price."""
        return np.flatnonzero(np.isfinite(self.dense.price))

    def solve(self) -> tuple[bool, Array]:
        """Solve with the controller's own solver, as it does: whether it did, and y (N n,)."""
        status, y = _solve(self.work, len(self.stage))
        return status == interior.SOLVED, y.ravel()

    def cost(self, y: Array) -> float:
        """With what the violations of y (N n,) cost."""
        dense, soft = self.dense, self.soft
        short = np.maximum(dense.lower[soft] - dense.A[soft] @ y, 0.0)
        return float(0.5 * y @ dense.H @ y + dense.f @ y + dense.price[soft] @ short)

    def error(self, y: Array) -> float:
        """By how much the worst hard row is broken [largest steps of an actuator]."""
        dense, hard = self.dense, np.isinf(self.dense.price)
        value = dense.A[hard] @ y
        over = np.maximum(dense.lower[hard] - value, value - dense.upper[hard])
        return float(np.max(over, initial=0.0))


@kernel
def _solve(work: Work, count: int) -> tuple[int, Array]:
    problem = work.problem
    status, _ = interior.solve(
        problem.H, problem.E, problem.f, problem.rows, count, work.pairs, work.iterate, np.inf
    )
    return status, work.iterate.y


def collect(scene: Scene, horizon: int, every: int) -> Iterator[KeptProblem]:
    """The first QP of every so many steps of a drive through the scene."""
    mpc = Ours.of(scene, horizon, disks_only=False).mpc
    state, n = mpc.init(scene.start), len(scene.start)
    none = np.zeros((0, n, n)), np.zeros((0, n))
    for k, target in enumerate(scene.targets):
        if k % every == 0:
            work = new_work(mpc.model, horizon)
            prepared = plan.prepare(
                mpc.model, work, state.c, state.points, state.clearance, state.plan,
                state.contacts, target, *none, np.inf,
            )  # fmt: skip
            first = first_problem(work, prepared.rows)
            stage = first.place[: first.total, rows.STAGE].copy()
            yield KeptProblem(work=work, dense=DenseProblem.of(first), size=n, stage=stage)
        state, _ = mpc.step(state, target)
