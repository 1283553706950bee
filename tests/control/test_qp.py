"""The QP of a step: against another solver, KKT, sensitivities, and when it must fail."""

from dataclasses import replace

import numpy as np
import piqp
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import linprog

from sinuous.arrays import Array
from sinuous.control import qp
from sinuous.control.shape import Cuts
from sinuous.control.terms import Rows

COST = 1e-6  # relative to 1 + |cost|: tolerances of both solvers, 1e-6 and 1e-9
VARIABLES = 1e-5  # of variables of order one, by the same and a condition of up to 10
FEASIBLE = 1e-6  # DAQP's primal tolerance, of rows of order one
STATIONARY = 1e-6  # gradient of the Lagrangian, relative to its largest part
SENSITIVITY = 1e-3  # relative error of differences of the optimal cost, quadratic in the step
SCALE = 0.002  # [m] actuator step of the random problems

seeds = st.integers(0, 2**32 - 1)


def random_rows(rng: np.random.Generator, n: int, count: int) -> Rows:
    """Rows around zero, so that standing still is allowed; some without a lower side."""
    width = SCALE * rng.uniform(0.2, 2.0, (2, count))
    lower = np.where(rng.uniform(size=count) < 0.2, -np.inf, -width[0])
    return Rows(jacobian=rng.normal(size=(count, n)), lower=lower, upper=width[1],
                names=("",) * count)  # fmt: skip


def random_cuts(rng: np.random.Generator, n: int, count: int, slack: float) -> Cuts:
    none = np.full(count, -1, dtype=np.int64)
    return Cuts(jacobian=rng.normal(size=(count, n)), slack=SCALE * rng.normal(slack, 1.0, count),
                source=none, triangle=none, normal=np.zeros((count, 3)))  # fmt: skip


def random_problem(seed: int, *, cuts: int = 6, slack: float = 0.3) -> tuple[qp.Problem, qp.Scale]:
    """A problem of 1 to 4 stages as the controller builds it, with soft cuts in each stage."""
    rng = np.random.default_rng(seed)
    N, n = int(rng.integers(1, 5)), int(rng.integers(2, 8))
    root = rng.normal(size=(n, n)) / np.sqrt(n)
    scale = qp.Scale(step=SCALE, inverse=np.eye(n) + 0.2 * rng.normal(size=(n, n)))
    weight = rng.uniform(10.0, 1e4)
    hessians = [weight * h.T @ h for h in rng.normal(size=(N, n, n)) / np.sqrt(n)]
    problem = qp.build(
        scale=scale,
        hessians=hessians,
        gradients=list(weight * SCALE * 3.0 * rng.normal(size=(N, n))),
        effort=weight * (0.3 * np.eye(n) + root.T @ root),
        increments=0.1 * SCALE * rng.normal(size=(N, n)),
        rows=[(random_rows(rng, n, n + 2), [random_rows(rng, n, n)]) for _ in range(N)],
    )
    if cuts:
        placed = [(i, random_cuts(rng, n, cuts, slack)) for i in range(N)]
        problem = problem.with_cuts(scale, placed)
    return problem, scale


def by_piqp(problem: qp.Problem) -> tuple[Array, Array]:
    """y and the slacks of the soft rows, which cost penalty s + s^2 / (2 SOFTNESS) each."""
    n, soft = len(problem.f), len(problem.lower) - problem.hard
    P, c = np.zeros((n + soft, n + soft)), np.full(n + soft, problem.penalty)
    P[:n, :n], c[:n] = problem.H, problem.f
    P[range(n, n + soft), range(n, n + soft)] = 1.0 / qp.SOFTNESS
    G = np.zeros((len(problem.lower), n + soft))
    G[:, :n] = problem.A
    G[problem.hard :, n:] = np.eye(soft)
    solver = piqp.DenseSolver()
    solver.settings.eps_abs = solver.settings.eps_rel = 1e-10
    solver.settings.eps_duality_gap_abs = solver.settings.eps_duality_gap_rel = 1e-10
    low = np.concatenate([np.full(n, -np.inf), np.zeros(soft)])
    solver.setup(
        np.asfortranarray(P), c, None, None, np.asfortranarray(G), problem.lower, problem.upper, low
    )
    assert solver.solve() == piqp.PIQP_SOLVED
    return solver.result.x[:n], solver.result.x[n:]


def violation(problem: qp.Problem, y: Array) -> Array:
    """By how much each soft row is violated."""
    return np.maximum(problem.lower - problem.A @ y, 0.0)[problem.hard :]


def price(problem: qp.Problem, y: Array) -> float:
    """What the violations cost, in the units of the rows."""
    s = violation(problem, y)
    return float(problem.penalty * np.sum(s) + np.sum(s**2) / (2 * qp.SOFTNESS))


