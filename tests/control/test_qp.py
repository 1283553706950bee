"""The QP of a step: against two other solvers, KKT, sensitivities, and when it must fail."""

from dataclasses import dataclass, replace

import daqp
import numpy as np
import piqp
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from sinuous.arrays import Array, IntArray
from sinuous.control.metric import actuator_metric
from sinuous.control.qp import DenseProblem
from sinuous.control.report import Status
from sinuous.control.step import blocks, interior
from sinuous.control.step.interior import (
    GAP,
    NOT_FINITE,
    RESIDUAL,
    SOLVED,
    STATIONARY,
    UNFINISHED,
)
from sinuous.control.step.linearise import CONVEX, make_convex
from sinuous.control.step.rows import INCREMENT, KIND, LAST, STAGE, STATE
from sinuous.control.step.step import FirstProblem

from .scenes import START, bent_tube

FEASIBLE = 1e-8  # of rows of order one: the solver's own figure is 1e-9
ORACLE = 1e-8  # relative to 1 + |cost|: the oracles end at 1e-9 and better
VARIABLES = 1e-6  # of variables that are of order one and well determined
ROUNDING = 1e-11  # relative: sums of a few hundred terms
SLOPE = 1e-3  # relative error of a multiplier; its row's slack is that of the whole gap
# What a step of the closed loop may be off, of the tip and along its null space, where the cost
# is as good as flat [m].
TIP, LENGTH = 1e-5, 1e-5
# DAQP adds s^2 / (2 SOFTNESS) to the price of a violation s; a million is as large as it can
# take, and too little to see.
SOFTNESS = 1e6

seeds = st.integers(0, 2**32 - 1)


@dataclass(frozen=True, kw_only=True)
class Solution:
    """How the solver ended, y (N n,), and the multipliers of lower and upper sides (m, 2)."""

    status: int
    y: Array
    multipliers: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Structured:
    """A problem in the form of `interior.solve_alone`."""

    H: Array
    E: Array
    f: Array
    a: Array
    lower: Array
    upper: Array
    price: Array
    stage: IntArray
    kind: IntArray

    def solve(self) -> Solution:
        status, _, y, multipliers = interior.solve_alone(
            self.H, self.E, self.f, self.a, self.lower, self.upper, self.price, self.stage,
            self.kind,
        )  # fmt: skip
        return Solution(status=status, y=y.ravel(), multipliers=multipliers)

    @property
    def dense(self) -> DenseProblem:
        m, n = self.a.shape
        place = np.zeros((m, 4), dtype=np.int64)
        place[:, LAST], place[:, STAGE], place[:, KIND] = n, self.stage, self.kind
        none = np.zeros(m, dtype=np.int64)
        return DenseProblem.of(
            FirstProblem(
                H=self.H, f=self.f, E=self.E, a=self.a, place=place,
                bound=np.column_stack([self.lower, self.upper, self.price]), what=none,
                which=none, total=m,
            )
        )  # fmt: skip

    @classmethod
    def of(cls, dense: DenseProblem, n: int) -> "Structured":
        """The other way round, for stages of n variables."""
        N, m = len(dense.f) // n, len(dense.lower)
        H = dense.H.reshape(N, n, N, n)
        # One stage alone does not tell its own cost from that of its increment.
        E = -H[0, :, 1] if N > 1 else H[0, :, 0]
        stages = [H[i, :, i] - (2.0 if i + 1 < N else 1.0) * E for i in range(N)]
        A = dense.A.reshape(m, N, n)
        used = np.any(A != 0.0, axis=2)
        stage = N - 1 - np.argmax(used[:, ::-1], axis=1)
        # The first increment is the first state.
        kind = np.where(np.sum(used, axis=1) > 1, INCREMENT, STATE)
        return cls(
            H=np.array(stages), E=np.ascontiguousarray(E), f=dense.f.reshape(N, n),
            a=A[np.arange(m), stage], lower=dense.lower, upper=dense.upper, price=dense.price,
            stage=stage, kind=kind,
        )  # fmt: skip

    def with_row(
        self, a: Array, lower: float, upper: float, price: float, stage: int
    ) -> "Structured":
        """With one more row on the state."""
        return replace(
            self,
            a=np.vstack([self.a, a]),
            lower=np.append(self.lower, lower),
            upper=np.append(self.upper, upper),
            price=np.append(self.price, price),
            stage=np.append(self.stage, stage),
            kind=np.append(self.kind, STATE),
        )


