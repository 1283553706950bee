"""What every controller offers, so that a session knows none of them by name."""

from typing import Protocol, TypeVar

from sinuous.arrays import Array, ArrayLike
from sinuous.control.report import Command
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.robots.robot import Robot


class ControllerState(Protocol):
    """What a controller remembers between steps; frozen."""

    @property
    def c(self) -> Array:
        """Configuration (n,) that the controller holds the robot to be in: its nominal one."""
        ...


S = TypeVar("S", bound=ControllerState)


class Controller(Protocol[S]):
    """Steers the tip to a target, one command per step."""

    @property
    def robot(self) -> Robot: ...
    @property
    def zone(self) -> SafeZone:
        """The room the robot may use."""
        ...

    @property
    def margin(self) -> float:
        """Least distance between body surface and wall [m]."""
        ...

    @property
    def dt(self) -> float:
        """Time between steps [s]."""
        ...

    def init(self, c: ArrayLike) -> S:
        """The state to start from, at rest at configuration c (n,)."""
        ...

    def step(
        self, state: S, target: ArrayLike, measured: Measurement | None = None
    ) -> tuple[S, Command]:
        """One step towards a target (3,) [m], given what sensors said last."""
        ...