def cost(problem: qp.Problem, y: Array) -> float:
    return float(0.5 * y @ problem.H @ y + problem.f @ y) + price(problem, y)


def assert_hard_rows_hold(problem: qp.Problem, y: Array) -> None:
    value = (problem.A @ y)[: problem.hard]
    assert np.all(value >= problem.lower[: problem.hard] - FEASIBLE)
    assert np.all(value <= problem.upper[: problem.hard] + FEASIBLE)


@given(seed=seeds)
@settings(max_examples=80)
def test_agrees_with_another_solver(seed: int) -> None:
    problem, _ = random_problem(seed)
    solution, (y, _) = qp.solve(problem), by_piqp(problem)
    assert solution.failure == ""
    assert_hard_rows_hold(problem, solution.y)
    least = cost(problem, y)
    assert abs(cost(problem, solution.y) - least) < COST * (1 + abs(least))
    gap = np.max(np.abs(solution.y - y))
    assert gap < VARIABLES * (1 + np.max(np.abs(y))) / min(1.0, least_curvature(problem))


def least_curvature(problem: qp.Problem) -> float:
    return float(np.linalg.eigvalsh(problem.H)[0])


@given(seed=seeds)
@settings(max_examples=80)
def test_satisfies_kkt(seed: int) -> None:
    problem, _ = random_problem(seed)
    solution = qp.solve(problem)
    y, multipliers = solution.y, solution.multipliers
    parts = [problem.H @ y, problem.f, problem.A.T @ multipliers]
    largest = max(float(np.max(np.abs(part))) for part in parts)
    assert np.max(np.abs(sum(parts))) < STATIONARY * largest
    value = problem.A @ y
    # Upper limits push down, lower ones up, and only those that are reached.
    pushes_down = multipliers > STATIONARY * largest
    pushes_up = multipliers < -STATIONARY * largest
    assert np.all(value[pushes_down] >= problem.upper[pushes_down] - FEASIBLE)
    assert np.all(value[pushes_up] <= problem.lower[pushes_up] + FEASIBLE)
    # A soft row pushes as strongly as its violation costs more with more of it.
    soft, slacks = np.abs(multipliers[problem.hard :]), violation(problem, y)
    marginal = problem.penalty + slacks / qp.SOFTNESS
    assert np.all(soft <= marginal * (1 + STATIONARY))
    beyond = slacks > 10 * FEASIBLE
    np.testing.assert_allclose(soft[beyond], marginal[beyond], rtol=1e-3)


@given(seed=seeds)
@settings(max_examples=60)
def test_penalty_is_exact(seed: int) -> None:
    """Soft rows that can hold do hold: the penalty exceeds every multiplier."""
    problem, _ = random_problem(seed, slack=3.0)
    solution = qp.solve(problem)
    hard = replace(problem, hard=len(problem.lower))
    strict = qp.solve(hard)
    if strict.failure:
        return  # they cannot all hold
    assert np.max(np.abs(strict.multipliers[problem.hard :])) < problem.penalty
    assert np.max(violation(problem, solution.y)) < 10 * FEASIBLE
    assert np.max(np.abs(solution.y - strict.y)) < 1e-4 * (1 + np.max(np.abs(strict.y)))


@given(seed=seeds)
@settings(max_examples=60)
def test_conflicting_soft_rows_are_violated_as_little_as_possible(seed: int) -> None:
    """Against a linear program whose only cost is the sum of the violations."""
    problem, _ = random_problem(seed, cuts=12, slack=-0.1)
    solution = qp.solve(problem)
    assert solution.failure == ""
    assert_hard_rows_hold(problem, solution.y)
    n, soft, hard = len(problem.f), len(problem.lower) - problem.hard, problem.hard
    above, below = np.isfinite(problem.upper[:hard]), np.isfinite(problem.lower[:hard])
    empty = np.zeros((hard, soft))
    least = linprog(
        np.concatenate([np.zeros(n), np.ones(soft)]),
        A_ub=np.concatenate([
            np.hstack([problem.A[:hard], empty])[above],
            -np.hstack([problem.A[:hard], empty])[below],
            np.hstack([-problem.A[hard:], -np.eye(soft)]),
        ]),
        b_ub=np.concatenate([
            problem.upper[:hard][above], -problem.lower[:hard][below], -problem.lower[hard:]
        ]),
        bounds=[(None, None)] * n + [(0.0, None)] * soft,
    )  # fmt: skip
    # The sum may exceed the least one by what the other parts of the cost gain, per penalty.
    total, y = float(np.sum(violation(problem, solution.y))), least.x[:n]
    gained = cost(problem, y) - problem.penalty * least.fun
    gained -= cost(problem, solution.y) - problem.penalty * total
    assert total < least.fun + gained / problem.penalty + FEASIBLE * soft


