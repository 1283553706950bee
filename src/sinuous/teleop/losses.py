"""Packets that do not arrive, or more than once: effects that change how many copies there are."""

from dataclasses import dataclass
from math import inf, isfinite

import numpy as np

from sinuous.teleop.checks import positive, probability, zero_or_more
from sinuous.teleop.impaired import Course, Delays, chances


@dataclass(frozen=True, kw_only=True)
class BurstLoss:
    """Loss in bursts, after Gilbert and Elliott: a network that is now good, now bad.

    Before every packet it turns from good to bad and back with a probability each; in either
    state a packet is lost with another. It starts in the share of time that it spends in each.

    Arguments:
        worsening: probability to turn bad
        recovery: probability to turn good again; its inverse is the mean length in packets
        lost_when_good, lost_when_bad: probability that a packet is lost

    Raises:
        ValueError: if a probability is not within [0, 1], or the recovery zero

    Source: Gilbert, Capacity of a burst-noise channel, Bell Syst. Tech. J. 39 (1960); Elliott,
    Estimates of error rates for codes on burst-noise channels, ibid. 42 (1963).
    """

    worsening: float
    recovery: float
    lost_when_good: float = 0.0
    lost_when_bad: float = 1.0

    def __post_init__(self) -> None:
        for name in ("worsening", "recovery", "lost_when_good", "lost_when_bad"):
            probability(name, getattr(self, name))
        positive("recovery", self.recovery)

    @classmethod
    def of(cls, loss: float, *, length: float = 1.0) -> "BurstLoss":
        """Bursts in which all is lost.

        Arguments:
            loss: share of all packets that is lost, below 1
            length: of a burst on average, in packets; 1 / (1 - loss) makes losses independent

        Raises:
            ValueError: if there are no such bursts
        """
        probability("loss", loss)
        if not (isfinite(length) and length >= 1.0):
            raise ValueError(f"length must be one or more and finite, not {length}")
        worsening = loss / (length * (1.0 - loss)) if loss < 1.0 else inf
        if worsening > 1.0:
            raise ValueError(f"a loss of {loss} takes bursts longer than {length} packets")
        return cls(worsening=worsening, recovery=1.0 / length)

    @property
    def badness(self) -> float:
        """Share of packets that meet a bad network."""
        return self.worsening / (self.worsening + self.recovery)

    @property
    def loss(self) -> float:
        """Share of packets that is lost."""
        return (1.0 - self.badness) * self.lost_when_good + self.badness * self.lost_when_bad

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""
        chance = chances(rng)
        bad = next(chance) < self.badness

        def course(_: float, copies: Delays) -> Delays:
            nonlocal bad
            lost = next(chance) < (self.lost_when_bad if bad else self.lost_when_good)
            bad = next(chance) < (1.0 - self.recovery if bad else self.worsening)
            return () if lost else copies

        return course


@dataclass(frozen=True)
class RandomLoss:
    """Every packet is lost with the same probability, whatever became of those before.

    Arguments:
        loss: that probability

    Raises:
        ValueError: if it is not within [0, 1]
    """

    loss: float

    def __post_init__(self) -> None:
        probability("loss", self.loss)

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""
        chance = chances(rng)
        return lambda _, copies: () if next(chance) < self.loss else copies


@dataclass(frozen=True, kw_only=True)
class Duplication:
    """Some packets arrive twice.

    Arguments:
        share: of packets that do
        after: how much later the second copy arrives, at most; uniform [s]

    Raises:
        ValueError: if the share is not within [0, 1], or the time negative
    """

    share: float
    after: float = 0.01

    def __post_init__(self) -> None:
        probability("share", self.share)
        zero_or_more("after", self.after)

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""
        chance = chances(rng)

        def course(_: float, copies: Delays) -> Delays:
            twice, later = next(chance) < self.share, self.after * next(chance)
            return (*copies, *(copy + later for copy in copies)) if twice else copies

        return course


@dataclass(frozen=True)
class Outages:
    """Times in which nothing gets through; what is under way arrives.

    Arguments:
        intervals: beginnings and ends [s]

    Raises:
        ValueError: if one does not end after it begins
    """

    intervals: tuple[tuple[float, float], ...]

    def __post_init__(self) -> None:
        for begin, end in self.intervals:
            if not begin < end:
                raise ValueError(f"an outage must end after it begins, not {begin} to {end} s")

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""
        return lambda time, copies: (
            () if any(begin <= time < end for begin, end in self.intervals) else copies
        )


@dataclass(frozen=True, kw_only=True)
class RandomOutages:
    """Times in which nothing gets through, of the same length, at random.

    Arguments:
        rate: of outages while there is none [1/s]
        length: of each [s]

    Raises:
        ValueError: if the rate is negative or the length not positive
    """

    rate: float
    length: float

    def __post_init__(self) -> None:
        zero_or_more("rate", self.rate)
        positive("length", self.length)

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run."""

        def pause() -> float:
            return float(rng.exponential(1.0 / self.rate)) if self.rate > 0.0 else inf

        begin = pause()

        def course(time: float, copies: Delays) -> Delays:
            nonlocal begin
            while time >= begin + self.length:
                begin += self.length + pause()
            return () if time >= begin else copies

        return course
