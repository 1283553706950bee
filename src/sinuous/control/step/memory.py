"""The records of a controller, allocated once: nothing is allocated in the loop."""

import threading

import numpy as np

from sinuous.compiled import kernel
from sinuous.control.step.data import (
    SOFT,
    Meaning,
    Model,
    Motion,
    Problem,
    Scratch,
    Shape,
    Way,
    Work,
)
from sinuous.control.step.rows import Rows, new_iterate, new_pairs
from sinuous.control.step.safety import PIECES
from sinuous.geometry.bvh import STACK
from sinuous.robots import chain_second


class Memory(threading.local):
    """Scratch of one controller, for each thread its own."""

    def __init__(self, model: Model, horizon: int) -> None:
        self.work = new_work(model, horizon)


@kernel
def _shape(B: int, S: int, n: int) -> Shape:
    return Shape(
        np.zeros((B, n)),
        np.zeros((B, S, 3)),
        np.zeros((B, S)),
        np.zeros((B, S), np.bool_),
        np.zeros((B, S, 3)),
        np.zeros((B, S), np.int64),
    )


@kernel
def new_work(model: Model, horizon: int) -> Work:
    """All scratch of steps with this horizon."""
    N, S = horizon, model.body.required.size
    n, M = model.scale.metric.shape[0], model.body.chain.theta_column.size
    m = N * (model.limits.low.size + model.limits.slowest.size + 3 + SOFT)
    motion = Motion(
        np.zeros((N, M + 1, 3, 3)),
        np.zeros((N, M + 1, 3)),
        np.zeros((N, M, 3, 3)),
        np.zeros((N, M, 3, 2)),
        np.zeros((N, 3, n)),
        np.zeros((N, n, n)),
    )
    meaning = Meaning(
        np.zeros(m, np.int64),
        np.zeros(m, np.int64),
        np.zeros(m, np.int64),
        np.zeros((m, 3)),
        np.zeros(m),
        np.zeros(m),
    )
    problem = Problem(
        np.zeros((N, n, n)),
        np.zeros((N, n)),
        np.zeros((n, n)),
        Rows(np.zeros((m, n)), np.zeros((m, 4), np.int64), np.zeros((m, 3))),
        meaning,
        np.zeros(m),
    )
    scratch = Scratch(
        np.zeros(STACK, np.int64),
        np.zeros(STACK),
        np.zeros((M + 1, 3, 3)),
        np.zeros((M + 1, 3)),
        np.zeros((3, n)),
        np.zeros(n),
        np.zeros((n, n)),
        np.zeros((n, n)),
        np.zeros(max(S, m) + 1, np.int64),
        np.zeros(S),
        np.zeros((S + 1, 3)),
        np.zeros(chain_second.scratch_size(M, n)),
        np.zeros((5, 3)),
    )
    B = PIECES + 1
    way = Way(
        np.zeros(n), np.zeros((B, S, 3)), np.zeros(B, np.bool_), np.zeros(B),
        np.zeros((B, 2), np.int64),
    )  # fmt: skip
    return Work(
        _shape(1, S, n),
        _shape(N, S, n),
        _shape(N, S, n),
        _shape(1, S, n),
        way,
        motion,
        problem,
        new_pairs(m),
        new_iterate(m, N, n),
        scratch,
    )
