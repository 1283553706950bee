"""What the parts of this room say about numbers that make no sense."""

from math import isfinite

import numpy as np

from sinuous.arrays import Array, ArrayLike


def positive(name: str, value: float) -> None:
    """Raise a ValueError unless a number is positive and finite."""
    if not (isfinite(value) and value > 0.0):
        raise ValueError(f"{name} must be positive and finite, not {value}")


def zero_or_more(name: str, value: float) -> None:
    """Raise a ValueError unless a number is zero or more, and finite."""
    if not (isfinite(value) and value >= 0.0):
        raise ValueError(f"{name} must be zero or more and finite, not {value}")


def vector(name: str, value: ArrayLike) -> Array:
    """A copy of a finite vector; raises a ValueError for anything else."""
    copy = np.array(value, dtype=np.float64)
    if copy.ndim != 1 or not copy.size or not np.all(np.isfinite(copy)):
        raise ValueError(f"{name} must be a vector of finite numbers, not {value}")
    return copy


def probability(name: str, value: float) -> None:
    """Raise a ValueError unless a number is within [0, 1]."""
    if not 0.0 <= value <= 1.0:
        raise ValueError(f"{name} must be within 0 and 1, not {value}")


def not_negative(name: str, value: float) -> None:
    """Raise a ValueError unless a number is zero or more; it may be infinite."""
    if not value >= 0.0:
        raise ValueError(f"{name} must be zero or more, not {value}")
