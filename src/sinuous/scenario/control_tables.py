"""The format of `[control]`: which controller runs, and its feedback."""

from dataclasses import dataclass, field
from enum import Enum
from typing import Annotated

from pydantic import Field

from sinuous.control.dls import DampedLeastSquares
from sinuous.control.local import LocalController
from sinuous.control.offset_free import OffsetFree, When
from sinuous.files import Decay, Duration, FieldError, Length

_NotNegative = Field(ge=0.0)
_Positive = Field(gt=0.0)


class LawChoice(Enum):
    """Which controller runs."""

    MPC = "mpc"
    DLS = "dls"  # the reference controller (30) of paper B


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
class ControlTable:
    """`[control]`: which controller runs, and its feedback."""

    law: LawChoice = LawChoice.MPC
    project_target: bool = False  # onto where the tip keeps the margin
    local: LocalTable | None = None
    offset_free: OffsetFreeTable | None = None
    dls: DlsTable = field(default_factory=DlsTable)

    def __post_init__(self) -> None:
        if self.law is LawChoice.DLS and (self.local or self.offset_free):
            raise FieldError(
                "law",
                expected='"mpc" with [control.local] or [control.offset_free]',
                remedy="These add feedback to the plan; dls has its own. Take them out.",
            )
