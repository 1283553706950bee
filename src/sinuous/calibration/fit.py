"""Robust least squares with priors, and how sure its result is."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.calibration.descent import least_squares
from sinuous.calibration.problem import Problem

# Errors beyond this many times the usual count by their size, not by their square.
HUBER = 3.0
# Steps of a difference, in standard deviations of the priors.
STEP = 1e-4
MOST_ITERATIONS = 30
SCREENING = 4
# What one expects of errors before they are known: size [m], and rows over which they last.
FIRST_NOISE, FIRST_MEMORY = 3e-3, 10.0
LEAST_NOISE = 1e-5
# Median length of a vector whose three components are normal with deviation one.
MAXWELL_MEDIAN = 1.538
# Stiffnesses to start from, as natural logarithms of factors of the expected one.
STARTS = (0.0, -1.5, 1.5)

Observer = Callable[[str], None]


def silent(note: str) -> None:
    """Show nothing."""


@dataclass(frozen=True, kw_only=True, eq=False)
class Noise:
    """What errors are like.

    Arguments:
        size: root mean square per axis [m]
        memory: over how many rows an error lasts: so many rows tell as much as one
    """

    size: float = FIRST_NOISE
    memory: float = FIRST_MEMORY


@dataclass(frozen=True, kw_only=True, eq=False)
class Fit:
    """A fit.

    Arguments:
        x: parameters (n,)
        covariance: of them (n, n), from the Jacobian, the priors and the errors' memory
        noise: what its errors were like
        cost: what was made least
    """

    x: Array
    covariance: Array
    noise: Noise
    cost: float

    @property
    def std(self) -> Array:
        """Standard deviations of the parameters (n,)."""
        return np.sqrt(np.diagonal(self.covariance))


def fit(
    problem: Problem,
    used: BoolArray,
    *,
    observe: Observer = silent,
) -> Fit:
    """Fit a problem's parameters, first with errors as one expects them, then as they were.

    Arguments:
        problem: what is fitted to what
        used: rows (T,) that count
        observe: told what is done
    """
    noise = Noise()
    best = _several(problem, used, noise, observe)
    first = _minimise(problem, used, noise, best, MOST_ITERATIONS, observe)
    noise = measure(problem.residuals(first.x)[used], problem.patterns[used])
    return _minimise(problem, used, noise, first.x, MOST_ITERATIONS, observe)


def refit(problem: Problem, used: BoolArray, before: Fit, *, observe: Observer = silent) -> Fit:
    """Fit again to other rows, from the parameters and with the noise of a fit before."""
    return _minimise(problem, used, before.noise, before.x, MOST_ITERATIONS, observe)


def _several(problem: Problem, used: BoolArray, noise: Noise, observe: Observer) -> Array:
    stiffness, best = problem.parameters.place("log_stiffness"), None
    for factor in STARTS:
        x = problem.start.copy()
        x[stiffness] += factor
        found = _minimise(problem, used, noise, x, SCREENING, observe)
        if best is None or found.cost < best.cost:
            best = found
    return problem.start if best is None else best.x


def measure(errors: Array, patterns: IntArray) -> Noise:
    """Size and memory of errors (T, 3) [m], the memory within patterns (T,).

    The memory is the integrated autocorrelation, summed as far as it is positive.
    """
    size = float(np.median(np.linalg.norm(errors, axis=1))) / MAXWELL_MEDIAN
    power, memory = float(np.mean(errors**2)), 1.0
    for lag in range(1, 60):
        same = patterns[lag:] == patterns[:-lag]
        if np.count_nonzero(same) < 30 or power <= 0.0:
            break
        share = float(np.mean(np.sum(errors[lag:] * errors[:-lag], axis=1)[same])) / (3.0 * power)
        if share < 0.05:
            break
        memory += 2.0 * share
    return Noise(size=max(size, LEAST_NOISE), memory=memory)


def _minimise(
    problem: Problem, used: BoolArray, noise: Noise, start: Array, most: int, observe: Observer
) -> Fit:
    p = problem.parameters
    middle, spread, (low, high) = p.start, p.spread, p.bounds
    rows = np.flatnonzero(used)

    def residuals(y: Array) -> Array:
        errors = problem.residuals(middle + y * spread)[rows] / noise.size
        return np.concatenate([_robust(errors).ravel() / np.sqrt(noise.memory), y])

    def jacobian(y: Array, here: Array) -> Array:
        observe("fitting")
        out = np.empty((len(here), len(y)))
        for k in range(len(y)):
            moved = y.copy()
            moved[k] += STEP
            out[:, k] = (residuals(moved) - here) / STEP
        return out

    low, high = (low - middle) / spread, (high - middle) / spread
    found = least_squares(residuals, jacobian, (start - middle) / spread, low, high, most=most)
    return Fit(
        x=middle + found.y * spread,
        covariance=np.linalg.inv(found.normal) * np.outer(spread, spread),
        noise=noise,
        cost=found.cost,
    )


def _robust(errors: Array) -> Array:
    """Errors (T, 3) so scaled that their squares make the pseudo-Huber loss."""
    size = np.linalg.norm(errors, axis=1)
    loss = 2.0 * HUBER**2 * (np.sqrt(1.0 + (size / HUBER) ** 2) - 1.0)
    return errors * (np.sqrt(loss) / np.maximum(size, 1e-12))[:, None]
