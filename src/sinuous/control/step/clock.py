"""The processor time of this process, for compiled code that has to end in time."""

from collections.abc import Callable
from typing import cast

from numba.core import types

from sinuous.compiled import kernel

# The C library's clock(), found by name, so that kernels which call it can be cached.
_ticks = cast(Callable[[], int], types.ExternalFunction("clock", types.intp()))

TICKS = 1e6  # per second, as POSIX demands


@kernel
def seconds() -> float:
    """Processor time that this process has used [s]; all its threads count."""
    return _ticks() / TICKS
