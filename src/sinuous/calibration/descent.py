"""Least squares within bounds by Levenberg and Marquardt's method, on the normal equations.

A fit has a few dozen parameters and thousands of residuals: the normal equations are small, and
the priors among the residuals keep them well conditioned.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, BoolArray

DAMPING, LESS, MORE = 1e-3, 0.2, 5.0
LEAST_DAMPING, MOST_DAMPING = 1e-9, 1e8
# Share by which a step has to lower the cost for another one to follow.
TOLERANCE = 1e-4


@dataclass(frozen=True, kw_only=True, eq=False)
class Least:
    """Where the sum of squares is least.

    Arguments:
        y: unknowns (n,)
        cost: half the sum of squares there
        normal: J'J there (n, n)
    """

    y: Array
    cost: float
    normal: Array


def least_squares(
    residuals: Callable[[Array], Array], jacobian: Callable[[Array, Array], Array],
    start: Array, low: Array, high: Array, *, most: int,
) -> Least:  # fmt: skip
    """Make half the sum of squared residuals least.

    Arguments:
        residuals: (K,) of unknowns (n,)
        jacobian: their derivative (K, n), of unknowns and residuals there
        start: unknowns to start from
        low, high: bounds
        most: derivatives to compute at most
    """
    y = np.clip(start, low, high)
    here = residuals(y)
    cost, damping, done = 0.5 * float(here @ here), DAMPING, False
    for _ in range(most):
        slopes = jacobian(y, here)
        normal, slope = slopes.T @ slopes, slopes.T @ here
        free = ~(((y <= low) & (slope > 0.0)) | ((y >= high) & (slope < 0.0)))
        while not done:
            step = _step(normal, slope, free, damping)
            there = np.clip(y + step, low, high)
            then = residuals(there)
            lower = 0.5 * float(then @ then)
            if lower < cost:
                done = cost - lower < TOLERANCE * cost
                y, here, cost, damping = there, then, lower, max(LESS * damping, LEAST_DAMPING)
                break
            damping *= MORE
            done = damping > MOST_DAMPING
        if done:
            break
    slopes = jacobian(y, here)
    return Least(y=y, cost=cost, normal=slopes.T @ slopes)


def _step(normal: Array, slope: Array, free: BoolArray, damping: float) -> Array:
    A = normal[np.ix_(free, free)]
    out = np.zeros(len(slope))
    out[free] = np.linalg.solve(A + damping * np.diag(np.diagonal(A)), -slope[free])
    return out
