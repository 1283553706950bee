"""The least-squares method finds known minima, within bounds as scipy does."""

import numpy as np
import pytest
from scipy.optimize import lsq_linear

from sinuous.arrays import Array
from sinuous.calibration.descent import least_squares


def rosenbrock(y: Array) -> Array:
    return np.array([10.0 * (y[1] - y[0] ** 2), 1.0 - y[0]])


def slopes(y: Array, here: Array) -> Array:
    return np.array([[-20.0 * y[0], 10.0], [-1.0, 0.0]])


def test_a_curved_valley_is_followed_to_its_end() -> None:
    wide = np.full(2, 10.0)
    found = least_squares(rosenbrock, slopes, np.array([-1.2, 1.0]), -wide, wide, most=100)
    np.testing.assert_allclose(found.y, [1.0, 1.0], atol=1e-4)
    np.testing.assert_allclose(found.normal, slopes(found.y, found.y).T @ slopes(found.y, found.y))


@pytest.mark.parametrize("seed", range(5))
def test_bounds_hold_as_scipy_holds_them(seed: int) -> None:
    rng = np.random.default_rng(seed)
    A, b = rng.normal(size=(30, 6)), rng.normal(size=30)
    low, high = np.full(6, -0.1), np.full(6, 0.1)
    found = least_squares(lambda y: A @ y - b, lambda y, r: A, np.zeros(6), low, high, most=200)
    expected = lsq_linear(A, b, (low, high), tol=1e-12)
    assert np.all((found.y >= low) & (found.y <= high))
    assert found.cost == pytest.approx(expected.cost, rel=1e-3)


def test_it_stops_after_so_many_derivatives() -> None:
    count = list[int]()

    def counted(y: Array, here: Array) -> Array:
        count.append(1)
        return slopes(y, here)

    wide = np.full(2, 10.0)
    least_squares(rosenbrock, counted, np.array([-1.2, 1.0]), -wide, wide, most=3)
    assert len(count) == 4  # and the one at the end
