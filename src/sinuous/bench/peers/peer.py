"""What is known about a participant that is not ours."""

from collections.abc import Callable, Mapping
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field
from typing import Any

from sinuous.bench.loop import Controller


@dataclass(frozen=True, kw_only=True, eq=False)
class Peer:
    """A participant for one scene and horizon.

    Arguments:
        name: in tables
        controller: ready to drive, None if it cannot run here
        settings: as its solver gets them
        log: what its solver prints in one solve
        missing: why it cannot run and what to do, empty if it can
        silence: a context in which its compiled code prints nothing
    """

    name: str
    controller: Controller[Any] | None
    settings: Mapping[str, Any] = field(default_factory=dict[str, Any])
    log: str = ""
    missing: str = ""
    silence: Callable[[], AbstractContextManager[None]] = nullcontext
