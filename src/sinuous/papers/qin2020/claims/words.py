"""Numbers in the words of a verdict."""

from collections.abc import Iterable, Mapping
from typing import Any

from sinuous.view.units import MM_PER_M, PERCENT

Row = Mapping[str, Any]


def mm(value: float, digits: int = 1) -> str:
    """A length [m] in millimetres."""
    return f"{value * MM_PER_M:.{digits}f} mm"


def tiny(value: float) -> str:
    """A length [m] that is next to nothing, in metres."""
    return f"{value:.0e} m"


def percent(share: float, digits: int = 1) -> str:
    """A share in percent."""
    return f"{share * PERCENT:.{digits}f} %"


def micro(seconds: float) -> str:
    """A time [s] in microseconds."""
    return f"{seconds * 1e6:.2g} us"


def the(rows: Iterable[Row], **wanted: object) -> Row:
    """The only row with the wanted values."""
    (row,) = (row for row in rows if all(row[name] == value for name, value in wanted.items()))
    return row
