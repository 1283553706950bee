"""Plants for tests of sensors and of what reads them."""

import numpy as np

from sinuous.arrays import Array
from sinuous.measurement import Measurement
from sinuous.plants.plant import Plant, Truth


class Runner:
    """A tip that runs along x at 1 m/s, so that its place tells when it was seen.

    Its frame is turned by a quarter about z: what lies along x of the tip lies along y.
    """

    def __init__(self, points: int = 3) -> None:
        self._time, self._points = 0.0, points
        self.truth = self._look()

    def step(self, rates: Array, dt: float) -> Measurement:
        self._time += dt
        self.truth = self._look()
        return Measurement(tip=self.truth.points[-1], lengths=self.truth.lengths)

    def _look(self) -> Truth:
        T_w_t = np.array([[0.0, -1, 0, self._time], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
        points = np.linspace([0.0, 0.0, 0.0], T_w_t[:3, 3], self._points)
        curvature = np.full((self._points - 1, 2), self._time)
        return Truth(
            points=points, T_w_t=T_w_t, lengths=np.array([self._time]), curvature=curvature
        )


class TruthRead(Exception):
    """Something that may only read measurements read the truth."""


class Sealed:
    """A plant that measures like another, and whose truth nobody may read."""

    def __init__(self, plant: Plant) -> None:
        self._plant = plant

    @property
    def truth(self) -> Truth:
        raise TruthRead

    def step(self, rates: Array, dt: float) -> Measurement:
        return self._plant.step(rates, dt)


class Replaced:
    """A plant that measures like another, and whose truth is another one's."""

    def __init__(self, plant: Plant, truth: Truth) -> None:
        self._plant, self.truth = plant, truth

    def step(self, rates: Array, dt: float) -> Measurement:
        return self._plant.step(rates, dt)
