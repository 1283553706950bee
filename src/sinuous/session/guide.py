"""Who says where the tip shall go: the scenario's path itself, or an operator who follows it."""

from math import isclose
from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.scenario import Scenario
from sinuous.scenario.path import Leg
from sinuous.session.by_hand import ByHand
from sinuous.teleop.motion import NO_WALLS, Walls


class Guide(Protocol):
    """Yields targets for the controller, tick by tick."""

    @property
    def tick(self) -> float:
        """Time between two targets [s]."""
        ...

    @property
    def patience(self) -> float:
        """How long the body must rest before the next leg may begin [s]."""
        ...

    def begin(self, leg: Leg) -> None:
        """A leg of the path begins."""
        ...

    def target(self, tip: Array, walls: Walls = NO_WALLS) -> Array:
        """The target (3,) [m] of the tick that begins.

        Arguments:
            tip: as last measured (3,) [m]
            walls: that the controller knows of
        """
        ...

    def take(self) -> Array:
        """The signals (k, C) of the ticks since they were last taken."""
        ...


class AlongThePath:
    """The path itself, one control step at a time.

    Arguments:
        tick: one control step [s]
    """

    patience = 0.0

    def __init__(self, tick: float) -> None:
        self.tick = tick
        self._leg: Leg | None = None
        self._steps = 0

    def begin(self, leg: Leg) -> None:
        """Set out on a leg."""
        self._leg, self._steps = leg, 0

    def target(self, tip: Array, walls: Walls = NO_WALLS) -> Array:
        """The place on the path at the end of the step."""
        assert self._leg is not None
        self._steps += 1
        return self._leg.at(self._steps * self.tick)

    def take(self) -> Array:
        """No signals."""
        return np.zeros((0, 0))


def guide_of(scenario: Scenario) -> Guide:
    """Who guides a scenario.

    Raises:
        InputError: if a control step is no whole number of ticks
    """
    dt = scenario.controller.dt
    if scenario.teleop is None:
        return AlongThePath(dt)
    ticks = dt / scenario.teleop.dt
    if ticks < 1.0 or not isclose(ticks, round(ticks), rel_tol=1e-9):
        raise InputError(
            file=scenario.file,
            field="teleop.rate",
            expected=f"a whole multiple of the controller's rate, {1.0 / dt:g} Hz",
            found=f"{1.0 / scenario.teleop.dt:g} Hz",
            remedy="Change one of them, for example to mpc.rate_hz = 50 and teleop.rate_hz = 1000.",
        )
    start = scenario.robot.tip(scenario.first_configuration)
    return ByHand(scenario.teleop, start, scenario.path)
