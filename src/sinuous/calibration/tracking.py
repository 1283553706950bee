"""What a calibration is worth in the loop: controllers with and without it, on one plant."""

from dataclasses import dataclass, replace

import numpy as np

from sinuous.arrays import Array
from sinuous.control.hierarchical import HierarchicalController
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.offset_free import OffsetFree, When
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.plants.calibrated import CalibratedPlant
from sinuous.plants.compensated import CompensatedPlant
from sinuous.plants.plant import Plant
from sinuous.robots.pcc import PccRobot

DT = 1 / 30
PERIOD, RADIUS = 20.0, 0.3  # time of one turn [s], radius as a share of the robot's length
DROP = 1 / 3  # by which the ring lies below the straight tip, as a share of its radius
HORIZON = 2


@dataclass(frozen=True, kw_only=True)
class Tracked:
    """Distances of the true tip from a moving target.

    Arguments:
        rms: root mean square [m]
        worst: largest [m]
    """

    rms: float
    worst: float


def ring(robot: PccRobot, *, radius: float = RADIUS, period: float = PERIOD) -> Array:
    """Targets (K, 3) [m] of two turns on a ring around the axis of the base."""
    length = sum(segment.home_length for segment in robot.segments)
    angle = 2.0 * np.pi * np.arange(0.0, 2.0 * period, DT) / period
    height = np.full_like(angle, 1.0 - DROP * radius)
    across = radius * np.stack([np.cos(angle), np.sin(angle)])
    here = length * np.stack([*across, height], axis=1)
    return np.asarray(here @ robot.T_w_b[:3, :3].T + robot.T_w_b[:3, 3])


def nominal(robot: PccRobot, preset: PccRobot) -> PccRobot:
    """The robot as it was before calibration, but with the marker where it really is."""
    return replace(preset, tool=robot.tool, T_w_b=robot.T_w_b)


def track(
    model: PccRobot,
    real: PccRobot,
    *,
    feedback: bool,
    compensated: bool = False,
    radius: float = RADIUS,
    period: float = PERIOD,
) -> Tracked:
    """Follow the ring with a controller that knows `model`, on the plant of `real`.

    Arguments:
        model: what the controller thinks of the robot
        real: whose calibration the plant follows
        feedback: whether the controller sees the tip, and learns what the model is wrong by;
            without, it plans alone
        compensated: whether the motors make up for what elastic cables lose (`CompensatedPlant`)
        radius, period: of the ring, a share of the length, and [s]

    Returns:
        errors of the second turn
    """
    mpc = ShapeConstrainedMPC(model, SafeZone.unbounded(), dt=DT, horizon=HORIZON)
    controller = (
        HierarchicalController(mpc)
        if feedback
        else HierarchicalController(mpc, local=None, offset_free=OffsetFree(when=When.NEVER))
    )
    plant: Plant = CalibratedPlant(real)
    if compensated and real.fitted is not None:
        plant = CompensatedPlant(plant, robot=model, model=real.fitted.model)
    state, measured, errors = controller.init(model.home), None, list[float]()
    for target in ring(real, radius=radius, period=period):
        state, command = controller.step(state, target, measured)
        seen = plant.step(command.rates, DT)
        measured = Measurement(tip=seen.tip, lengths=seen.lengths)
        errors.append(float(np.linalg.norm(plant.truth.T_w_t[:3, 3] - target)))
    second = np.array(errors[len(errors) // 2 :])
    return Tracked(rms=float(np.sqrt(np.mean(second**2))), worst=float(np.max(second)))
