"""What takes part in `sinuous bench qp`; imports none of the solvers."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.qp_problems import KeptProblem

OURS = "sinuous"


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What a solver said.

    Arguments:
        solved: whether it says so
        y: (N n,)
        own: time by the solver's own clock, without Python [s]; infinite if it has none
    """

    solved: bool
    y: Array
    own: float = np.inf


Task = Callable[[], Answer]


@dataclass(frozen=True, kw_only=True)
class Solver:
    """A participant.

    Arguments:
        name: of it
        prepare: puts a problem into the solver's form, not timed; the task is
        settings: what differs from its defaults
    """

    name: str
    prepare: Callable[[KeptProblem], Task]
    settings: dict[str, object]