@pytest.mark.parametrize("stretch", [1.0, 100.0])
def test_two_soft_rows_outvote_a_third(stretch: float) -> None:
    """As an L1 penalty does; a quadratic one would settle between them, at a third.

    It counts violations of the rows as they are, however flat the cost is along them.
    """
    problem = simple(
        H=np.diag([1.0, 1.0]) / stretch**2, f=np.zeros(2), hard=0, penalty=10.0,
        A=np.array([[-1.0, 0.0], [-1.0, 0.0], [1.0, 0.0]]), value=np.ones(3),
        lower=np.array([0.0, 0.0, 0.03]), upper=np.full(3, np.inf),
    )  # fmt: skip
    solution = qp.solve(problem)
    np.testing.assert_allclose(solution.y, [0.0, 0.0], rtol=0, atol=FEASIBLE)


@pytest.mark.parametrize("stretch", [0.01, 1.0, 100.0])
def test_a_soft_row_gives_way_at_its_penalty(stretch: float) -> None:
    """Whatever the curvature along the row: it holds while its multiplier is below."""
    problem = simple(
        H=np.diag([1.0, 1.0]) / stretch**2, hard=0, penalty=10.0, A=np.array([[1.0, 0.0]]),
        value=np.ones(1), lower=np.zeros(1), upper=np.full(1, np.inf),
    )  # fmt: skip
    kept = qp.solve(replace(problem, f=np.array([9.9, 0.0])))
    given_up = qp.solve(replace(problem, f=np.array([10.1, 0.0])))
    assert abs(kept.y[0]) < FEASIBLE
    # Beyond, the push 0.1 is balanced by the quadratic parts of cost and penalty.
    slack = 0.1 / (1 / stretch**2 + 1 / qp.SOFTNESS)
    assert given_up.y[0] == pytest.approx(-slack, rel=1e-3)


@given(seed=seeds)
@settings(max_examples=40)
def test_multipliers_are_the_worth_of_room(seed: int) -> None:
    """In cost per metre: what the optimal cost loses when a wall steps back by a micrometre."""
    problem, scale = random_problem(seed, cuts=0)
    rng = np.random.default_rng(seed)
    n = len(scale.inverse)
    cuts = random_cuts(rng, n, 1, 0.0)
    # A cut that costs something: it forbids half of the way that would be taken without it.
    free = scale.delta(qp.solve(problem).y)[0]
    cuts.slack[0] = -0.5 * float(cuts.jacobian[0] @ free)
    if cuts.slack[0] < 0.0:
        cuts = replace(cuts, jacobian=-cuts.jacobian, slack=-cuts.slack)
    optimum = [
        qp.solve(problem.with_cuts(scale, [(0, replace(cuts, slack=cuts.slack + room))]))
        for room in (-1e-6, 0.0, 1e-6)
    ]
    if any(solution.failure for solution in optimum):
        return
    values = [problem.size * (0.5 * s.y @ problem.H @ s.y + problem.f @ s.y) for s in optimum]
    worth = problem.with_cuts(scale, [(0, cuts)]).multipliers(optimum[1])[-1]
    left, right = (values[0] - values[1]) / 1e-6, (values[1] - values[2]) / 1e-6
    # At a change of the active set the slopes differ; the multiplier lies between them.
    room = SENSITIVITY * (abs(left) + abs(right)) + 1e-6
    assert min(left, right) - room <= worth <= max(left, right) + room


def test_cuts_apply_to_their_stage_only() -> None:
    problem, scale = random_problem(11, cuts=0)
    n = len(scale.inverse)
    stages = len(problem.f) // n
    cuts = random_cuts(np.random.default_rng(2), n, 3, 0.0)
    last = problem.with_cuts(scale, [(stages - 1, cuts)])
    added = last.A[problem.hard :]
    assert np.all(added[:, : (stages - 1) * n] == 0.0)
    y = np.random.default_rng(3).normal(size=len(problem.f))
    exact = cuts.slack + cuts.jacobian @ scale.delta(y)[-1] >= 0.0
    np.testing.assert_array_equal(added @ y >= last.lower[problem.hard :], exact)
    assert last.hard == problem.hard


