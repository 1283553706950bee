"""The format of `[physics]` that robot files of all kinds share: their cables."""

from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

from sinuous.files import Impedance, Length, Stiffness
from sinuous.robots.mechanics import CableMechanics
from sinuous.robots.robot_tables import Positive

NotNegative = Field(ge=0.0)


@dataclass(frozen=True, kw_only=True)
class CablePhysicsTable:
    """Cables that stretch; see `CableMechanics`."""

    cable_stiffness: Annotated[Stiffness, Positive] = CableMechanics.stiffness
    cable_damping: Annotated[Impedance, NotNegative] = CableMechanics.damping
    pretension: Annotated[Length, NotNegative] = CableMechanics.pretension
    play: Annotated[Length, NotNegative] = CableMechanics.play

    @property
    def cables(self) -> CableMechanics:
        """What the robot is built from."""
        return CableMechanics(
            stiffness=self.cable_stiffness,
            damping=self.cable_damping,
            pretension=self.pretension,
            play=self.play,
        )
