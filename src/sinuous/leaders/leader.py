"""What every leader has in common: the hand it reads, the force it shows, its axes.

**Axes.** Everything here is in metres and newtons in one right-handed frame, seen by the operator
in front of the screen: x to his right, y away from him, z up.
"""

from dataclasses import dataclass
from enum import Enum
from typing import ClassVar, NamedTuple, Protocol, Self

import numpy as np

from sinuous.arrays import Array


class Hand(NamedTuple):
    """Where the operator's hand is.

    Arguments:
        position: since `open`, about a zero of its own (3,) [m]; it does not move while the device
            is not connected or not held
        held: whether the operator means it: False while a clutch is open
        connected: whether the device is there
        age: of the newest that the device has said [s]; a device at rest may say nothing
    """

    position: Array
    held: bool
    connected: bool
    age: float


class ForceKind(Enum):
    """What a device can do with a force; the value is the word that people read."""

    NONE = "none"
    RUMBLE = "rumble by its size"
    TRUE = "true force"


@dataclass(frozen=True, kw_only=True)
class About:
    """What people want to know of a device.

    Arguments:
        name: of the device
        axes: what of it moves the hand along x, y and z
        force: what it does with a force
        run_on_hardware: whether the driver has ever met the device; None if it needs no hardware
            that a test does not have
    """

    name: str
    axes: str
    force: ForceKind
    run_on_hardware: bool | None

    def __str__(self) -> str:
        met = {None: "", True: "; run on hardware", False: "; never run on hardware"}
        return f"{self.name}: {self.axes}; force: {self.force.value}{met[self.run_on_hardware]}"


class Leader(Protocol):
    """A device in the operator's hand.

    `read` and `feel` are called in every tick of the fastest loop and never wait: a driver whose
    device has to be waited for does so in a thread of its own, see `Reader`. Used as

        with leader:
            hand = leader.read(time)
            leader.feel(force)

    A device that is lost in mid-run says `connected=False` and holds its last position. If it comes
    back, the hand goes on from there.
    """

    about: ClassVar[About]

    def open(self) -> None:
        """Connect to the device.

        Raises:
            InputError: if it is not there, or what it needs is not installed
        """

    def close(self) -> None:
        """Let go of the device; no force is left on it."""

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session, which never runs backwards."""
        ...

    def feel(self, force: Array) -> None:
        """Push the operator's hand with a force (3,) [N], along the axes above."""

    def __enter__(self) -> Self:
        self.open()
        return self

    def __exit__(self, *_: object) -> None:
        self.close()


def point(name: str, value: object) -> Array:
    """A copy of three finite numbers.

    Raises:
        ValueError: for anything else
    """
    copy = np.array(value, dtype=np.float64)
    if copy.shape != (3,) or not np.all(np.isfinite(copy)):
        raise ValueError(f"{name} must be three finite numbers, not {value}")
    return copy


def positive(name: str, value: float) -> None:
    """Raise a ValueError unless a number is positive and finite."""
    if not 0.0 < value < float("inf"):
        raise ValueError(f"{name} must be positive and finite, not {value}")
