"""Plants and sensors of a scenario, from its tables."""

from collections.abc import Callable
from dataclasses import fields
from typing import Any

from sinuous.plants.fibre import Fibre, ShapeSensing
from sinuous.plants.kinematic import Disturbance
from sinuous.plants.mismatched import Mismatch
from sinuous.plants.plant import Plant
from sinuous.plants.sensors import Accuracy, ShapeTracker, Timing, TipTracker
from sinuous.robots.robot import Robot
from sinuous.scenario.plant_tables import (
    DisturbanceTable,
    MismatchTable,
    SensorChoice,
    SensorTable,
)


def disturbance_of(table: DisturbanceTable | None) -> Disturbance | None:
    """The disturbance of a table, None for none."""
    return None if table is None else Disturbance(**_fields(table))


def mismatch_of(table: MismatchTable | None) -> Mismatch | None:
    """The mismatch of a table, None for none."""
    return None if table is None else Mismatch(**_fields(table))


def sensor_of(table: SensorTable | None, robot: Robot) -> Callable[[Plant, int], Plant] | None:
    """What wraps a plant, given a seed; None if everything is measured exactly."""
    if table is None:
        return None
    timing = Timing(rate=table.rate, delay=table.delay)
    accuracy = Accuracy(noise=table.noise, bias=table.bias)
    tracker = TipTracker(timing=timing, accuracy=accuracy, coil=table.coil)
    match table.kind:
        case SensorChoice.TIP:
            return tracker.on
        case SensorChoice.SHAPE:
            return ShapeTracker(timing=timing, accuracy=accuracy).on
        case SensorChoice.FIBRE:
            fibre = Fibre(
                stations=table.stations, noise=table.curvature_noise, gain=table.curvature_gain
            )
            return ShapeSensing(robot=robot, fibre=fibre, tracker=tracker, timing=timing).on


def _fields(table: DisturbanceTable | MismatchTable) -> dict[str, Any]:
    """The values of a table by name: those of the plants have the same ones."""
    return {one.name: getattr(table, one.name) for one in fields(table)}
