"""The format of `[teleop.link]`, `.passivity` and `.limits`: networks as they are."""

from dataclasses import dataclass
from enum import Enum
from typing import Annotated

from pydantic import AllowInfNan, Field

from sinuous.files import Duration, FieldError, Force, Speed

_NotNegative = Field(ge=0.0)
_Positive = Field(gt=0.0)
_Share = Field(ge=0.0, lt=1.0)
_Unlimited = AllowInfNan(True)

Interval = tuple[Annotated[Duration, _NotNegative], Annotated[Duration, _NotNegative]]


class ReceiverChoice(Enum):
    """How an end fills the ticks in which no packet comes."""

    ZERO = "zero"  # with nothing
    HOLD = "hold"  # with the last wave again
    INTERPOLATE = "interpolate"  # by waiting a fixed time for every packet


@dataclass(frozen=True, kw_only=True)
class LinkTable:
    """`[teleop.link]`: what a network does to packets beside `teleop.delay`, both ways alike."""

    jitter: Annotated[Duration, _NotNegative] = 0.0  # to either side of the delay, uniform
    loss: Annotated[float, _Share] = 0.0  # share of packets
    burst: Annotated[float, Field(ge=1.0)] | None = None  # mean length of losses in packets
    duplication: Annotated[float, _Share] = 0.0  # share of packets that come twice
    in_order: bool = False  # packets wait for those sent before
    outages: tuple[Interval, ...] = ()  # beginnings and ends in which nothing gets through
    course: tuple[Interval, ...] = ()  # times and further delays, straight lines between them
    trace: Annotated[str, Field(min_length=1)] | None = None  # CSV of recorded delays

    def __post_init__(self) -> None:
        for begin, end in self.outages:
            if not begin < end:
                raise FieldError(
                    "outages",
                    expected="pairs of a beginning and a later end",
                    remedy="Put the earlier time first.",
                )
        times = [time for time, _ in self.course]
        if times != sorted(times):
            raise FieldError(
                "course",
                expected="pairs of a time and a further delay, in order of time",
                remedy="Sort them; two at the same time make a step.",
            )
        shortest = self.loss / (1.0 - self.loss)
        if self.burst is not None and self.burst < shortest:
            raise FieldError(
                "burst",
                expected=f"at least {shortest:.3g} packets for that loss",
                remedy="Lengthen the bursts, or lower the loss.",
            )


@dataclass(frozen=True, kw_only=True)
class PassivityTable:
    """`[teleop.passivity]`: what both ends do so that no link makes energy."""

    enabled: bool = True
    receiver: ReceiverChoice = ReceiverChoice.HOLD
    hold: Annotated[Duration, _NotNegative, _Unlimited] = 0.05  # then what is held fades away
    playout: Annotated[Duration, _NotNegative] | None = None  # interpolate: after sending

    def __post_init__(self) -> None:
        interpolates = self.receiver is ReceiverChoice.INTERPOLATE
        if interpolates != (self.playout is not None):
            raise FieldError(
                "playout",
                expected="a time" if interpolates else 'none unless receiver = "interpolate"',
                remedy="Give the time after sending at which every packet is used, as long as the "
                "longest usual delay."
                if interpolates
                else "Take it out.",
            )


@dataclass(frozen=True, kw_only=True)
class BoundsTable:
    """`[teleop.limits]`: bounds of what comes from afar, so that no packet can kick."""

    force: Annotated[Force, _Positive, _Unlimited] = float("inf")  # on a hand at rest
    force_time: Annotated[Duration, _NotNegative] = 0.0  # from none to the largest force
    speed: Annotated[Speed, _Positive, _Unlimited] = float("inf")  # desired, without a force
    speed_time: Annotated[Duration, _NotNegative] = 0.0

    def __post_init__(self) -> None:
        for name in ("force", "speed"):
            if getattr(self, f"{name}_time") > 0.0 and getattr(self, name) == float("inf"):
                raise FieldError(
                    f"{name}_time",
                    expected=f"a largest {name} with it",
                    remedy=f"Give {name} too: the time is from none to that.",
                )
