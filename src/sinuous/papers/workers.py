"""Spreads the runs of an experiment over the cores; what they find does not depend on how many."""

import signal
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import Executor, ProcessPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from typing import TypeVar

T = TypeVar("T")
R = TypeVar("R")

Observe = Callable[[str, int, int], None]
"""Called with what is done next, how many parts of it are done and how many there are."""


def ignore(*_: object) -> None:
    """Observe nothing."""


@dataclass(frozen=True, kw_only=True)
class Workers:
    """Runs functions of this package on many items.

    Arguments:
        executor: of processes; None to run in this one
        observe: hears of every item that is done
    """

    executor: Executor | None = None
    observe: Observe = ignore

    def map(self, what: str, function: Callable[[T], R], items: Sequence[T]) -> list[R]:
        """The function of every item, in their order.

        Arguments:
            what: is done, for the progress bar
            function: of a module, so that another process finds it
            items: what can be pickled
        """
        results, count = list[R](), len(items)
        self.observe(what, 0, count)
        found = (
            map(function, items) if self.executor is None else self.executor.map(function, items)
        )
        for result in found:
            results.append(result)
            self.observe(what, len(results), count)
        return results


def _leave_interrupts_to_the_parent() -> None:
    """Ctrl-C reaches every process of a terminal; one that ends in words is enough."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@contextmanager
def workers(count: int, observe: Observe = ignore) -> Generator[Workers]:
    """Workers in that many processes, in this one if it is one."""
    if count == 1:
        yield Workers(observe=observe)
        return
    # Spawned, because a fork copies locks that other threads hold.
    context = get_context("spawn")
    with ProcessPoolExecutor(count, context, _leave_interrupts_to_the_parent) as executor:
        yield Workers(executor=executor, observe=observe)
