"""How long packets take: effects that change the delay of every copy."""

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from math import inf

import numpy as np

from sinuous.teleop.checks import zero_or_more
from sinuous.teleop.impaired import Course, Delays, chances

_DRAWN = 256  # random numbers at a time


@dataclass(frozen=True)
class Steady:
    """The same delay for every packet.

    Arguments:
        delay: one way [s]

    Raises:
        ValueError: if it is negative or not finite
    """

    delay: float

    def __post_init__(self) -> None:
        zero_or_more("delay", self.delay)

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""
        return lambda _, copies: tuple(copy + self.delay for copy in copies)


@dataclass(frozen=True)
class Varying:
    """A delay that ramps and steps while time goes on, by the time of sending.

    Arguments:
        points: of time [s] and delay [s], in order of time; straight lines between them, two at
            the same time for a step, constant before the first and after the last

    Raises:
        ValueError: if there is no point, a delay is negative, or times go back
    """

    points: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        if not self.points:
            raise ValueError("points must be one or more")
        for time, delay in self.points:
            zero_or_more("times", time)
            zero_or_more("delays", delay)
        times = [time for time, _ in self.points]
        if times != sorted(times):
            raise ValueError(f"points must be in order of time, not at {times}")

    def at(self, time: float) -> float:
        """The delay [s] of what is sent at a time [s]."""
        after = bisect_right(self.points, time, key=lambda point: point[0])
        if after == 0 or after == len(self.points):
            return self.points[max(after - 1, 0)][1]
        (t0, d0), (t1, d1) = self.points[after - 1], self.points[after]
        return d0 + (d1 - d0) * (time - t0) / (t1 - t0)

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""

        def course(time: float, copies: Delays) -> Delays:
            delay = self.at(time)
            return tuple(copy + delay for copy in copies)

        return course


@dataclass(frozen=True)
class UniformJitter:
    """A delay of its own for every copy, uniform within [-spread, spread] around what it had.

    What would be negative is zero.

    Arguments:
        spread: [s]

    Raises:
        ValueError: if it is negative or not finite
    """

    spread: float

    def __post_init__(self) -> None:
        zero_or_more("spread", self.spread)

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""
        chance, low, width = chances(rng), -self.spread, 2.0 * self.spread
        return lambda _, copies: tuple(
            max(copy + low + width * next(chance), 0.0) for copy in copies
        )


@dataclass(frozen=True)
class NormalJitter:
    """A delay of its own for every copy, normal around what it had, and truncated.

    Drawn again until it is within `cut` deviations. What would be negative is zero.

    Arguments:
        deviation: standard deviation before it is truncated [s]
        cut: largest departure, in deviations; 0.1 or more

    Raises:
        ValueError: if the deviation is negative, or the cut too small
    """

    deviation: float
    cut: float = 3.0

    def __post_init__(self) -> None:
        zero_or_more("deviation", self.deviation)
        if not 0.1 <= self.cut < inf:
            raise ValueError(f"cut must be 0.1 or more and finite, not {self.cut}")

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""

        def drawn() -> Iterator[float]:
            while True:
                values = rng.standard_normal(_DRAWN)
                yield from (self.deviation * values[np.abs(values) <= self.cut]).tolist()

        departures = drawn()
        return lambda _, copies: tuple(max(copy + next(departures), 0.0) for copy in copies)
