"""What controllers that wrap another have of it."""

from dataclasses import dataclass
from typing import Generic, TypeVar

from sinuous.control.controller import Controller, ControllerState
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot

S = TypeVar("S", bound=ControllerState)


@dataclass(frozen=True, eq=False)
class Around(Generic[S]):
    """Robot, zone, margin and rate of a controller.

    Arguments:
        controller: any controller
    """

    controller: Controller[S]

    @property
    def robot(self) -> Robot:
        """The controller's."""
        return self.controller.robot

    @property
    def zone(self) -> SafeZone:
        """The room it may use."""
        return self.controller.zone

    @property
    def margin(self) -> float:
        """Least distance between body surface and wall [m]."""
        return self.controller.margin

    @property
    def dt(self) -> float:
        """Time between steps [s]."""
        return self.controller.dt
