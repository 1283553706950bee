"""Who says where the tip shall go: the scenario's path itself, or an operator who follows it."""

from dataclasses import dataclass
from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.scenario import Scenario


class Guide(Protocol):
    """Turns a place on the path into a target for the controller, tick by tick."""

    @property
    def tick(self) -> float:
        """Time between two targets [s]."""
        ...

    @property
    def patience(self) -> float:
        """How long the body must rest before the next leg may begin [s]."""
        ...

    def target(self, place: Array, tip: Array) -> Array:
        """The target (3,) [m] of the tick that begins.

        Arguments:
            place: on the path (3,) [m]
            tip: as sensors saw it last (3,) [m]
        """
        ...

    def take(self) -> Array:
        """The signals (k, C) of the ticks since they were last taken."""
        ...


@dataclass(frozen=True, kw_only=True)
class AlongThePath:
    """The place itself is the target.

    Arguments:
        tick: one control step [s]
    """

    tick: float
    patience: float = 0.0

    def target(self, place: Array, tip: Array) -> Array:
        """The place."""
        return place

    def take(self) -> Array:
        """No signals."""
        return np.zeros((0, 0))


def guide_of(scenario: Scenario) -> Guide:
    """Who guides a scenario."""
    return AlongThePath(tick=scenario.controller.dt)
