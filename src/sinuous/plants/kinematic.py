"""The disturbed integrator of paper B, eq. (5)-(7)."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.measurement import Measurement
from sinuous.plants.plant import Truth
from sinuous.robots.centreline import Centreline
from sinuous.robots.robot import Robot

UNKNOWN = np.zeros((0, 2))  # the curvature of a centre line that has corners


@dataclass(frozen=True, kw_only=True)
class Disturbance:
    """Normally distributed disturbances, clipped and held for a while (5), (6).

    Arguments:
        length_std, length_max: of w_x, on the actuator lengths [m]
        point_std, point_max: of w_y, on the body points, per axis [m]
        rate: how often both are drawn anew [Hz]

    Raises:
        ValueError: if a value is negative or not finite
    """

    length_std: float = 0.0
    length_max: float = np.inf
    point_std: float = 0.0
    point_max: float = np.inf
    rate: float = 5.0

    def __post_init__(self) -> None:
        scales = (self.length_std, self.point_std, self.rate)
        if not all(np.isfinite(v) and v >= 0.0 for v in scales) or self.rate == 0.0:
            raise ValueError("standard deviations must be zero or more, the rate positive")
        if not (self.length_max >= 0.0 and self.point_max >= 0.0):
            raise ValueError("largest disturbances must be zero or more")

    @classmethod
    def printed(cls) -> "Disturbance":
        """The values of paper B, III-B."""
        return cls(length_std=0.2e-3, length_max=2e-3, point_std=1e-3, point_max=5e-3, rate=5.0)


class KinematicPlant:
    """Integrates actuator rates and disturbs what is seen: y = f(x + w_x) + w_y (7).

    w_x is drawn for every actuator, which leaves the sum rule (19); the shape is that of the
    nearest lengths that keep it: the backbone as disturbed, the bend by least squares over
    the cables (notes B14).  w_y moves every body point but the fixed base; it is no bend, so
    the curvature is that of the shape without it.  Where modules meet at joints there is none.

    Arguments:
        robot: the robot to imitate
        seed: of the disturbances
        disturbance: None for an exact plant
        start: configuration (n,) to start from, by default the robot's home
        encoder_step: what the encoders resolve [m]. Above zero they are all that is measured: the
            shape is what their readings make of it; zero: lengths and shape as they are

    Raises:
        ValueError: if the encoders' step is negative or not finite
    """

    def __init__(
        self,
        robot: Robot,
        *,
        seed: int,
        disturbance: Disturbance | None = None,
        start: ArrayLike | None = None,
        encoder_step: float = 0.0,
    ) -> None:
        if not (np.isfinite(encoder_step) and encoder_step >= 0.0):
            raise ValueError(f"encoder_step must be zero or more, not {encoder_step}")
        self.robot = robot
        self._line = Centreline(robot=robot)
        self._rng = np.random.default_rng(seed)
        self._disturbance = disturbance
        self._encoder_step = encoder_step
        self._lengths = robot.lengths(robot.home if start is None else start)
        self._until_redraw = 0.0
        self._w_x = np.zeros(len(self._lengths))
        self._w_y = np.zeros((len(robot.radii), 3))
        self._truth: Truth | None = None

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        self._lengths = self._lengths + dt * np.asarray(rates, dtype=float)
        if self._disturbance is not None:
            self._disturb(self._disturbance, dt)
        self._truth = None
        if self._encoder_step > 0.0:
            read = self._encoder_step * np.rint(self._lengths / self._encoder_step)
            points = self.robot.points(self.robot.configuration(read))
            return Measurement(points=points, tip=points[-1], lengths=read)
        points = self._points(self.robot.points(self._configuration))
        return Measurement(points=points, tip=points[-1], lengths=self._lengths)

    @property
    def truth(self) -> Truth:
        """Where it is after the last step."""
        if self._truth is None:
            self._truth = self._look()
        return self._truth

    @property
    def _configuration(self) -> Array:
        return self.robot.configuration(self._lengths + self._w_x)

    def _points(self, points: Array) -> Array:
        """Body points (S, 3) [m] as they are, given those of the model."""
        return points if self._disturbance is None else points + self._w_y

    def _look(self) -> Truth:
        c = self._configuration
        points, T_w_t = self.robot.shape(c)
        T_w_t[:3, 3] += self._w_y[-1]
        return Truth(
            points=self._points(points),
            T_w_t=T_w_t,
            lengths=self._lengths,
            curvature=self._line.model(c).curvature if self._line.is_smooth else UNKNOWN,
        )

    def _disturb(self, d: Disturbance, dt: float) -> None:
        if self._until_redraw <= 1e-9 * dt:
            self._draw(d)
            # Steps longer than the period draw once each and leave no backlog.
            self._until_redraw = max(self._until_redraw + 1.0 / d.rate, dt)
        self._until_redraw -= dt

    def _draw(self, d: Disturbance) -> None:
        lengths = self._rng.normal(0.0, 1.0, self._w_x.shape)
        points = self._rng.normal(0.0, 1.0, self._w_y.shape)
        self._w_x = np.clip(d.length_std * lengths, -d.length_max, d.length_max)
        self._w_y = np.clip(d.point_std * points, -d.point_max, d.point_max)
        self._w_y[0] = 0.0
