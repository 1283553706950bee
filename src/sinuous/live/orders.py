"""What may be asked of a session while it runs."""

from collections.abc import Callable
from dataclasses import dataclass
from math import isfinite

from sinuous.arrays import Array
from sinuous.leaders.leader import Leader, point
from sinuous.scenario import Scenario
from sinuous.scenario.teleop_tables import SchemeChoice


def _not_negative(**values: float | None) -> None:
    for name, value in values.items():
        if value is not None and not (isfinite(value) and value >= 0.0):
            raise ValueError(f"{name} must be zero or more, not {value}")


@dataclass(frozen=True, kw_only=True, eq=False)
class Aim:
    """Take the gizmo to a place.

    Arguments:
        target: for the tip (3,) [m]
        stamp: grows from one to the next; an older one than before is ignored

    Raises:
        ValueError: if the target is not three finite numbers
    """

    target: Array
    stamp: float

    def __post_init__(self) -> None:
        object.__setattr__(self, "target", point("target", self.target))


@dataclass(frozen=True)
class PageLost:
    """The page with the gizmo is gone: hold still."""


@dataclass(frozen=True)
class Pause:
    """Hand and robot part, by a ramp; the robot holds still."""


@dataclass(frozen=True)
class Resume:
    """They come together again, from where each is then."""


@dataclass(frozen=True, kw_only=True)
class SetLink:
    """Another connection, from now on; what is under way on the old one still arrives.

    Arguments:
        delay: one way [s]
        jitter: to either side of it [s]
        loss: share of packets

    Raises:
        ValueError: if one is negative, or the loss is all
    """

    delay: float
    jitter: float = 0.0
    loss: float = 0.0

    def __post_init__(self) -> None:
        _not_negative(delay=self.delay, jitter=self.jitter, loss=self.loss)
        if self.loss >= 1.0:
            raise ValueError(f"loss must be a share below one, not {self.loss}")


@dataclass(frozen=True, kw_only=True)
class SetFeel:
    """Another way to carry motion and force; hand and robot part for it, and come together again.

    None leaves what there is.

    Arguments:
        scheme: of the waves
        impedance: b [N s/m]
        gain: of the force of the tracking error [N]
        stiffness: of the walls [N/m]

    Raises:
        ValueError: if a number is negative, or the impedance zero
    """

    scheme: SchemeChoice | None = None
    impedance: float | None = None
    gain: float | None = None
    stiffness: float | None = None

    def __post_init__(self) -> None:
        _not_negative(impedance=self.impedance, gain=self.gain, stiffness=self.stiffness)
        if self.impedance == 0.0:
            raise ValueError("impedance must be positive")


@dataclass(frozen=True)
class Reset:
    """Begin again from the start, with other fields of the scenario if there are any.

    Everything that is not said above goes this way: horizon, gains of the controller, plant,
    disturbance, another scenario, or another device. Both loops are made anew, which takes a second
    or two. What cannot be used is refused, and the session goes on as it was.

    Arguments:
        set: fields as on the command line, such as "mpc.horizon=8", in addition to those before
        scenario: another file; None for the same
        leader: makes another device; None for the same
    """

    set: tuple[str, ...] = ()
    scenario: str | None = None
    leader: Callable[[Scenario], Leader] | None = None


@dataclass(frozen=True)
class Record:
    """Record from now on.

    Arguments:
        folder: for the recording; None to stop recording
    """

    folder: str | None


@dataclass(frozen=True)
class Stop:
    """End the session."""


HandOrder = Aim | PageLost | Pause | Resume | SetLink | SetFeel
"""What the hand's side does by itself."""

Order = HandOrder | Reset | Record | Stop
