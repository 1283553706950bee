"""The format of `[plant]` and `[sensor]`: what stands in for the robot, and what is seen of it."""

from dataclasses import dataclass
from enum import Enum
from typing import Annotated

from pydantic import AllowInfNan, Field

from sinuous.files import (
    Acceleration,
    Angle,
    Curvature,
    Duration,
    FieldError,
    Force,
    Frequency,
    Length,
    Mass,
)
from sinuous.plants.fibre import Fibre
from sinuous.plants.mismatched import Mismatch
from sinuous.plants.physics.assembly import GRAVITY, TICK

_NotNegative = Field(ge=0.0)
_Positive = Field(gt=0.0)

Point = tuple[Length, Length, Length]


@dataclass(frozen=True, kw_only=True)
class DisturbanceTable:
    """`[plant.disturbance]`: noise on actuator lengths and body points, held for a while."""

    length_std: Annotated[Length, _NotNegative] = 0.0
    length_max: Annotated[Length, _NotNegative, AllowInfNan(True)] = float("inf")
    point_std: Annotated[Length, _NotNegative] = 0.0
    point_max: Annotated[Length, _NotNegative, AllowInfNan(True)] = float("inf")
    rate: Annotated[Frequency, _Positive] = 5.0


@dataclass(frozen=True, kw_only=True)
class MismatchTable:
    """`[plant.mismatch]`: how the plant differs from the model, see `plants.mismatched`."""

    pitch_factor: Annotated[float, _Positive] = Mismatch.pitch_factor
    cable_angle: Angle = Mismatch.cable_angle
    coupling: float = Mismatch.coupling
    unevenness: float = Mismatch.unevenness
    sag: Annotated[Length, _NotNegative] = Mismatch.sag
    gravity: tuple[float, float, float] = Mismatch.gravity
    base_tilt: tuple[Angle, Angle] = Mismatch.base_tilt
    play: Annotated[Length, _NotNegative] = Mismatch.play
    slack_bend: Annotated[Angle, _Positive, AllowInfNan(True)] = Mismatch.slack_bend
    scatter: Annotated[float, _NotNegative] = Mismatch.scatter

    def __post_init__(self) -> None:
        if not any(self.gravity):
            raise FieldError(
                "gravity",
                expected="a direction that is not zero",
                remedy="Say where down is, like [0, 0, -1].",
            )


@dataclass(frozen=True, kw_only=True)
class RecordedTable:
    """`[plant.recorded]`: a record of tracker and encoders, played back."""

    csv: Annotated[str, Field(min_length=1)]
    coil: Point = (0.0, 0.0, 0.0)  # where the recorded tip was measured, in the tip's frame


@dataclass(frozen=True, kw_only=True)
class PhysicsTable:
    """`[plant.physics]`: the robot in a physics engine, by the `[physics]` of its own file."""

    gravity: tuple[Acceleration, Acceleration, Acceleration] = GRAVITY  # in the world
    payload: Annotated[Mass, _NotNegative] = 0.0  # at the tip
    tip_force: tuple[Force, Force, Force] = (0.0, 0.0, 0.0)  # in the world
    walls: bool = True  # the zone's facets push back
    tension_sensors: bool = True  # the controller is told the cables' tensions
    tick: Annotated[Duration, _Positive] = TICK  # of the engine, at most


@dataclass(frozen=True, kw_only=True)
class CalibratedTable:
    """`[plant.calibrated]`: the robot as `sinuous calibrate` found it, by its file's `[fitted]`."""

    compensated: bool = False  # its motors also pull what the cables stretch by


@dataclass(frozen=True, kw_only=True)
class PlantTable:
    """`[plant]`: what stands in for the robot: by default its model, exact or disturbed."""

    disturbance: DisturbanceTable | None = None
    mismatch: MismatchTable | None = None
    recorded: RecordedTable | None = None
    physics: PhysicsTable | None = None
    calibrated: CalibratedTable | None = None
    encoder_step: Annotated[Length, _NotNegative] = 0.0  # above zero nothing else is measured

    def __post_init__(self) -> None:
        kinds = ("disturbance", "mismatch", "recorded", "physics", "calibrated")
        given = [name for name in kinds if getattr(self, name) is not None]
        if len(given) > 1:
            raise FieldError(
                given[1],
                expected="one of disturbance, mismatch, recorded, physics and calibrated",
                remedy="Each is a plant of its own: keep one of them.",
            )
        if self.encoder_step > 0.0 and set(given) - {"disturbance"}:
            raise FieldError(
                "encoder_step",
                expected=f"none with {given[0]}",
                remedy="Their encoders are exact, or read as recorded: take it out.",
            )


class SensorChoice(Enum):
    """What is seen of the plant."""

    TIP = "tip"  # a coil at the tip
    SHAPE = "shape"  # every guarded point
    FIBRE = "fibre"  # curvature along the body, and the tip


@dataclass(frozen=True, kw_only=True)
class SensorTable:
    """`[sensor]`: what is seen of the plant; without it everything is, exactly and at once."""

    kind: SensorChoice
    rate: Annotated[Frequency, _Positive, AllowInfNan(True)] = float("inf")
    delay: Annotated[Duration, _NotNegative] = 0.0
    noise: Annotated[Length, _NotNegative] = 0.0  # of positions, per axis
    bias: Annotated[Length, _NotNegative] = 0.0  # of positions, the same at all times
    coil: Point = (0.0, 0.0, 0.0)  # of tip and fibre, in the frame of the tip
    stations: Annotated[int, Field(ge=1)] = Fibre.stations  # of the fibre, in each segment
    curvature_noise: Annotated[Curvature, _Positive] = Fibre.noise
    curvature_gain: Annotated[float, Field(ge=0.0, lt=1.0)] = Fibre.gain

    def __post_init__(self) -> None:
        if self.kind is SensorChoice.SHAPE and any(self.coil):
            raise FieldError(
                "coil",
                expected='a coil with kind = "tip" or "fibre" only',
                remedy="A shape sensor sees the body's own points: take coil out.",
            )
