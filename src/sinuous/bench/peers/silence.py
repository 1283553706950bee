"""Compiled code prints past Python; nobody should see that in the middle of a table."""

import contextlib
import ctypes
import io
import os
from collections.abc import Generator


@contextlib.contextmanager
def quiet() -> Generator[None]:
    """Swallow what compilers and compiled code print to this process's standard streams."""
    libc = ctypes.CDLL(None)
    libc.fflush(None)
    kept = [os.dup(number) for number in (1, 2)]
    nowhere = os.open(os.devnull, os.O_WRONLY)
    try:
        for number in (1, 2):
            os.dup2(nowhere, number)
        with contextlib.redirect_stdout(io.StringIO()):
            yield
    finally:
        libc.fflush(None)
        for number, copy in zip((1, 2), kept, strict=True):
            os.dup2(copy, number)
            os.close(copy)
        os.close(nowhere)
