"""A plant that behaves as a calibrated robot was found to behave."""

import numpy as np

from sinuous.arrays import Array, ArrayLike, BoolArray
from sinuous.measurement import Measurement
from sinuous.plants.plant import Truth
from sinuous.robots import elastic_kernels
from sinuous.robots.centreline import Centreline
from sinuous.robots.pcc import PccRobot


class CalibratedPlant:
    """Moves the motors exactly; elastic cables, friction and play decide how far it bends.

    Arguments:
        robot: one whose file `sinuous calibrate` wrote
        start: actuator lengths (P,) [m] to start from at rest, by default those of the robot's home

    Raises:
        ValueError: if the robot's file says nothing about its statics
    """

    def __init__(self, robot: PccRobot, *, start: ArrayLike | None = None) -> None:
        if robot.fitted is None:
            raise ValueError("the robot's file needs a [fitted] table; sinuous calibrate writes it")
        self.robot = robot
        self.model = robot.fitted.model
        self._line = Centreline(robot=robot)
        self._straight = robot.lengths(np.zeros(len(robot.coordinate_names)))
        self._lengths = np.array(robot.lengths(robot.home) if start is None else start, dtype=float)
        self._bends = self.model.at_rest(self._pulls)
        self._follow = self._pulls - self.model.slack
        self.truth = self._look()

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        self._lengths = self._lengths + dt * np.asarray(rates, dtype=float)
        rows, out = (self._pulls - self.model.slack)[None], np.empty((1, len(self._bends)))
        elastic_kernels.trace(self.model.cables, rows, self._follow, self._bends, out)
        self.truth = self._look()
        points = self.truth.points
        return Measurement(points=points, tip=points[-1], lengths=self._lengths)

    @property
    def slack(self) -> BoolArray:
        """Which cables (C,) have no tension."""
        return self.model.is_slack(self._pulls, self._bends)

    @property
    def _pulls(self) -> Array:
        return self._straight - self._lengths

    def _look(self) -> Truth:
        points, T_w_t = self.robot.shape(self._bends)
        return Truth(
            points=points,
            T_w_t=T_w_t,
            lengths=self._lengths,
            curvature=self._line.model(self._bends).curvature,
        )
