"""Numbers in the words of a verdict."""

from collections.abc import Iterable, Mapping
from typing import Any

import numpy as np

from sinuous.view.units import MM_PER_M

Row = Mapping[str, Any]


def mm(value: float, digits: int = 2) -> str:
    """A length [m] in millimetres."""
    return f"{value * MM_PER_M:.{digits}f} mm"


def values(rows: Iterable[Row], key: str, **wanted: object) -> np.ndarray:
    """The numbers under a key in the rows that have the wanted values, nan for what is None."""
    chosen = [row[key] for row in rows if all(row[name] == v for name, v in wanted.items())]
    return np.array(chosen, dtype=np.float64)


def mean(rows: Iterable[Row], key: str, **wanted: object) -> float:
    """Their mean, without those that are None."""
    return float(np.nanmean(values(rows, key, **wanted)))


def worst(rows: Iterable[Row], key: str, **wanted: object) -> float:
    """The largest of them."""
    return float(np.nanmax(values(rows, key, **wanted)))


def least(rows: Iterable[Row], key: str, **wanted: object) -> float:
    """The smallest of them."""
    return float(np.nanmin(values(rows, key, **wanted)))
