"""Eigenvalues of small symmetric matrices, against LAPACK."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.control.step.eigen import decompose

ROUNDING = 1e-13  # relative to the largest entry


@kernel
def run(V: Array, d: Array, e: Array) -> bool:
    return decompose(V, d, e)


def decomposed(A: Array) -> tuple[bool, Array, Array]:
    V, d, e = A.copy(), np.empty(len(A)), np.empty(len(A))
    return run(V, d, e), d, V


def random_matrix(seed: int, n: int, kind: str) -> Array:
    rng = np.random.default_rng(seed)
    A = rng.normal(size=(n, n))
    match kind:
        case "graded":
            A = A * 10.0 ** rng.uniform(-8, 8, n)
            return A @ A.T
        case "low rank":
            v = rng.normal(size=(n, max(1, n // 3)))
            return v @ v.T
        case "diagonal":
            return np.diag(np.diag(A))
        case "repeated":
            Q = np.linalg.qr(A)[0]
            return (Q * rng.integers(-1, 2, n)) @ Q.T
        case _:
            return A + A.T


@pytest.mark.parametrize("kind", ["full", "graded", "low rank", "diagonal", "repeated"])
@given(seed=st.integers(0, 2**32 - 1), n=st.integers(1, 20))
@settings(max_examples=40, deadline=None)
def test_agrees_with_lapack(kind: str, seed: int, n: int) -> None:
    A = random_matrix(seed, n, kind)
    A = 0.5 * (A + A.T)
    done, d, V = decomposed(A)
    scale = ROUNDING * n * max(float(np.max(np.abs(A))), 1e-300)
    assert done
    np.testing.assert_allclose(np.sort(d), np.linalg.eigvalsh(A), rtol=0, atol=scale)
    np.testing.assert_allclose(V.T @ V, np.eye(n), rtol=0, atol=ROUNDING * n)
    np.testing.assert_allclose((V * d) @ V.T, A, rtol=0, atol=scale)


@pytest.mark.parametrize("value", [np.nan, np.inf])
def test_what_is_not_finite_does_not_go_on_for_ever(value: float) -> None:
    A = np.eye(5)
    A[1, 2] = A[2, 1] = value
    done, d, _ = decomposed(A)
    assert not (done and np.all(np.isfinite(d)))


def test_zero_has_no_curvature() -> None:
    done, d, V = decomposed(np.zeros((4, 4)))
    assert done
    assert np.all(d == 0.0)
    np.testing.assert_array_equal(np.abs(V), np.eye(4))