def certificate(problem: Structured, solution: Solution) -> float:
    """What the cost may be off when the solver's own figures hold: gap, gradient and rows."""
    hard, z = np.isinf(problem.price), solution.multipliers
    sides = 2 * int(np.sum(~hard)) + 1
    sides += int(np.sum(np.isfinite(problem.lower[hard])))
    sides += int(np.sum(np.isfinite(problem.upper[hard])))
    scale = max(1.0, float(np.max(np.abs(problem.f)))) + float(np.max(z))
    far = float(np.sum(np.abs(solution.y)))
    return (sides * GAP + STATIONARY * far) * scale + RESIDUAL * float(np.sum(z[hard]))


def random_rows(rng: np.random.Generator, n: int, count: int) -> tuple[Array, Array, Array]:
    """Hard rows that allow zero, some of them barely, some one-sided, one of them twice."""
    a, lower, upper = rng.normal(size=(count, n)), *rng.uniform(0.2, 2.0, (2, count))
    touching = rng.uniform(size=count)
    lower[touching < 0.05], upper[touching > 0.95] = 0.0, 0.0
    lower[rng.uniform(size=count) < 0.2] = np.inf
    upper[rng.uniform(size=count) < 0.2] = np.inf
    share = rng.choice([1.0, 1.5])
    a[-1], lower[-1], upper[-1] = share * a[0], share * lower[0], share * upper[0]
    return a, -lower, upper


def random_problem(
    seed: int,
    *,
    soft: int = 6,
    room: float = 0.3,
    stages: int | None = None,
    prices: tuple[float, float] = (100.0, 100.0),
) -> Structured:
    """A problem of 1 to 6 stages as the controller builds it, with soft rows in each stage.

    Arguments:
        soft: rows per stage
        room: mean slack of the soft rows, which spreads by one
        prices: least and largest, in units of 1 + the largest gradient as in the controller
    """
    rng = np.random.default_rng(seed)
    N, n = stages or int(rng.integers(1, 7)), int(rng.integers(2, 10))
    roots = rng.normal(size=(N + 1, n, n)) / np.sqrt(n)
    roots[:N, rng.integers(1, n + 1) :] = 0.0  # some stages' costs are flat in some directions
    squares = np.einsum("kji,kjl->kil", roots, roots)
    f = rng.uniform(0.3, 10.0) * rng.normal(size=(N, n))
    parts = list[tuple[Array, Array, Array, Array, IntArray, IntArray]]()
    for i in range(N):
        for kind, count in ((STATE, n + 2), (INCREMENT, n)):
            hard = np.full(count, np.inf)
            at = np.full(count, i)
            parts.append((*random_rows(rng, n, count), hard, at, np.full(count, kind)))
    for i in range(N):
        a = rng.normal(size=(soft, n))
        a[-1] = a[0]
        a /= np.linalg.norm(a, axis=1)[:, None]
        price = (1.0 + np.max(np.abs(f))) * np.exp(rng.uniform(*np.log(prices), soft))
        lower = -rng.normal(room, 1.0, soft)
        above = np.full(soft, np.inf)
        parts.append((a, lower, above, price, np.full(soft, i), np.full(soft, STATE)))
    a, lower, upper, price, stage, kind = (
        np.concatenate([part[k] for part in parts]) for k in range(6)
    )
    return Structured(H=squares[:N], E=0.1 * np.eye(n) + 0.3 * squares[N], f=f, a=a, lower=lower,
                      upper=upper, price=price, stage=stage, kind=kind)  # fmt: skip


def by_piqp(problem: DenseProblem) -> Array:
    """y, with a slack variable for every soft row."""
    used = np.isfinite(problem.lower) | np.isfinite(problem.upper)
    A, lower, upper = problem.A[used], problem.lower[used], problem.upper[used]
    n, prices = len(problem.f), problem.price[used]
    soft = np.flatnonzero(np.isfinite(prices))
    P, G = np.zeros((n + len(soft),) * 2), np.zeros((len(lower), n + len(soft)))
    P[:n, :n], G[:, :n] = problem.H, A
    G[soft, n + np.arange(len(soft))] = 1.0
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = 1e-10
    solver.settings.eps_duality_gap_abs = solver.settings.eps_duality_gap_rel = 1e-10
    solver.setup(
        np.asfortranarray(P), np.concatenate([problem.f, prices[soft]]), None, None,
        np.asfortranarray(G), lower, upper,
        np.concatenate([np.full(n, -np.inf), np.zeros(len(soft))]),
    )  # fmt: skip
    assert solver.solve() == piqp.PIQP_SOLVED
    return solver.result.x[:n]