@given(seed=seeds)
@settings(max_examples=30)
def test_build_adds_up_the_costs_it_was_given(seed: int) -> None:
    """The problem's cost is that of the stages and of all increments, from its own parts."""
    rng = np.random.default_rng(seed)
    N, n = int(rng.integers(1, 4)), int(rng.integers(2, 5))
    scale = qp.Scale(step=SCALE, inverse=np.eye(n) + 0.2 * rng.normal(size=(n, n)))
    roots, gradients = rng.normal(size=(N + 1, n, n)), rng.normal(size=(N, n))
    effort, increments = roots[-1].T @ roots[-1], rng.normal(size=(N, n))
    hessians = [root.T @ root for root in roots[:-1]]
    problem = qp.build(scale=scale, hessians=hessians, gradients=list(gradients), effort=effort,
                       increments=increments,
                       rows=[(random_rows(rng, n, 2), []) for _ in range(N)])  # fmt: skip

    def total(delta: Array) -> float:
        moves = increments + np.diff(delta, axis=0, prepend=np.zeros((1, n)))
        states = sum(g @ d + 0.5 * d @ H @ d
                     for H, g, d in zip(hessians, gradients, delta, strict=True))  # fmt: skip
        return float(states + 0.5 * np.einsum("ki,ij,kj->", moves, effort, moves))

    y = rng.normal(size=N * n)
    modelled = problem.size * (0.5 * y @ problem.H @ y + problem.f @ y)
    exact = total(scale.delta(y)) - total(np.zeros((N, n)))
    assert modelled == pytest.approx(exact, rel=1e-6, abs=1e-9)


# --- convexity -----------------------------------------------------------------------------


@given(seed=seeds)
@settings(max_examples=40)
def test_convex_leaves_positive_matrices_alone(seed: int) -> None:
    root = np.random.default_rng(seed).normal(size=(6, 6)) + 3.0 * np.eye(6)
    H = root.T @ root
    if np.linalg.eigvalsh(H)[0] < 2 * qp.CONVEX * np.linalg.eigvalsh(H)[-1]:
        return
    np.testing.assert_allclose(qp.convex(H), H, rtol=0, atol=1e-13 * np.max(np.abs(H)))


@given(seed=seeds)
@settings(max_examples=40)
def test_convex_removes_negative_curvature_and_no_other(seed: int) -> None:
    rng = np.random.default_rng(seed)
    vectors = np.linalg.qr(rng.normal(size=(6, 6)))[0]
    values = rng.uniform(-5.0, 5.0, 6)
    H = qp.convex((vectors * values) @ vectors.T)
    kept = vectors.T @ H @ vectors
    expected = np.maximum(values, qp.CONVEX * np.max(np.abs(values)))
    np.testing.assert_allclose(kept, np.diag(expected), rtol=0, atol=1e-12)


def test_convex_of_nothing_is_nothing() -> None:
    assert np.all(qp.convex(np.zeros((3, 3))) == 0.0)


# --- failures ------------------------------------------------------------------------------


def simple(**fields: object) -> qp.Problem:
    """Two variables, one hard and one soft row."""
    problem = qp.Problem(
        H=np.eye(2), f=np.ones(2), A=np.eye(2), lower=np.full(2, -3.0), upper=np.full(2, 3.0),
        value=np.ones(2), size=1.0, hard=1, penalty=1e3,
    )  # fmt: skip
    return replace(problem, **fields)


def test_the_simple_problem_itself_can_be_solved() -> None:
    solution = qp.solve(simple())
    assert solution.failure == ""
    np.testing.assert_allclose(solution.y, [-1.0, -1.0], rtol=0, atol=FEASIBLE)


@pytest.mark.parametrize("fields", [
    {"lower": np.array([1.0, -3.0]), "upper": np.array([-1.0, 3.0])},
    {"A": np.array([[1.0, 0.0], [1.0, 0.0]]), "lower": np.array([1.0, -3.0]),
     "upper": np.array([3.0, -1.0]), "hard": 2},
    {"H": np.diag([-1.0, 1.0])},
])  # fmt: skip
def test_no_solution_is_a_failure_in_words(fields: dict[str, object]) -> None:
    assert qp.solve(simple(**fields)).failure.startswith("the QP")


def spoilt(field: str, index: tuple[int, ...], value: float) -> qp.Problem:
    numbers = getattr(simple(), field).copy()
    numbers[index] = value
    return simple(**{field: numbers})


@pytest.mark.parametrize(("field", "index"), [
    ("H", (0, 0)), ("f", (0,)), ("A", (0, 0)), ("A", (1, 1)), ("lower", (0,)), ("lower", (1,)),
    ("upper", (0,)), ("upper", (1,)),
])  # fmt: skip
def test_nan_is_a_failure_in_words(field: str, index: tuple[int, ...]) -> None:
    """Also in a row: a limit that is not a number must not vanish silently."""
    assert qp.solve(spoilt(field, index, np.nan)).failure != ""


@pytest.mark.parametrize(("field", "index"), [("H", (0, 0)), ("f", (0,)), ("A", (0, 0))])
def test_infinite_numbers_are_a_failure_in_words(field: str, index: tuple[int, ...]) -> None:
    assert qp.solve(spoilt(field, index, np.inf)).failure != ""


def test_infinite_limits_are_no_limits() -> None:
    solution = qp.solve(simple(lower=np.full(2, -np.inf), upper=np.full(2, np.inf)))
    assert solution.failure == ""
    np.testing.assert_allclose(solution.y, [-1.0, -1.0], rtol=0, atol=FEASIBLE)
