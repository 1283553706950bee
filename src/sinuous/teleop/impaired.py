"""A link as networks are: packets that are late, lost, doubled or out of order."""

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from heapq import heappop, heappush
from typing import NamedTuple, Protocol

import numpy as np

from sinuous.teleop.checks import positive
from sinuous.teleop.link import Link, Packet

Delays = tuple[float, ...]
"""When the copies of a packet arrive, after it was sent [s]: none if it is lost."""

Course = Callable[[float, Delays], Delays]
"""What becomes of the copies of a packet that is sent at a time [s]."""


_DRAWN = 256  # random numbers at a time


class Effect(Protocol):
    """One thing that a network does to packets."""

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run, with luck of its own."""
        ...


def chances(rng: np.random.Generator) -> Iterator[float]:
    """Numbers uniform within [0, 1), one by one; drawn many at a time, which is much faster."""
    while True:
        yield from rng.random(_DRAWN).tolist()


@dataclass(frozen=True, kw_only=True)
class ImpairedLink:
    """A delay and what comes on top: effects, one after the other.

    Each packet starts as one copy that arrives at once; every effect makes of the copies what it
    does, such as adding its delay, dropping some or adding others. What is left arrives after its
    delay in whole ticks, one at least, several packets in a tick and out of order as it happens.

    Every effect of each way has random numbers of its own: runs with the same seed meet the same
    luck, also if effects are added behind.

    Arguments:
        effects: in the order in which they act
        seed: of all luck
        in_order: whether a packet waits for those that were sent before it and are still under
            way, as on a connection that keeps order
        dt: time of a tick [s]

    Raises:
        ValueError: if there is no effect, the seed is negative, or dt not positive
    """

    effects: tuple[Effect, ...]
    seed: int = 0
    in_order: bool = False
    dt: float = 1e-3

    def __post_init__(self) -> None:
        positive("dt", self.dt)
        if not self.effects:
            raise ValueError("effects must be one or more; a link without any is a ConstantDelay")
        if self.seed < 0:
            raise ValueError(f"seed must be zero or more, not {self.seed}")

    def open(self, way: int = 0) -> Link:
        """One way of a connection, with nothing under way."""
        seeds = np.random.SeedSequence(self.seed, spawn_key=(way,)).spawn(len(self.effects))
        courses = [
            effect.open(np.random.default_rng(seed))
            for effect, seed in zip(self.effects, seeds, strict=True)
        ]
        return _Network(courses, self.dt, in_order=self.in_order)


class _Copy(NamedTuple):
    """A packet under way, in the order of arrival.

    Arguments:
        tick: of the sender's clock from which on it has arrived
        place: among all copies that were made, so that no two are equal
        packet: that it is of
    """

    tick: int
    place: int
    packet: Packet


class _Network:
    """Copies of packets under way."""

    def __init__(self, courses: list[Course], dt: float, *, in_order: bool) -> None:
        self._courses, self._dt, self._in_order = courses, dt, in_order
        self._under_way = list[_Copy]()
        self._tick = self._made = self._last = 0

    def step(self, sent: Packet) -> tuple[Packet, ...]:
        """Take what is sent in this tick and yield all that the other end has by the next."""
        delays: Delays = (0.0,)
        for course in self._courses:
            delays = course(self._tick * self._dt, delays)
        for delay in delays:
            self._send(sent, self._tick + max(round(delay / self._dt), 1))
        self._tick += 1
        arrived = list[Packet]()
        while self._under_way and self._under_way[0].tick <= self._tick:
            arrived.append(heappop(self._under_way).packet)
        return tuple(arrived)

    def _send(self, packet: Packet, tick: int) -> None:
        if self._in_order:
            tick = self._last = max(tick, self._last)
        heappush(self._under_way, _Copy(tick, self._made, packet))
        self._made += 1
