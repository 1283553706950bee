"""The format of `[physics]` in robot files with segments."""

from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

from sinuous.files import Density, Duration, Length, Mass, Modulus
from sinuous.robots.mechanics_tables import CablePhysicsTable, NotNegative
from sinuous.robots.robot_tables import Positive
from sinuous.robots.rod_mechanics import RodMechanics, RoundRod

DEFAULT = RodMechanics()


@dataclass(frozen=True, kw_only=True)
class RodPhysicsTable(CablePhysicsTable):
    """`[physics]` of a robot of segments: all of it is for physics plants only."""

    backbone_radius: Annotated[Length, Positive] = DEFAULT.backbone.radius
    youngs_modulus: Annotated[Modulus, Positive] = DEFAULT.backbone.youngs_modulus
    poisson: Annotated[float, Field(gt=-1.0, le=0.5)] = DEFAULT.backbone.poisson
    backbone_density: Annotated[Density, NotNegative] = DEFAULT.backbone.density
    disk_mass: Annotated[Mass, NotNegative] = DEFAULT.disk_mass
    backbone_damping: Annotated[Duration, NotNegative] = DEFAULT.damping
    links_per_gap: Annotated[int, Field(ge=1, le=8)] = DEFAULT.links_per_gap

    @property
    def mechanics(self) -> RodMechanics:
        """What the robot is built from."""
        return RodMechanics(
            cables=self.cables,
            backbone=RoundRod(
                radius=self.backbone_radius,
                youngs_modulus=self.youngs_modulus,
                poisson=self.poisson,
                density=self.backbone_density,
            ),
            disk_mass=self.disk_mass,
            damping=self.backbone_damping,
            links_per_gap=self.links_per_gap,
        )
