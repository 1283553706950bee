"""The format of scenario files: their tables, and what these must obey."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated

from pydantic import Field

from sinuous.files import Angle, Duration, FieldError, Frequency, Length, Speed
from sinuous.scenario.control_tables import ControlTable, LawChoice
from sinuous.scenario.path import MAX_STEPS
from sinuous.scenario.plant_tables import PlantTable, SensorTable
from sinuous.scenario.teleop_tables import TeleopTable

Point = tuple[Length, Length, Length]

_NotNegative = Field(ge=0.0)
_Positive = Field(gt=0.0)
_Named = Field(min_length=1)
_MostSteps = 1_000_000  # nobody waits longer for one way-point
_LongestHorizon = 200  # nobody looks ahead further; scratch grows with it


class CostChoice(Enum):
    """What the controller minimises."""

    UNBIASED = "unbiased"  # no steady error
    PRINTED = "printed"  # the cost (10) of paper B


@dataclass(frozen=True, kw_only=True)
class RobotChoice:
    """`[robot]`: which robot, where its base stands and how it starts."""

    file: Annotated[str, _Named]  # a preset, or a path relative to the scenario
    limits: str = "simulation"
    base_position: Point = (0.0, 0.0, 0.0)
    base_rotation: tuple[Angle, Angle, Angle] = (0.0, 0.0, 0.0)  # about fixed x, then y, then z
    start_lengths: tuple[Length, ...] | None = None  # of all actuators


@dataclass(frozen=True, kw_only=True)
class ZoneTable:
    """`[zone]`: the mesh; without it there is no wall."""

    mesh: Annotated[str, _Named]
    unit: str
    cap: bool = False
    entrance: Point | tuple[Point, ...] | None = None
    approach: Annotated[Length, _Positive] = 0.3
    keep_out: tuple[Annotated[str, _Named], ...] = ()


@dataclass(frozen=True, kw_only=True)
class MpcTable:
    """`[mpc]`: the controller."""

    horizon: Annotated[int, Field(ge=1, le=_LongestHorizon)] = 10
    rate: Annotated[Frequency, _Positive] = 30.0
    margin: Annotated[Length, _NotNegative] = 0.003
    tip_speed: Annotated[Speed, _Positive] | None = None
    budget: Annotated[Duration, _Positive] | None = None  # processor time of a step
    cost: CostChoice = CostChoice.UNBIASED


@dataclass(frozen=True, kw_only=True)
class PathTable:
    """`[path]`: way-points, or the CSV file of a path in time."""

    waypoints: Annotated[tuple[Point, ...], Field(min_length=1)] | None = None
    csv: Annotated[str, _Named] | None = None
    max_steps: Annotated[int, Field(ge=1, le=_MostSteps)] = MAX_STEPS

    def __post_init__(self) -> None:
        if self.waypoints is None and self.csv is None:
            raise FieldError(
                "waypoints",
                expected="waypoints_mm or csv",
                remedy="Say where the tip shall go: waypoints_mm = [[0, 0, 150]].",
            )
        if self.waypoints is not None and self.csv is not None:
            raise FieldError(
                "csv", expected="either waypoints or csv, not both", remedy="Keep one of them."
            )


@dataclass(frozen=True, kw_only=True)
class ScenarioTable:
    """A scenario file."""

    name: Annotated[str, _Named]
    robot: RobotChoice
    path: PathTable
    about: str = ""
    seed: Annotated[int, Field(ge=0, lt=2**63)] = 0
    recover: bool = False
    zone: ZoneTable | None = None
    mpc: MpcTable = field(default_factory=MpcTable)
    control: ControlTable = field(default_factory=ControlTable)
    plant: PlantTable = field(default_factory=PlantTable)
    sensor: SensorTable | None = None
    teleop: TeleopTable | None = None

    def __post_init__(self) -> None:
        felt = self.teleop is not None and self.teleop.force.constraints
        if felt and self.control.law is not LawChoice.MPC:
            raise FieldError(
                ("teleop", "force", "constraints"),
                expected=f'false with control.law = "{self.control.law.value}": it has none',
                remedy='Set zone = true in its stead, or control.law = "mpc".',
            )