def by_daqp(problem: DenseProblem) -> Array:
    """y, with soft rows priced row by row: w_soft and rho_soft would weigh normalised rows."""
    soft = np.isfinite(problem.price)
    sense = np.where(soft, 8, 0).astype(np.int32)  # DAQP's codes for soft and hard
    model = daqp.Model()
    bounds = (problem.upper, problem.lower)
    flag, _ = model.setup(problem.H, problem.f, problem.A, *bounds, sense)
    assert flag >= 0
    model.settings = {"iter_limit": 5000}
    linear, softness = np.where(soft, problem.price, 1.0), np.full(len(sense), SOFTNESS)
    model.soft_weights(rho_l=softness, rho_u=softness, w_l=linear, w_u=linear)
    y, _, flag, _ = model.solve()
    assert flag in (1, 2)  # solved; solved with soft rows violated
    return np.array(y)


def violation(problem: DenseProblem, y: Array) -> Array:
    """By how much each soft row is violated."""
    return np.maximum(problem.lower - problem.A @ y, 0.0)[np.isfinite(problem.price)]


def cost(problem: DenseProblem, y: Array) -> float:
    """With what the violations cost."""
    prices = problem.price[np.isfinite(problem.price)]
    return float(0.5 * y @ problem.H @ y + problem.f @ y + prices @ violation(problem, y))


def assert_hard_rows_hold(problem: DenseProblem, y: Array) -> None:
    hard = np.isinf(problem.price)
    value = problem.A[hard] @ y
    assert np.all(value >= problem.lower[hard] - FEASIBLE)
    assert np.all(value <= problem.upper[hard] + FEASIBLE)


def assert_optimal(problem: Structured, solution: Solution, y: Array) -> None:
    """The cost is that of the oracle's y, and both are where the cost is strongly convex."""
    dense = problem.dense
    assert solution.status == SOLVED
    assert_hard_rows_hold(dense, solution.y)
    least, room = cost(dense, y), certificate(problem, solution)
    room += ORACLE * (1 + abs(least))
    assert abs(cost(dense, solution.y) - least) < room
    # At least half the squared distance in the norm of H is lost by not being at the optimum.
    apart = solution.y - y
    assert 0.5 * apart @ dense.H @ apart < 4 * room


@given(
    seed=seeds,
    soft=st.sampled_from([1, 2, 6, 12]),
    room=st.sampled_from([-0.3, 0.3, 3.0]),
    prices=st.sampled_from([(100.0, 100.0), (0.05, 100.0)]),
)
@settings(max_examples=200)
def test_agrees_with_two_other_solvers(
    seed: int, soft: int, room: float, prices: tuple[float, float]
) -> None:
    problem = random_problem(seed, soft=soft, room=room, prices=prices)
    solution = problem.solve()
    assert_optimal(problem, solution, by_piqp(problem.dense))
    assert_optimal(problem, solution, by_daqp(problem.dense))


@pytest.mark.parametrize(
    ("seed", "soft", "room", "least_price"),
    [
        (100219, 6, 0.3, 100.0),
        (104549, 6, 0.3, 100.0),
        (109821, 6, 0.3, 100.0),
        (103945, 6, 3.0, 0.05),
        (105147, 6, 3.0, 0.05),
        (169602, 6, 3.0, 0.05),
        (102538, 1, 0.3, 0.05),
        (106407, 1, 0.3, 0.05),
    ],
)
def test_steps_that_get_nowhere_do_not_repeat(
    seed: int, soft: int, room: float, least_price: float
) -> None:
    """One in ten thousand problems makes Mehrotra's predictor and corrector cycle."""
    problem = random_problem(seed, soft=soft, room=room, prices=(least_price, 100.0))
    assert_optimal(problem, problem.solve(), by_piqp(problem.dense))


@pytest.mark.parametrize("stages", [1, 2, 3, 5, 8, 13, 20])
def test_every_horizon_is_solved(stages: int) -> None:
    for seed in range(4):
        problem = random_problem(seed, stages=stages, soft=8)
        assert_optimal(problem, problem.solve(), by_piqp(problem.dense))


