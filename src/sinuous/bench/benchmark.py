"""What `sinuous bench` needs to know of each of its benchmarks."""

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

from sinuous.bench.result import Result

Observe = Callable[[str, int, int], None]
"""Called with what is measured next, how many parts are done and how many there are."""


def ignore(*_: object) -> None:
    """Observe nothing."""


@dataclass(frozen=True, kw_only=True)
class Benchmark:
    """One WHAT.

    Arguments:
        run: measures; the first argument asks for a short version that only shows that all
            of it works
        draw: writes the figures of a result to a folder that exists and returns their paths
    """

    run: Callable[[bool, Observe], Result]
    draw: Callable[[Result, Path], list[Path]]
