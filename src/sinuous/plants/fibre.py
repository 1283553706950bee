"""Curvature read along the body, as a fibre with Bragg gratings does, and the shape it gives."""

from dataclasses import dataclass, field

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.measurement import Measurement
from sinuous.plants.plant import Plant, Truth
from sinuous.plants.sensors import Sensor, Timing, TipTracker
from sinuous.plants.shape_estimate import ShapeEstimator, ShapePrior, Strain, TipFix
from sinuous.robots.centreline import Centreline
from sinuous.robots.robot import Robot

# No tracker is trusted more than this [m]: an exact one would leave the estimate no freedom.
FINEST = 1e-5
# Distinguishes the fibre's random numbers from those of its tracker with the same seed.
STREAM = 3


@dataclass(frozen=True, kw_only=True)
class Fibre:
    """Gratings along every bending segment, at equal distances.

    Arguments:
        stations: of every segment
        noise: standard deviation of each component of a reading [1/m]
        gain: standard deviation of each station's relative error, the same at all times

    Raises:
        ValueError: if there is no station, noise is not positive or gain is negative
    """

    stations: int = 6
    noise: float = 0.2
    gain: float = 0.01

    def __post_init__(self) -> None:
        if not (self.stations >= 1 and 0.0 < self.noise < np.inf and 0.0 <= self.gain < 1.0):
            raise ValueError("a fibre needs a station or more, noise above zero, a gain error < 1")

    def arcs(self, line: Centreline) -> IntArray:
        """Arcs of a centre line on which the stations are (K,), in ascending order."""
        places = (np.arange(self.stations) + 0.5) / self.stations
        chosen = set[int]()
        for section in np.unique(line.section[line.bends]):
            own = np.flatnonzero(line.section == section)
            nearest = np.argmin(np.abs(line.middle[own, None] - places), axis=0)
            chosen.update(own[nearest].tolist())
        return np.array(sorted(chosen))

    def variance(self, curvature: Array) -> Array:
        """Variance [1/m^2] of readings [1/m], in their shape."""
        return self.noise**2 + (self.gain * curvature) ** 2


@dataclass(frozen=True, kw_only=True)
class ShapeSensing:
    """Sees the whole body: a fibre in it, a tracker at its tip and the encoders, fused.

    What it yields are estimated points with their covariance; `tip` is the last of them.

    Arguments:
        robot: the model of what is seen
        fibre: in the body
        tracker: at its tip; its bias counts as an uncertainty like its noise
        prior: how far the robot may be off its model
        timing: when fibre and tracker are read; the tracker's own is not used

    Raises:
        ValueError: if the robot bends at joints instead of along segments
    """

    robot: Robot
    fibre: Fibre = field(default_factory=Fibre)
    tracker: TipTracker = field(default_factory=TipTracker.printed)
    prior: ShapePrior = field(default_factory=ShapePrior)
    timing: Timing = field(default_factory=lambda: Timing(rate=40.0))

    def __post_init__(self) -> None:
        if not Centreline(robot=self.robot).is_smooth:
            raise ValueError("a fibre follows bending segments, and this robot has joints")

    def on(self, plant: Plant, seed: int) -> Sensor:
        """A plant, seen through these instruments.

        Raises:
            ValueError: if the plant does not know the curvature of its centre line
        """
        line = Centreline(robot=self.robot, coil=self.tracker.coil)
        if len(plant.truth.curvature) != len(line.section):
            raise ValueError("a fibre needs a plant that knows the curvature of its centre line")
        estimator, reader = ShapeEstimator(line, self.prior), FibreReader(self.fibre, line, seed)
        track = self.tracker.reader(seed)
        variance = max(self.tracker.accuracy.variance, FINEST**2)

        def read(truth: Truth) -> Measurement:
            tip = TipFix(position=track(truth).tip, variance=variance)
            found = estimator.estimate(truth.lengths, strain=reader.read(truth), tip=tip)
            points = found.points
            return Measurement(
                points=points, covariance=found.covariance, tip=points[-1], lengths=truth.lengths
            )

        return Sensor(plant, read, timing=self.timing)


class FibreReader:
    """Reads a fibre, its errors drawn from a seed.

    Arguments:
        fibre: what is read
        line: the centre line that it follows
        seed: of gain errors and noise
    """

    def __init__(self, fibre: Fibre, line: Centreline, seed: int) -> None:
        self._fibre, self._arcs = fibre, fibre.arcs(line)
        self._rng = np.random.default_rng((seed, STREAM))
        self._gain = 1.0 + fibre.gain * self._rng.normal(size=(len(self._arcs), 1))

    def read(self, truth: Truth) -> Strain:
        """The curvature at the stations as read, with its variance."""
        noise = self._fibre.noise * self._rng.normal(size=(len(self._arcs), 2))
        curvature = self._gain * truth.curvature[self._arcs] + noise
        return Strain(
            arcs=self._arcs, curvature=curvature, variance=self._fibre.variance(curvature)
        )
