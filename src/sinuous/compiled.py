"""One place that says how inner loops are compiled.

Kernels are cached on disk, so that only the first run on a machine pays for
compiling them, and release the GIL, so that controllers can share a process.
"""

from collections.abc import Callable
from typing import ParamSpec, TypeVar, cast

import numba

P = ParamSpec("P")
R = TypeVar("R")


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function of plain arrays and numbers; its signature is kept for readers."""
    return cast(Callable[P, R], numba.njit(cache=True, nogil=True, error_model="numpy")(function))
