"""What bends and moves a robot of segments besides its geometry: an elastic backbone and cables."""

from dataclasses import dataclass, field

import numpy as np

from sinuous.robots.mechanics import CableMechanics, check_not_negative, check_positive


@dataclass(frozen=True, kw_only=True)
class RoundRod:
    """A straight rod of round section and one linearly elastic material.

    Arguments:
        radius: of the section [m]
        youngs_modulus: E [Pa]
        poisson: ratio of lateral to axial strain
        density: [kg/m^3]

    Raises:
        ValueError: if a value is not finite or no material can have it
    """

    radius: float
    youngs_modulus: float
    poisson: float
    density: float

    def __post_init__(self) -> None:
        check_positive(radius=self.radius, youngs_modulus=self.youngs_modulus)
        check_not_negative(density=self.density)
        if not -1.0 < self.poisson <= 0.5:
            raise ValueError(f"poisson must be above -1 and at most 0.5, not {self.poisson}")

    @property
    def bending_stiffness(self) -> float:
        """E I [N m^2] with I = pi r^4 / 4."""
        return self.youngs_modulus * np.pi * self.radius**4 / 4

    @property
    def torsion_stiffness(self) -> float:
        """G J [N m^2] with G = E / (2 (1 + nu)) and J = 2 I, which is E I / (1 + nu)."""
        return self.bending_stiffness / (1.0 + self.poisson)

    @property
    def mass_per_length(self) -> float:
        """[kg/m]."""
        return self.density * np.pi * self.radius**2


@dataclass(frozen=True, kw_only=True)
class RodMechanics:
    """What the segments of a robot weigh and how they resist; all numbers are representative.

    Arguments:
        cables: all alike
        backbone: the same in all segments
        disk_mass: of each disk [kg]
        damping: how fast the backbone's own motion dies: its moment is that of a bend larger by
            the speed of bending times this [s]
        links_per_gap: of the model, from disk to disk; with more it is slower and no better

    Raises:
        ValueError: if a value is not finite or negative, or there is no link
    """

    cables: CableMechanics = field(default_factory=CableMechanics)
    backbone: RoundRod = field(
        default_factory=lambda: RoundRod(
            radius=0.7e-3, youngs_modulus=60e9, poisson=0.33, density=6450.0
        )
    )
    disk_mass: float = 0.3e-3
    damping: float = 0.02
    links_per_gap: int = 2

    def __post_init__(self) -> None:
        check_not_negative(disk_mass=self.disk_mass, damping=self.damping)
        if self.links_per_gap < 1:
            raise ValueError(f"links_per_gap must be one or more, not {self.links_per_gap}")
