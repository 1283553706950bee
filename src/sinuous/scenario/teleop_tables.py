"""The format of `[teleop]`: an operator's hand, a connection, and what comes back."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated

from pydantic import Field

from sinuous.files import (
    Angle,
    Decay,
    Duration,
    FieldError,
    Force,
    Frequency,
    Impedance,
    Length,
    Mass,
    Speed,
    Stiffness,
    Turning,
)
from sinuous.scenario.link_tables import BoundsTable, LinkTable, PassivityTable
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.force import ErrorForce
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.move_and_wait import MoveAndWait
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.waves import PASSIVE_GAIN, ModifiedWaves

Point = tuple[Length, Length, Length]
Side = tuple[Length, Length]

_NotNegative = Field(ge=0.0)
_Positive = Field(gt=0.0)
_LongestDelay = 60.0  # [s]; packets under way are kept


class SchemeChoice(Enum):
    """How velocity and force travel."""

    STANDARD = "standard"  # wave variables as first published
    C1 = "c1"  # what paper A compares itself with
    C2 = "c2"  # paper A's own
    POSITION_FORCE = "position_force"  # velocity and force as they are: needs passivity control


class Space(Enum):
    """What the operator moves the tip in."""

    PLANE = "plane"  # (22) of paper A: the world's x and z at one depth y
    SPACE = "space"


class HandChoice(Enum):
    """Who holds the device."""

    IMPEDANCE = "impedance"
    TRAJECTORY = "trajectory"
    MOVE_AND_WAIT = "move_and_wait"


@dataclass(frozen=True, kw_only=True)
class WavesTable:
    """`[teleop.waves]`: numbers of the scheme; gain and cutoff are those of c2.

    The impedance of position_force is the damping of the leader's own motion.
    """

    impedance: Annotated[Impedance, _Positive] = ModifiedWaves.impedance
    gain: Annotated[float, _Positive] | None = None
    cutoff: Annotated[Turning, _Positive] | None = None
    allow_active: bool = False

    def __post_init__(self) -> None:
        if self.gain is not None and self.gain < PASSIVE_GAIN and not self.allow_active:
            raise FieldError(
                "gain",
                expected=f"{PASSIVE_GAIN} or more: below, the channel makes energy at some "
                "frequencies and may go unstable",
                remedy="Raise it, or set allow_active = true to see what happens.",
            )


@dataclass(frozen=True, kw_only=True)
class MappingTable:
    """`[teleop.mapping]`: from the operator's workspace to the robot's (22)."""

    space: Space = Space.SPACE
    scale: Annotated[float, _Positive] | tuple[Annotated[float, _Positive], ...] = 1.0
    depth: Length | None = None  # y0 of a plane; by default where the tip starts
    origin: Point | None = None  # of the space; by default where the tip starts
    rotation: tuple[Angle, Angle, Angle] = (0.0, 0.0, 0.0)  # about fixed x, then y, then z

    def __post_init__(self) -> None:
        axes = 2 if self.space is Space.PLANE else 3
        if isinstance(self.scale, tuple) and len(self.scale) != axes:
            raise FieldError(
                "scale",
                expected=f"one number, or {axes}, one for each axis",
                remedy="Give as many scales as the space has axes.",
            )
        if self.space is Space.PLANE and (self.origin is not None or any(self.rotation)):
            raise FieldError(
                "origin" if self.origin is not None else "rotation",
                expected="only depth for a plane",
                remedy='Take it out, or set space = "space".',
            )
        if self.space is Space.SPACE and self.depth is not None:
            raise FieldError(
                "depth", expected="origin for three axes", remedy='Or set space = "plane".'
            )


@dataclass(frozen=True, kw_only=True)
class OperatorTable:
    """`[teleop.operator]`: the device and whoever holds it; the path is where the hand goes."""

    kind: HandChoice = HandChoice.IMPEDANCE
    mass: Annotated[Mass, _Positive] = LeaderDevice.mass
    workspace: Annotated[Length, _Positive] | None = None  # of the device, to either side
    stiffness: Annotated[Stiffness, _NotNegative] = ImpedanceOperator.stiffness
    damping: Annotated[Impedance, _NotNegative] = ImpedanceOperator.damping
    moving: Annotated[Duration, _Positive] = MoveAndWait.moving
    patience: Annotated[Duration, _Positive] = MoveAndWait.patience
    tolerance: Annotated[Force, _NotNegative] = MoveAndWait.tolerance


@dataclass(frozen=True, kw_only=True)
class ForceTable:
    """`[teleop.force]`: the virtual force (23)-(25)."""

    gain: Annotated[Force, _NotNegative] = ErrorForce.gain
    length: Annotated[Length, _Positive] = ErrorForce.length
    stiffness: Annotated[Stiffness, _NotNegative] = BoxForce.stiffness
    damping: Annotated[Impedance, _NotNegative] = BoxForce.damping
    boundary: tuple[Side, ...] | None = None  # lower and upper side of a box, for each axis
    zone: bool = True  # whether the zone's walls are felt, by the desired tip
    constraints: bool = False  # or by the whole body, as the controller's constraints hold it
    nearness: Annotated[Length, _NotNegative] = 0.0  # room of the body below which it is felt

    def __post_init__(self) -> None:
        for low, high in self.boundary or ():
            if not low < high:
                raise FieldError(
                    "boundary",
                    expected="a lower and then an upper side for each axis",
                    remedy="It is inside out: put the smaller number first.",
                )
        if self.constraints and self.zone:
            raise FieldError(
                "zone",
                expected="false with constraints = true: a wall would be felt twice",
                remedy="Set zone = false, or take constraints out.",
            )


@dataclass(frozen=True, kw_only=True)
class CorrectionTable:
    """`[teleop.correction]`: passive correction of position drift; off without this table."""

    rate: Annotated[Decay, _Positive] = DriftCorrection.rate
    speed: Annotated[Speed, _Positive] = DriftCorrection.speed


@dataclass(frozen=True, kw_only=True)
class TeleopTable:
    """`[teleop]`: the path is followed by an operator's hand, over a connection."""

    scheme: SchemeChoice = SchemeChoice.C2
    rate: Annotated[Frequency, _Positive] = 1000.0
    delay: Annotated[Duration, Field(ge=0.0, le=_LongestDelay)] = 0.0  # one way
    waves: WavesTable = field(default_factory=WavesTable)
    mapping: MappingTable = field(default_factory=MappingTable)
    operator: OperatorTable = field(default_factory=OperatorTable)
    force: ForceTable = field(default_factory=ForceTable)
    correction: CorrectionTable | None = None
    link: LinkTable | None = None
    passivity: PassivityTable | None = None  # on by default where there is a link
    limits: BoundsTable | None = None

    @property
    def protection(self) -> PassivityTable | None:
        """What both ends do about the link: nothing on a constant delay unless asked for."""
        needed = self.link is not None or self.scheme is SchemeChoice.POSITION_FORCE
        return PassivityTable() if self.passivity is None and needed else self.passivity

    def __post_init__(self) -> None:
        axes = 2 if self.mapping.space is Space.PLANE else 3
        if self.force.boundary is not None and len(self.force.boundary) != axes:
            raise FieldError(
                ("force", "boundary"),
                expected=f"{axes} pairs, one for each axis",
                remedy="Give the lower and the upper side of every axis.",
            )
        own = self.waves.gain is not None or self.waves.cutoff is not None
        if own and self.scheme is not SchemeChoice.C2:
            raise FieldError(
                ("waves", "gain" if self.waves.gain is not None else "cutoff"),
                expected=f'none with scheme = "{self.scheme.value}"',
                remedy='Take it out, or set scheme = "c2".',
            )
        protected = self.protection is not None and self.protection.enabled
        if protected and self.waves.gain is not None and self.waves.gain < PASSIVE_GAIN:
            raise FieldError(
                ("waves", "gain"),
                expected=f"{PASSIVE_GAIN} or more under passivity control",
                remedy="Ports that make energy by themselves cannot be protected from the link: "
                "raise it, or set passivity.enabled = false.",
            )
        cutoff = ModifiedWaves.cutoff if self.waves.cutoff is None else self.waves.cutoff
        if self.scheme is SchemeChoice.C2 and cutoff > self.rate:
            raise FieldError(
                ("waves", "cutoff"),
                expected=f"at most the rate, {self.rate:g} per second",
                remedy="Lower it, or raise teleop.rate_hz: the low-pass would amplify.",
            )
