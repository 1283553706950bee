"""Numbers for people: millimetres and milliseconds exist on screen and paper only."""

MM_PER_M = 1e3
MS_PER_S = 1e3
MJ_PER_J = 1e3
PERCENT = 1e2

UNKNOWN = "-"


def millimetres(value: float | None, missing: str = UNKNOWN) -> str:
    """A length [m], to the micrometre."""
    return missing if value is None else f"{value * MM_PER_M:.3f} mm"


def milliseconds(value: float | None, missing: str = UNKNOWN) -> str:
    """A duration [s], to the microsecond."""
    return missing if value is None else f"{value * MS_PER_S:.3f} ms"


def factor(value: float | None, missing: str = UNKNOWN) -> str:
    """A ratio, as "12.3 x"."""
    return missing if value is None else f"{value:.3g} x"


def percent(value: float | None, missing: str = UNKNOWN) -> str:
    """A share; none if it is zero."""
    if value is None:
        return missing
    return f"{value * PERCENT:.1f} %" if value else "none"


def newtons(value: float | None, missing: str = UNKNOWN) -> str:
    """A force [N]."""
    return missing if value is None else f"{value:.3f} N"


def millijoules(value: float | None, missing: str = UNKNOWN) -> str:
    """An energy [J], to the microjoule; none if it is zero."""
    if value is None:
        return missing
    return f"{value * MJ_PER_J:.3f} mJ" if value else "none"
