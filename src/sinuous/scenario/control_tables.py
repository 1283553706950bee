"""The format of `[control]`: which controller runs, and its feedback."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated

from pydantic import Field

from sinuous.control.dls import DampedLeastSquares
from sinuous.control.local import LocalController
from sinuous.control.offset_free import OffsetFree, When
from sinuous.control.pid import Pid
from sinuous.control.tension import TautCables
from sinuous.control.transmission import Transmission
from sinuous.files import Decay, Duration, FieldError, Force, Frequency, Length, Turning

_NotNegative = Field(ge=0.0)
_Positive = Field(gt=0.0)


class LawChoice(Enum):
    """Which controller runs."""

    MPC = "mpc"
    DLS = "dls"  # the reference controller (30) of paper B
    GEOMETRIC_IK = "geometric_ik"  # with a PID for every cable, of paper A


class OffsetChoice(Enum):
    """When an offset is learned."""

    TIP_ONLY = "tip_only"
    ALWAYS = "always"
    NEVER = "never"

    @property
    def when(self) -> When:
        """The same for the controller."""
        return When[self.name]


@dataclass(frozen=True, kw_only=True)
class LocalTable:
    """`[control.local]`: feedback from the measured body (21)-(28) of paper B."""

    enabled: bool = True
    tip_gain: Annotated[Decay, _NotNegative] = LocalController.tip_gain
    body_gain: Annotated[Decay, _NotNegative] = LocalController.body_gain
    damping: Annotated[float, _Positive] = LocalController.damping
    share: Annotated[float, Field(ge=0.0, lt=1.0)] = LocalController.share  # of the speed limits


@dataclass(frozen=True, kw_only=True)
class OffsetFreeTable:
    """`[control.offset_free]`: learn what the model is wrong by at the tip."""

    when: OffsetChoice = OffsetChoice.TIP_ONLY
    time_constant: Annotated[Duration, _Positive] = OffsetFree.time_constant
    limit: Annotated[Length, _Positive] = OffsetFree.limit  # of the offset


@dataclass(frozen=True, kw_only=True)
class DlsTable:
    """`[control.dls]`: the reference controller (30); its defaults are the printed gains."""

    gain: Annotated[float, Field(gt=0.0, le=1.0)] = DampedLeastSquares.gain
    damping: Annotated[float, _Positive] = DampedLeastSquares.damping
    penalty: Annotated[float, _NotNegative] = DampedLeastSquares.penalty


@dataclass(frozen=True, kw_only=True)
class CableLoopTable:
    """`[control.cable_loop]`: the PIDs (26) of paper A behind geometric inverse kinematics."""

    rate: Annotated[Frequency, _Positive] = 1000.0
    proportional: Annotated[Decay, _NotNegative] = Pid.proportional
    integral: Annotated[float, _NotNegative] = Pid.integral  # [1/s^2]
    derivative: Annotated[float, _NotNegative] = Pid.derivative
    filter: Annotated[Duration, _NotNegative] = Pid.filter  # of the derivative
    lead: Annotated[Length, _Positive] = Transmission.lead
    ratio: Annotated[float, _Positive] = Transmission.ratio
    motor_speed: Annotated[Turning, _Positive] = Transmission.speed


@dataclass(frozen=True, kw_only=True)
class TautTable:
    """`[control.taut]`: keep every cable above a least tension."""

    floor: Annotated[Force, _Positive]
    time_constant: Annotated[Duration, _Positive] = TautCables.time_constant
    most: Annotated[Length, _Positive] = TautCables.most  # that cables are pulled in
    estimate: bool = False  # tensions where none are measured


@dataclass(frozen=True, kw_only=True)
class ControlTable:
    """`[control]`: which controller runs, and its feedback."""

    law: LawChoice = LawChoice.MPC
    project_target: bool = False  # onto where the tip keeps the margin
    local: LocalTable | None = None
    offset_free: OffsetFreeTable | None = None
    taut: TautTable | None = None
    dls: DlsTable = field(default_factory=DlsTable)
    cable_loop: CableLoopTable = field(default_factory=CableLoopTable)

    def __post_init__(self) -> None:
        if self.law is not LawChoice.MPC and (self.local or self.offset_free):
            raise FieldError(
                "law",
                expected='"mpc" with [control.local] or [control.offset_free]',
                remedy=f"These add feedback to the plan; {self.law.value} has its own. "
                "Take them out.",
            )
