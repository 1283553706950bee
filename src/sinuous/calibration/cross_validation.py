"""Whole movements left out of a fit and then predicted."""

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.calibration.fit import Fit, Observer, refit
from sinuous.calibration.problem import Problem

FOLDS = 6
# Bend of a segment, as a share of the largest of any, above which a movement uses it.
USED = 0.25


def folds(patterns: IntArray, apart: BoolArray) -> IntArray:
    """Which fold each row (T,) is left out with; -1 for rows that are always fitted.

    Movements one after another are left out together, because they are alike.

    Arguments:
        patterns: movement of each row (T,)
        apart: rows that are always fitted (T,)
    """
    kept = patterns[~apart]
    numbers, first = np.unique(kept, return_index=True)
    count = min(FOLDS, len(numbers))
    rows = np.array([np.count_nonzero(kept == number) for number in numbers[np.argsort(first)]])
    share = (np.cumsum(rows) - 0.5 * rows) / np.sum(rows)
    fold = np.full(int(np.max(patterns)) + 1, -1)
    fold[numbers[np.argsort(first)]] = np.minimum((share * count).astype(int), count - 1)
    return np.where(apart, -1, fold[patterns])


def cross_validate(problem: Problem, fitted: Fit, *, observe: Observer) -> Array:
    """Errors (T, 3) [m] of rows predicted without their own movements; nan where always fitted.

    Arguments:
        problem: what was fitted to what
        fitted: the fit to everything, from which those to parts start
        observe: told what is done
    """
    fold = folds(problem.patterns, problem.own_zeros)
    out = np.full((len(fold), 3), np.nan)
    for number in np.unique(fold[fold >= 0]):
        left_out = fold == number

        def note(_: str, number: int = int(number)) -> None:
            observe(f"cross-validation {number + 1}")

        part = refit(problem, ~left_out, fitted, observe=note)
        out[left_out] = problem.residuals(part.x)[left_out]
    return out


def from_single_segments(problem: Problem, fitted: Fit, *, observe: Observer) -> Array:
    """Errors (T, 3) [m] of movements of several segments, predicted from those of one.

    This is harder than to leave some movements out: none of its kind was fitted. All nan if
    there are no movements of one segment, or only such.
    """
    several = uses_several(problem) & ~problem.own_zeros
    out = np.full((len(several), 3), np.nan)
    if np.all(several | problem.own_zeros) or not np.any(several):
        return out

    def note(_: str) -> None:
        observe("cross-validation, single segments")

    part = refit(problem, ~several, fitted, observe=note)
    out[several] = problem.residuals(part.x)[several]
    return out


def uses_several(problem: Problem) -> BoolArray:
    """Rows (T,) of movements that bend more than one segment, by the motors."""
    robot = problem.robot
    straight = robot.lengths(np.zeros(len(robot.coordinate_names)))
    bends = np.concatenate(
        [robot.configuration(straight - each.pulls) for each in problem.sequences]
    )
    size = np.linalg.norm(bends.reshape(len(bends), -1, 2), axis=2)
    most = np.array(
        [np.max(size[problem.patterns == k], axis=0) for k in np.unique(problem.patterns)]
    )
    count = np.count_nonzero(most > USED * np.max(size[~problem.own_zeros]), axis=1)
    several = dict(zip(np.unique(problem.patterns).tolist(), (count > 1).tolist(), strict=True))
    return np.array([several[k] for k in problem.patterns.tolist()], dtype=np.bool_)