@given(seed=seeds, prices=st.sampled_from([(100.0, 100.0), (0.05, 10.0)]))
@settings(max_examples=100)
def test_satisfies_kkt(seed: int, prices: tuple[float, float]) -> None:
    problem = random_problem(seed, prices=prices)
    dense, solution = problem.dense, problem.solve()
    y, (low, high) = solution.y, solution.multipliers.T
    scale = max(1.0, float(np.max(np.abs(problem.f)))) + float(np.max(solution.multipliers))
    gradient = dense.H @ y + dense.f - dense.A.T @ (low - high)
    assert np.max(np.abs(gradient)) < 2 * STATIONARY * scale
    assert np.min(solution.multipliers) >= 0.0
    assert_hard_rows_hold(dense, y)
    # Only rows that are reached push, and soft ones that are violated push with all their price.
    room, soft = certificate(problem, solution), np.isfinite(problem.price)
    value = dense.A @ y
    below, above = np.isfinite(problem.lower), np.isfinite(problem.upper)
    left, spare = value - problem.lower, problem.upper - value
    assert np.all(low[below] * np.maximum(left[below], 0.0) < room)
    assert np.all(high[above] * np.maximum(spare[above], 0.0) < room)
    assert np.all(low[~below] == 0.0)
    assert np.all(high[~above] == 0.0)
    assert np.all(low[soft] <= problem.price[soft] * (1 + ROUNDING))
    assert np.all((problem.price - low)[soft] * np.maximum(-left[soft], 0.0) < room)


@given(seed=seeds)
@settings(max_examples=60)
def test_penalty_is_exact(seed: int) -> None:
    """Soft rows that can hold do hold: the penalty exceeds every multiplier."""
    problem = random_problem(seed, room=3.0)
    solution = problem.solve()
    hard = replace(problem, price=np.full(len(problem.price), np.inf))
    strict = hard.solve()
    soft = np.isfinite(problem.price)
    if strict.status != SOLVED or np.any(strict.multipliers[soft, 0] > 0.5 * problem.price[soft]):
        return  # they cannot all hold, or at no such price
    assert_optimal(problem, solution, strict.y)
    room = certificate(problem, solution)
    assert np.max(violation(problem.dense, solution.y)) < room / (0.5 * np.min(problem.price))


@given(seed=seeds)
@settings(max_examples=60)
def test_conflicting_soft_rows_are_violated_as_little_as_possible(seed: int) -> None:
    """Against a linear program whose only cost is the sum of the violations."""
    problem = random_problem(seed, soft=12, room=-0.1)
    solution, dense = problem.solve(), problem.dense
    assert solution.status == SOLVED
    assert_hard_rows_hold(dense, solution.y)
    hard = np.isinf(problem.price)
    n, soft, price = len(dense.f), int(np.sum(~hard)), float(np.min(problem.price))
    above, below = np.isfinite(problem.upper), hard & np.isfinite(problem.lower)
    A = np.hstack([dense.A, np.zeros((len(hard), soft))])
    A[~hard, n:] = np.eye(soft)
    least = linprog(
        np.concatenate([np.zeros(n), np.ones(soft)]),
        A_ub=np.concatenate([A[above], -A[below], -A[~hard]]),
        b_ub=np.concatenate([problem.upper[above], -problem.lower[below], -problem.lower[~hard]]),
        bounds=[(None, None)] * n + [(0.0, None)] * soft,
    )
    # The sum may exceed the least one by what the other parts of the cost gain, per price.
    total, y = float(np.sum(violation(dense, solution.y))), least.x[:n]
    gained = cost(dense, y) - price * float(np.sum(violation(dense, y)))
    gained -= cost(dense, solution.y) - price * total
    assert total < least.fun + (gained + certificate(problem, solution)) / price + FEASIBLE * soft


def test_a_soft_row_never_moves_a_hard_one() -> None:
    """However dear: a hard row that stands in the way holds, and the soft one gives way."""
    problem = simple(price=np.array([np.inf, 1e6]), a=np.array([[1.0, 0.0], [1.0, 0.0]]),
                     lower=np.array([-3.0, 5.0]))  # fmt: skip
    solution = problem.solve()
    assert solution.status == SOLVED
    assert solution.y[0] == pytest.approx(3.0, abs=FEASIBLE)
    assert solution.multipliers[1, 0] == pytest.approx(1e6, rel=SLOPE)


