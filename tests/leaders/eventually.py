"""Waiting for what another thread is about to do."""

import time
from collections.abc import Callable

PATIENCE = 10.0  # only a failure takes that long [s]
LOOK = 0.002  # between two looks [s]


def eventually(condition: Callable[[], bool]) -> bool:
    """Whether a condition comes true before the patience ends."""
    end = time.monotonic() + PATIENCE
    while time.monotonic() < end:
        if condition():
            return True
        time.sleep(LOOK)
    return condition()
