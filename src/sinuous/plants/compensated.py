"""A calibrated robot whose motors are driven so that it bends as its kinematics say."""

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.measurement import Measurement
from sinuous.plants.plant import Plant, Truth
from sinuous.robots.elastic import ElasticModel
from sinuous.robots.pcc import PccRobot


class CompensatedPlant:
    """Turns the lengths that a controller asks for into motor positions by the inverse statics.

    What the controller moves and reads are the lengths of its kinematics; the motors also pull
    what the cables stretch by, so that the robot comes to rest where kinematics expect it. Friction
    and play are not made up for.

    Arguments:
        plant: at rest, its `lengths` those of the motors
        robot: the controller's model, with the plant's actuators
        model: the statics that were found
        start: configuration (n,) in which the plant is, by default the robot's home
    """

    def __init__(
        self,
        plant: Plant,
        *,
        robot: PccRobot,
        model: ElasticModel,
        start: ArrayLike | None = None,
    ) -> None:
        self._plant, self._robot, self._model = plant, robot, model
        self._straight = robot.lengths(np.zeros(len(robot.coordinate_names)))
        self._lengths = robot.lengths(robot.home if start is None else start)
        self._motors = plant.truth.lengths

    @property
    def truth(self) -> Truth:
        """Where it is after the last step."""
        return self._plant.truth

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with rates (P,) [m/s] of the model's lengths for dt [s] and measure."""
        self._lengths = self._lengths + dt * np.asarray(rates, dtype=float)
        bends = self._robot.configuration(self._lengths)
        motors = self._straight - self._model.pulls(bends)
        seen = self._plant.step((motors - self._motors) / dt, dt)
        self._motors = motors
        return Measurement(points=seen.points, tip=seen.tip, lengths=self._lengths)
