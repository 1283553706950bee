"""One place that says how inner loops are compiled.

Kernels are cached on disk, so that only the first run on a machine pays for
compiling them, and release the GIL, so that controllers can share a process.

The cache is `__pycache__` beside the source or, where that cannot be written, the user's cache
folder; the environment variable NUMBA_CACHE_DIR names another. When something has to be compiled,
the logger "sinuous" says so once, which Python prints to stderr unless logging is set up otherwise.
"""

import logging
from collections.abc import Callable
from typing import Any, ParamSpec, TypeVar, cast

import numba
from numba.core import event

from sinuous.freshness import stamp

P = ParamSpec("P")
R = TypeVar("R")

COMPILING = "sinuous is compiling its inner loops for this machine, once: about a minute."
HOMELESS = (
    "sinuous compiles its inner loops at every start, because it finds no folder to keep them in. "
    "Set NUMBA_CACHE_DIR to one that can be written."
)

_log = logging.getLogger("sinuous")


class _Herald(event.Listener):
    """Says once that kernels of this package are being compiled rather than loaded."""

    def __init__(self) -> None:
        self.message = COMPILING

    def on_start(self, event: Any) -> None:
        module = str(event.data["dispatcher"].py_func.__module__)
        if self.message and module.startswith("sinuous."):
            _log.warning(self.message)
            self.message = ""

    def on_end(self, event: Any) -> None:
        """What was compiled is of no interest."""


_herald = _Herald()
event.register("numba:compile", _herald)


def kernel(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a function of plain arrays and numbers; its signature is kept for readers."""
    return _compiled(function, {})


def inner(function: Callable[P, R]) -> Callable[P, R]:
    """Compile a part of other kernels that allocates nothing and returns numbers.

    A compiled function counts a reference for every array that it is handed, one by one, also
    those inside tuples, with two atomic operations that cost more than the arithmetic of a small
    kernel.  One that neither allocates nor returns an array needs no counting.  Inlined, it also
    spares its caller the check whether it raised, which would keep the caller counting.
    """
    return _compiled(function, {"forceinline": True, "_nrt": False})


def _compiled(function: Callable[P, R], options: dict[str, Any]) -> Callable[P, R]:
    options = {"nogil": True, "error_model": "numpy"} | options
    try:
        compiled: Any = numba.njit(cache=True, **options)(function)
        _guard(compiled._cache._cache_file, stamp(function.__code__.co_filename))
    except RuntimeError:  # neither beside the source nor in the user's folder can it be kept
        _herald.message = HOMELESS
        compiled = numba.njit(**options)(function)
    return cast(Callable[P, R], compiled)


def _guard(kept: Any, fresh: str) -> None:
    """Take what is kept on disk only if it was made of the sources as they are now.

    Arguments:
        kept: numba's own record of the compiled versions of one kernel
        fresh: see `freshness`
    """
    load = kept._load_index

    def load_index() -> Any:
        try:
            return load()
        except (ImportError, AttributeError):  # of modules and types that are no more
            return {}

    kept._source_stamp, kept._load_index = fresh, load_index
