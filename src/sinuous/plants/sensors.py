"""What is seen of a plant: now and then, not exactly, and a little late.

A sensor wraps any plant and is a plant itself. Motors, their encoders and what they pull with, are
read at every step; what an instrument says is taken at its own rate and handed over after a delay.
"""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass, replace
from math import hypot, sqrt

import numpy as np

from sinuous.arrays import Array
from sinuous.measurement import Measurement
from sinuous.plants.plant import Plant, Truth

Read = Callable[[Truth], Measurement]
"""What an instrument says of a plant as it is now."""

# Distinguishes the random numbers of sensors from those of plants with the same seed.
STREAM = 2
# A clock that adds up steps is late by rounding; a reading due within this share of a step is due.
ROUNDING = 1e-6


@dataclass(frozen=True, kw_only=True)
class Timing:
    """When an instrument reads.

    Arguments:
        rate: of its readings [Hz]; infinite: one at the end of every step
        delay: from taking a reading to handing it over [s]

    Raises:
        ValueError: if the rate is not positive, or the delay negative or not finite
    """

    rate: float = np.inf
    delay: float = 0.0

    def __post_init__(self) -> None:
        if not (self.rate > 0.0 and 0.0 <= self.delay < np.inf):
            raise ValueError("a rate must be positive, a delay finite and zero or more")


class Sensor:
    """A plant, seen through an instrument.

    A reading is due at every multiple of 1 / rate and taken at the end of the first step at or
    after that. The first one is taken before the first step and handed over until another has
    arrived; its age, like that of every reading, is the time since it was taken.

    Arguments:
        plant: what is seen
        read: the instrument
        timing: when it reads
    """

    def __init__(self, plant: Plant, read: Read, *, timing: Timing) -> None:
        self._plant, self._read, self._timing = plant, read, timing
        self._now, self._count = 0.0, 0
        self._shown = (0.0, read(plant.truth))
        self._waiting = deque[tuple[float, Measurement]]()

    @property
    def truth(self) -> Truth:
        """How the plant really is after the last step."""
        return self._plant.truth

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        now = self._plant.step(rates, dt)
        self._now += dt
        soon = self._now + ROUNDING * dt
        if soon * self._timing.rate >= self._count + 1:
            self._waiting.append((self._now, self._read(self._plant.truth)))
            # One reading serves all instants that a long step has passed.
            self._count = int(soon * self._timing.rate) if np.isfinite(self._timing.rate) else 0
        while self._waiting and self._waiting[0][0] + self._timing.delay <= soon:
            self._shown = self._waiting.popleft()
        taken, reading = self._shown
        return replace(reading, lengths=now.lengths, tensions=now.tensions, age=self._now - taken)


@dataclass(frozen=True, kw_only=True)
class Accuracy:
    """How far positions are off.

    A tracker's stated accuracy is mostly a distortion that stays as long as nothing moves far,
    and a little noise (notes B15): they are told apart, because a controller can average noise
    away and can do nothing about a bias.

    Arguments:
        noise: standard deviation of each axis and reading [m]
        bias: length of an offset that stays the same [m]; its direction is drawn once

    Raises:
        ValueError: if one is negative or not finite
    """

    noise: float = 0.0
    bias: float = 0.0

    def __post_init__(self) -> None:
        if not all(0.0 <= value < np.inf for value in (self.noise, self.bias)):
            raise ValueError("noise and bias must be finite and zero or more")

    @property
    def rms(self) -> float:
        """Root mean square distance of a reading from the truth [m]."""
        return hypot(self.bias, sqrt(3.0) * self.noise)

    @property
    def variance(self) -> float:
        """Variance of one axis, whatever the direction of the bias [m^2]."""
        return self.rms**2 / 3.0

    def draw_bias(self, rng: np.random.Generator) -> Array:
        """An offset (3,) [m] in a random direction."""
        direction = rng.normal(size=3)
        return self.bias * direction / np.linalg.norm(direction)


# Of paper B, section IV. That 1.4 mm is a root mean square distance is how we read "stated
# accuracy"; how much of it is noise is representative of electromagnetic trackers.
PRINTED_RATE, PRINTED_RMS, TRACKER_NOISE, PRINTED_COIL = 40.0, 1.4e-3, 0.2e-3, (0.0, 0.0, 0.01)


@dataclass(frozen=True, kw_only=True)
class TipTracker:
    """Sees a coil at the tip and nothing else of the body.

    Arguments:
        timing: when it reads
        accuracy: how far it is off
        coil: where the coil sits, in the frame of the tip [m]
    """

    timing: Timing = Timing()
    accuracy: Accuracy = Accuracy()
    coil: tuple[float, float, float] = (0.0, 0.0, 0.0)

    @classmethod
    def printed(cls) -> "TipTracker":
        """The tracker of paper B, section IV: 40 Hz, 1.4 mm, a coil 10 mm beyond the tip."""
        bias = sqrt(PRINTED_RMS**2 - 3.0 * TRACKER_NOISE**2)
        return cls(
            timing=Timing(rate=PRINTED_RATE),
            accuracy=Accuracy(noise=TRACKER_NOISE, bias=bias),
            coil=PRINTED_COIL,
        )

    def on(self, plant: Plant, seed: int) -> Sensor:
        """A plant, seen through this tracker."""
        return Sensor(plant, self.reader(seed), timing=self.timing)

    def reader(self, seed: int) -> Read:
        """What this tracker says, its errors drawn from a seed."""
        rng = np.random.default_rng((seed, STREAM))
        bias, coil = self.accuracy.draw_bias(rng), np.array(self.coil)

        def read(truth: Truth) -> Measurement:
            place = truth.T_w_t[:3, 3] + truth.T_w_t[:3, :3] @ coil
            noise = self.accuracy.noise * rng.normal(size=3)
            return Measurement(tip=place + bias + noise, lengths=truth.lengths, coil=coil)

        return read


@dataclass(frozen=True, kw_only=True)
class ShapeTracker:
    """Sees every guarded point of the body, with noise of its own and one bias for all.

    Arguments:
        timing: when it reads
        accuracy: how far each point is off
    """

    timing: Timing = Timing()
    accuracy: Accuracy = Accuracy()

    def on(self, plant: Plant, seed: int) -> Sensor:
        """A plant, seen through this tracker."""
        rng = np.random.default_rng((seed, STREAM))
        bias = self.accuracy.draw_bias(rng)

        def read(truth: Truth) -> Measurement:
            count = len(truth.points)
            points = truth.points + bias + self.accuracy.noise * rng.normal(size=(count, 3))
            covariance = np.tile(self.accuracy.variance * np.eye(3), (count, 1, 1))
            return Measurement(
                points=points, covariance=covariance, tip=points[-1], lengths=truth.lengths
            )

        return Sensor(plant, read, timing=self.timing)
