"""What the operating system can do for a loop, and what it can tell of it."""

import gc
import os
import signal
from contextlib import suppress
from pathlib import Path

HAND_PRIORITY, ROBOT_PRIORITY = 20, 10
"""Of real-time scheduling, where it is allowed."""


def prefer(priority: int) -> None:
    """Ask to be run before others; silently not, where that is not allowed."""
    with suppress(AttributeError, OSError):  # no such call on this system, or no right to it
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(priority))


def keep_still() -> None:
    """No collection of garbage from here on: the loops leave no cycles behind."""
    gc.collect()
    gc.freeze()
    gc.disable()


def leave_ctrl_c_to_the_parent() -> None:
    """It goes to all processes of a terminal, and one of them decides."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def own_memory(pid: int) -> int | None:
    """Memory of a process [bytes] that is its own, and not shared; None where nobody tells."""
    try:
        text = Path(f"/proc/{pid}/status").read_text(encoding="ascii")
    except OSError:
        return None
    for line in text.splitlines():
        name, _, value = line.partition(":")
        if name == "RssAnon":
            return int(value.split()[0]) * 1024
    return None


def load_average() -> float | None:
    """Mean number of processes that want to run, over a minute; None where nobody tells."""
    try:
        return os.getloadavg()[0]
    except (AttributeError, OSError):
        return None
