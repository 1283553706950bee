"""What stands in for hardware: takes actuator rates, yields a measurement."""

from dataclasses import dataclass, field
from typing import NamedTuple, Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.measurement import Measurement


class PlantFault(Exception):
    """A plant that cannot go on, and why: the run has failed and the robot holds still."""


class Contacts(NamedTuple):
    """What touches the walls.

    Arguments:
        depth: deepest penetration [m]
        largest: largest normal force of a contact [N]
        total: of all normal forces [N]
    """

    depth: float
    largest: float
    total: float

    def worst(self, other: "Contacts") -> "Contacts":
        """The larger of each."""
        return Contacts(*map(max, self, other))


NO_CONTACT = Contacts(0.0, 0.0, 0.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Truth:
    """How a plant really is: for sensors and judges, never for controllers.

    Arguments:
        points: guarded body points (S, 3) in the world frame [m]
        T_w_t: pose of the tip (4, 4)
        lengths: actuator lengths (P,) [m]
        curvature: of the centre line on the arcs between the points (S - 1, 2) [1/m], see
            `robots.centreline`; (0, 2) if the plant does not know it
        tensions: of the cables (C,) [N], in the order of the actuators; (0,) if it does not know
        contacts: with walls during the last step, the worst; none if the plant has no walls
    """

    points: Array
    T_w_t: Array
    lengths: Array
    curvature: Array = field(default_factory=lambda: np.zeros((0, 2)))
    tensions: Array = field(default_factory=lambda: np.zeros(0))
    contacts: Contacts = NO_CONTACT


class Plant(Protocol):
    """A robot that moves."""

    @property
    def truth(self) -> Truth:
        """Where it really is after the last step."""
        ...

    def step(self, rates: Array, dt: float) -> Measurement:
        """Move with actuator rates (P,) [m/s] for dt [s] and measure."""
        ...
