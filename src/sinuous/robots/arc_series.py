"""The coefficients of an arc as smooth functions of w, the square of its angle.

They belong to the family c_k(w) = sum_j (-w)^j / (2 j + k)!, of which c_1 = sin a / a and
c_2 = (1 - cos a) / a^2 with a^2 = w.  Its members obey

    c_k = 1 / k! - w c_(k+2),    dc_k / dw = (k c_(k+2) - c_(k+1)) / 2,

so that the two with the largest k needed, each by its series, yield all others and all their
derivatives without cancellation at the straight shape, w = 0.
"""

from math import factorial

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner

# Below this w (an arc of 181 degrees) the terms below reach machine precision and none exceeds
# one much, so that nothing cancels; above, the closed forms do not cancel either.
SERIES_BELOW = 10.0
TERMS = 13

C3, C4, C5, C6 = (
    np.array([(-1.0) ** j / factorial(2 * j + k) for j in range(TERMS)]) for k in (3, 4, 5, 6)
)


@inner
def _sum(a: Array, w: float) -> float:
    """The polynomial of coefficients a, every fourth term apart: the parts run in parallel."""
    v = w * w
    u = v * v
    first = a[0] + u * (a[4] + u * (a[8] + u * a[12]))
    second = a[1] + u * (a[5] + u * a[9])
    third = a[2] + u * (a[6] + u * a[10])
    fourth = a[3] + u * (a[7] + u * a[11])
    return (first + w * second) + v * (third + w * fourth)


@inner
def series(w: float) -> tuple[float, float]:
    """c_1 and c_2 for w below `SERIES_BELOW`."""
    return 1.0 - w * _sum(C3, w), 0.5 - w * _sum(C4, w)


@inner
def closed(w: float) -> tuple[float, float]:
    """c_1 and c_2 for w above `SERIES_BELOW`."""
    a = np.sqrt(w)
    half = np.sin(0.5 * a)
    return np.sin(a) / a, 2.0 * half * half / w


@inner
def coefficients(w: float) -> tuple[float, float, float, float]:
    """c_1, c_2, c_3 and c_4."""
    if w < SERIES_BELOW:
        d, e = _sum(C3, w), _sum(C4, w)
        return 1.0 - w * d, 0.5 - w * e, d, e
    s, c = closed(w)
    return s, c, (1.0 - s) / w, (0.5 - c) / w


@inner
def second_coefficients(w: float) -> tuple[float, float, float, float, float, float]:
    """c_1 and c_2, their first and their second derivatives by w, in pairs."""
    if w < SERIES_BELOW:
        g, h = _sum(C5, w), _sum(C6, w)
        d, e = 1.0 / 6.0 - w * g, 1.0 / 24.0 - w * h
        s, c = 1.0 - w * d, 0.5 - w * e
    else:
        s, c, d, e = coefficients(w)
        g, h = (1.0 / 6.0 - d) / w, (1.0 / 24.0 - e) / w
    return (
        s,
        c,
        0.5 * (d - c),
        e - 0.5 * d,
        0.25 * (3.0 * (g - e) + d),
        0.25 * (8.0 * h - 5.0 * g + e),
    )
