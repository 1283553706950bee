"""What a physics plant needs of a robot: a model, and what its numbers mean."""

from typing import Any, Protocol

from sinuous.arrays import Array, IntArray
from sinuous.robots.mechanics import CableMechanics

# Robot and walls touch each other, but neither themselves.
WALL_TYPE, WALL_AFFINITY = 1, 0
BODY_TYPE, BODY_AFFINITY = 0, 1


class PhysicalBody(Protocol):
    """A robot as a MuJoCo model: the bodies, joints and tendons of it alone, at T_w_b.

    The plant sets the options and adds actuators, walls and payload before it compiles.
    """

    @property
    def spec(self) -> Any:
        """The model (MjSpec), not compiled."""
        ...

    @property
    def tendons(self) -> tuple[str, ...]:
        """Names of the tendons (C,), in the order of the robot's cable actuators."""
        ...

    @property
    def cables(self) -> IntArray:
        """Which of the robot's actuators are cables (C,)."""
        ...

    @property
    def mechanics(self) -> CableMechanics:
        """Of all cables."""
        ...

    @property
    def tip_body(self) -> str:
        """Name of the massless body whose origin is the tip: payload and tip force act there."""
        ...

    def cable_lengths(self, lengths: Array) -> Array:
        """Lengths (..., C) [m] of whole cables from the base plate, as the engine measures them.

        Unstretched and without pretension.

        Arguments:
            lengths: commanded actuator lengths (..., P) by the robot's convention [m]
        """
        ...

    def place(self, model: Any, data: Any, lengths: Array) -> None:
        """Do what other actuators than cables do: insertion, backbones.

        Arguments:
            lengths: commanded actuator lengths (P,) [m]
        """
        ...

    def pose(self, model: Any, data: Any, c: Array) -> None:
        """Put the robot into a configuration (n,), at rest."""
        ...

    def shape(self, data: Any) -> tuple[Array, Array]:
        """Guarded points (S, 3) in the world [m], as the robot orders them; tip pose (4, 4)."""
        ...
