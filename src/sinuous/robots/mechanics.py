"""What moves a robot besides its geometry: cables that stretch, modules that weigh."""

from dataclasses import dataclass, field

import numpy as np


@dataclass(frozen=True, kw_only=True)
class CableMechanics:
    """An elastic cable that can only pull, wound by a motor that yields to nothing.

    All numbers are representative: no paper prints them.

    Arguments:
        stiffness: of a whole cable between motor and robot [N/m]
        damping: of its stretching [N s/m]
        pretension: by how much it is wound shorter than it is at rest [m]
        play: dead band between motor and cable, by friction and clearance [m]

    Raises:
        ValueError: if a value is not finite, negative, or the stiffness zero
    """

    stiffness: float = 1e5
    damping: float = 200.0
    pretension: float = 0.3e-3
    play: float = 0.0

    def __post_init__(self) -> None:
        check_positive(stiffness=self.stiffness)
        check_not_negative(damping=self.damping, pretension=self.pretension, play=self.play)


@dataclass(frozen=True, kw_only=True)
class JointedMechanics:
    """What the modules of a jointed robot weigh and how their joints move; representative.

    Arguments:
        cables: all alike
        module_mass: of a tube with its two endplates [kg]
        joint_damping: of each of the two axes of a joint [N m s/rad]
        joint_armature: inertia of each axis besides the modules' own [kg m^2]

    Raises:
        ValueError: if a value is not finite, negative, or the mass zero
    """

    cables: CableMechanics = field(default_factory=CableMechanics)
    module_mass: float = 0.12
    joint_damping: float = 0.02
    joint_armature: float = 1e-4

    def __post_init__(self) -> None:
        check_positive(module_mass=self.module_mass)
        check_not_negative(joint_damping=self.joint_damping, joint_armature=self.joint_armature)


def check_positive(**values: float) -> None:
    """Refuse values that are not finite and above zero.

    Raises:
        ValueError: naming the first of them
    """
    for name, value in values.items():
        if not 0.0 < value < np.inf:
            raise ValueError(f"{name} must be positive and finite, not {value}")


def check_not_negative(**values: float) -> None:
    """Refuse values that are not finite, or below zero.

    Raises:
        ValueError: naming the first of them
    """
    for name, value in values.items():
        if not 0.0 <= value < np.inf:
            raise ValueError(f"{name} must be zero or more and finite, not {value}")