@pytest.mark.parametrize("stretch", [1.0, 100.0])
def test_two_soft_rows_outvote_a_third(stretch: float) -> None:
    """As an L1 penalty does; a quadratic one would settle between them, at a third.

    It counts violations of the rows as they are, however flat the cost is along them.
    """
    problem = flat(
        stretch, 0.0, a=np.array([[-1.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]),
        lower=np.array([0.0, 0.0, 0.03]),
    )  # fmt: skip
    solution = problem.solve()
    assert solution.status == SOLVED
    np.testing.assert_allclose(solution.y, [0.0, 0.0], rtol=0, atol=VARIABLES)


@pytest.mark.parametrize("stretch", [0.01, 1.0, 100.0])
def test_a_soft_row_gives_way_at_its_price(stretch: float) -> None:
    """Whatever the curvature along the row: it holds while its multiplier is below."""
    row = {"a": np.array([[1.0, 0.0]]), "lower": np.zeros(1)}
    kept, given_up = (flat(stretch, push, **row).solve() for push in (9.9, 10.1))
    assert kept.status == given_up.status == SOLVED
    # Both are off by what the gap, of 3 products and relative to the push, buys at 0.1.
    room = 3 * GAP * 20.0 / 0.1
    assert abs(kept.y[0]) < room
    # Beyond, the push 0.1 is balanced by the curvature.
    assert given_up.y[0] == pytest.approx(-0.1 * stretch**2, rel=1e-3, abs=room)


@given(seed=seeds)
@settings(max_examples=40)
def test_multipliers_are_the_worth_of_room(seed: int) -> None:
    """What the optimal cost loses when a wall steps back.

    That cost is convex in the room, so the multiplier lies between the slopes to both sides
    however long these are.
    """
    problem = random_problem(seed, soft=1)
    rng = np.random.default_rng(seed)
    # A cut that costs something: it forbids half of the way that would be taken without it.
    a = rng.normal(size=problem.f.shape[1])
    stage = int(rng.integers(len(problem.f)))
    way = float(a @ problem.solve().y.reshape(problem.f.shape)[stage])
    a, way = -np.sign(way) * a, abs(way)
    price = float(np.max(problem.price))
    shifted = [
        problem.with_row(a, -0.5 * way - room, np.inf, price, stage)
        for room in (-0.1 * way, 0.0, 0.1 * way)
    ]
    values = [cost(one.dense, by_piqp(one.dense)) for one in shifted]
    worth = shifted[1].solve().multipliers[-1, 0]
    steep, flat = (values[0] - values[1]) / (0.1 * way), (values[1] - values[2]) / (0.1 * way)
    error = SLOPE * (1.0 + steep)
    assert flat - error <= worth <= steep + error


# --- the dense form ------------------------------------------------------------------------


@given(seed=seeds)
@settings(max_examples=40)
def test_the_dense_form_adds_up_stages_and_increments(seed: int) -> None:
    """Cost and rows from the structured problem's own parts, at a random place."""
    problem = random_problem(seed)
    N, n = problem.f.shape
    y = np.random.default_rng(seed).normal(size=(N, n))
    v = np.diff(y, axis=0, prepend=np.zeros((1, n)))
    exact = sum(
        problem.f[i] @ y[i] + 0.5 * y[i] @ problem.H[i] @ y[i] + 0.5 * v[i] @ problem.E @ v[i]
        for i in range(N)
    )
    dense = problem.dense
    modelled = 0.5 * y.ravel() @ dense.H @ y.ravel() + dense.f @ y.ravel()
    assert modelled == pytest.approx(float(exact), rel=ROUNDING, abs=ROUNDING)
    acted = np.where((problem.kind == STATE)[:, None], y[problem.stage], v[problem.stage])
    np.testing.assert_allclose(
        dense.A @ y.ravel(), np.sum(problem.a * acted, axis=1), rtol=0, atol=ROUNDING * n
    )


def test_the_qp_of_a_step_is_the_one_that_can_be_looked_at() -> None:
    """Steps of a closed loop that took one QP and all of it, against oracles on `mpc.problem`."""
    scene = bent_tube()
    mpc, robot = scene.mpc(), scene.robot
    inverse = np.linalg.inv(actuator_metric(robot))
    step = float(np.max(robot.rate_limits)) * mpc.dt
    state, compared, walls = mpc.init(START), 0, 0
    for k in range(120):
        target = scene.axis[20] if k < 60 else scene.axis[27] + [0.02, 0.0, 0.0]
        problem, before = mpc.problem(state, target), state
        state, command = mpc.step(state, target)
        report = command.report
        assert report.status is not Status.HOLDING
        if report.workload.qps > 1 or report.workload.halvings or report.step_fraction < 1.0:
            continue
        for y in (by_piqp(problem), by_daqp(problem)):
            c = before.plan[0] + step * inverse @ y[: len(state.c)]
            assert np.linalg.norm(robot.tip(state.c) - robot.tip(c)) < TIP
            assert np.max(np.abs(robot.lengths(state.c) - robot.lengths(c))) < LENGTH
        compared += 1
        walls += any(active.triangle >= 0 for active in report.active)
    assert compared > 60
    assert walls > 10


@pytest.mark.parametrize("horizon", [1, 5, 20])
def test_the_qps_of_a_closed_loop_are_solved(horizon: int) -> None:
    scene = bent_tube()
    mpc = scene.mpc(horizon)
    state = mpc.init(START)
    for k in range(40):
        target = scene.axis[20] if k < 20 else scene.axis[27] + [0.02, 0.0, 0.0]
        if k % 4 == 3:
            dense = mpc.problem(state, target)
            problem = Structured.of(dense, len(START))
            np.testing.assert_allclose(problem.dense.H, dense.H, rtol=0, atol=ROUNDING)
            np.testing.assert_array_equal(problem.dense.A, dense.A)
            assert_optimal(problem, problem.solve(), by_piqp(dense))
        state, _ = mpc.step(state, target)


# --- block tridiagonal systems -------------------------------------------------------------


@given(seed=seeds, stages=st.integers(1, 20), n=st.integers(1, 9))
@settings(max_examples=60)
def test_block_tridiagonal_systems_are_solved(seed: int, stages: int, n: int) -> None:
    rng = np.random.default_rng(seed)
    # L L' of a block bidiagonal L is block tridiagonal and positive definite.
    L = np.zeros((stages, n, stages, n))
    for i in range(stages):
        L[i, :, i] = np.tril(0.3 * rng.normal(size=(n, n)), -1) + np.diag(rng.uniform(0.7, 2.0, n))
        if i > 0:
            L[i, :, i - 1] = 0.3 * rng.normal(size=(n, n))
    L = L.reshape(stages * n, stages * n)
    A = (L @ L.T).reshape(stages, n, stages, n)
    D = np.array([np.tril(A[i, :, i]) for i in range(stages)])
    C = np.array([A[i - 1, :, i] if i > 0 else np.full((n, n), np.nan) for i in range(stages)])
    x = rng.normal(size=(stages, n))
    expected = np.linalg.solve(A.reshape(stages * n, stages * n), x.ravel())
    blocks.factor(D, C)
    blocks.solve(D, C, x)
    error = np.max(np.abs(x.ravel() - expected))
    assert error < ROUNDING * np.linalg.cond(L) ** 2 * (1 + np.max(np.abs(expected)))


# --- convexity -----------------------------------------------------------------------------


def convex(H: Array) -> Array:
    out = H.copy()
    make_convex(out, np.full_like(H, np.nan), np.full(len(H), np.nan), np.full(len(H), np.nan))
    return out


@given(seed=seeds)
@settings(max_examples=40)
def test_convex_leaves_positive_matrices_alone(seed: int) -> None:
    root = np.random.default_rng(seed).normal(size=(6, 6)) + 3.0 * np.eye(6)
    H = root.T @ root
    if np.linalg.eigvalsh(H)[0] < 100 * CONVEX * np.linalg.eigvalsh(H)[-1]:
        return
    np.testing.assert_array_equal(convex(H), H)


@given(seed=seeds)
@settings(max_examples=40)
def test_convex_removes_negative_curvature_and_no_other(seed: int) -> None:
    rng = np.random.default_rng(seed)
    vectors = np.linalg.qr(rng.normal(size=(6, 6)))[0]
    values = rng.uniform(-5.0, 5.0, 6)
    kept = vectors.T @ convex((vectors * values) @ vectors.T) @ vectors
    expected = np.maximum(values, CONVEX * np.max(np.abs(values)))
    np.testing.assert_allclose(kept, np.diag(expected), rtol=0, atol=1e-12)


def test_convex_of_nothing_is_nothing() -> None:
    assert np.all(convex(np.zeros((3, 3))) == 0.0)


# --- failures ------------------------------------------------------------------------------


def simple(**fields: Array) -> Structured:
    """Two variables, one hard and one soft row."""
    problem = Structured(
        H=0.5 * np.eye(2)[None], E=0.5 * np.eye(2), f=np.ones((1, 2)), a=np.eye(2),
        lower=np.full(2, -3.0), upper=np.array([3.0, np.inf]), price=np.array([np.inf, 1e3]),
        stage=np.zeros(2, dtype=np.int64), kind=np.full(2, STATE),
    )  # fmt: skip
    return replace(problem, **fields)


def flat(stretch: float, push: float, *, a: Array, lower: Array) -> Structured:
    """Two variables of curvature 1 / stretch^2, and soft rows at a price of 10."""
    m, curvature = len(a), np.eye(2) / stretch**2
    return Structured(
        H=np.zeros((1, 2, 2)), E=curvature, f=np.array([[push, 0.0]]), a=a, lower=lower,
        upper=np.full(m, np.inf), price=np.full(m, 10.0), stage=np.zeros(m, dtype=np.int64),
        kind=np.full(m, STATE),
    )  # fmt: skip


def test_the_simple_problem_itself_can_be_solved() -> None:
    solution = simple().solve()
    assert solution.status == SOLVED
    np.testing.assert_allclose(solution.y, [-1.0, -1.0], rtol=0, atol=VARIABLES)


@given(seed=seeds)
@settings(max_examples=60)
def test_hard_rows_that_conflict_are_a_failure(seed: int) -> None:
    rng = np.random.default_rng(seed)
    problem = random_problem(seed)
    a, gap = rng.normal(size=problem.f.shape[1]), 10.0 ** rng.uniform(-3.0, 1.0)
    stage = int(rng.integers(len(problem.f)))
    problem = problem.with_row(a, gap, np.inf, np.inf, stage)
    problem = problem.with_row(a, -np.inf, -gap, np.inf, stage)
    assert problem.solve().status in (UNFINISHED, NOT_FINITE)


@given(seed=seeds)
@settings(max_examples=60)
def test_rows_that_leave_no_interior_end(seed: int) -> None:
    """An interior-point method need not solve these; what it calls solved, is."""
    rng = np.random.default_rng(seed)
    problem = random_problem(seed)
    a, stage = rng.normal(size=problem.f.shape[1]), int(rng.integers(len(problem.f)))
    problem = problem.with_row(a, 0.0, np.inf, np.inf, stage)
    problem = problem.with_row(-a, 0.0, np.inf, np.inf, stage)
    solution = problem.solve()
    if solution.status == SOLVED:
        assert_optimal(problem, solution, by_piqp(problem.dense))


@pytest.mark.parametrize(("field", "index"), [
    ("H", (0, 0, 0)), ("H", (0, 0, 1)), ("E", (0, 0)), ("E", (1, 0)), ("f", (0, 0)),
    ("a", (0, 0)), ("a", (1, 1)), ("lower", (0,)), ("lower", (1,)), ("upper", (0,)),
])  # fmt: skip
def test_nan_is_a_failure(field: str, index: tuple[int, ...]) -> None:
    """Also in a row: a limit that is not a number must not vanish silently."""
    numbers = getattr(simple(), field).copy()
    numbers[index] = np.nan
    assert simple(**{field: numbers}).solve().status == NOT_FINITE


@pytest.mark.parametrize(
    ("field", "index"), [("H", (0, 0, 0)), ("E", (0, 0)), ("f", (0, 0)), ("a", (0, 0))]
)
def test_infinite_numbers_are_a_failure(field: str, index: tuple[int, ...]) -> None:
    numbers = getattr(simple(), field).copy()
    numbers[index] = np.inf
    assert simple(**{field: numbers}).solve().status == NOT_FINITE


def test_infinite_limits_are_no_limits() -> None:
    none = simple(lower=np.full(2, -np.inf), upper=np.full(2, np.inf), price=np.full(2, np.inf))
    solution = none.solve()
    assert solution.status == SOLVED
    np.testing.assert_allclose(solution.y, [-1.0, -1.0], rtol=0, atol=VARIABLES)
