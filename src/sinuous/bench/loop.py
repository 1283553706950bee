"""A controller in closed loop on its own model, with the time of every step."""

import gc
from collections.abc import Generator
from contextlib import contextmanager
from dataclasses import dataclass
from math import nan
from time import perf_counter_ns, process_time_ns
from typing import Protocol, Self, TypeVar

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.scene import Scene

WARM_UP = 3  # steps before the first that counts: compiled code gets loaded, caches filled
NS_PER_S = 1e9


class State(Protocol):
    """What a controller remembers between steps."""

    @property
    def c(self) -> Array:
        """Configuration (n,)."""
        ...


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """How a step ended.

    Arguments:
        iterations: of the controller's solver
        failure: why the robot held still, empty if it did not
        status: in the solver's words
        functions: time spent on evaluating the model [s], nan where it is not counted
        solver: time that the solver counts itself [s], likewise
    """

    iterations: int
    failure: str = ""
    status: str = ""
    functions: float = nan
    solver: float = nan


S = TypeVar("S", bound=State)


class Controller(Protocol[S]):
    """What is measured."""

    def init(self, c: Array) -> S:
        """The state to start from, at rest at c (n,)."""
        ...

    def step(self, state: S, target: Array) -> S:
        """One step towards target (3,) [m]; this is what is timed."""
        ...

    def outcome(self, state: S) -> Outcome:
        """How the step that led to this state ended; not timed."""
        ...


@dataclass(frozen=True, kw_only=True, eq=False)
class Drive:
    """What a controller did.

    Arguments:
        c: configurations (K + 1, n), the start first
        cpu: processor time of every step [s] (K,), of all threads
        wall: time on the wall [s] (K,)
        outcomes: of every step (K,)
    """

    c: Array
    cpu: Array
    wall: Array
    outcomes: tuple[Outcome, ...]

    def followed_by(self, other: Self) -> Self:
        """Both as one: times and outcomes of two drives of the same controller.

        The way is that of the first; a controller that repeats itself takes the same twice.
        """
        return type(self)(
            c=self.c,
            cpu=np.concatenate([self.cpu, other.cpu]),
            wall=np.concatenate([self.wall, other.wall]),
            outcomes=self.outcomes + other.outcomes,
        )


def drive(controller: Controller[S], scene: Scene) -> Drive:
    """Drive through the scene once, after a few steps that do not count."""
    state = controller.init(scene.start)
    for target in scene.targets[:WARM_UP]:
        state = controller.step(state, target)
    steps = len(scene.targets)
    c = np.empty((steps + 1, len(scene.start)))
    cpu, wall, outcomes = np.empty(steps), np.empty(steps), list[Outcome]()
    state, c[0] = controller.init(scene.start), scene.start
    with no_garbage_collection():
        for k, target in enumerate(scene.targets):
            began, busy = perf_counter_ns(), process_time_ns()
            state = controller.step(state, target)
            cpu[k] = (process_time_ns() - busy) / NS_PER_S
            wall[k] = (perf_counter_ns() - began) / NS_PER_S
            c[k + 1] = state.c
            outcomes.append(controller.outcome(state))
    return Drive(c=c, cpu=cpu, wall=wall, outcomes=tuple(outcomes))


@contextmanager
def no_garbage_collection() -> Generator[None]:
    """Collect now and not again before the block ends."""
    gc.collect()
    gc.disable()
    try:
        yield
    finally:
        gc.enable()
