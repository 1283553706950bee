"""Physical quantities in files: a key carries its unit, the program sees SI.

A dimensioned field of a table is annotated with one of the types below, alone or
inside a list, a tuple or an optional. In the file its key ends with a unit:
`Length` named `pitch_radius` is written `pitch_radius_mm`, `_cm` or `_m`.
"""

import math
from dataclasses import dataclass
from enum import Enum
from typing import Annotated

from sinuous.errors import InputError


@dataclass(frozen=True, kw_only=True)
class Unit:
    """One unit: how much of SI it is.

    Two factors, because 7 / 1000 is the number nearest to 0.007 and 7 * 1e-3 need not be.
    """

    multiply: float = 1.0
    divide: float = 1.0

    def to_si(self, value: float) -> float:
        """Convert a value in this unit to SI."""
        return value * self.multiply / self.divide

    def from_si(self, value: float) -> float:
        """Convert a value in SI to this unit."""
        return value * self.divide / self.multiply


_MILLI = Unit(divide=1000.0)
_CENTI = Unit(divide=100.0)
_SI = Unit()


class Quantity(Enum):
    """What a number measures; the value is the word that messages use."""

    LENGTH = "length"
    ANGLE = "angle"
    SPEED = "speed"
    CURVATURE = "curvature"
    DURATION = "duration"
    FREQUENCY = "frequency"
    DECAY = "rate of decay"
    TURNING = "speed of turning"
    FORCE = "force"
    STIFFNESS = "stiffness"
    IMPEDANCE = "damping"
    MASS = "mass"
    ROTARY_DAMPING = "damping of turning"
    INERTIA = "moment of inertia"
    MODULUS = "modulus of elasticity"
    DENSITY = "density"
    ACCELERATION = "acceleration"

    @property
    def units(self) -> dict[str, Unit]:
        """The key endings of this quantity, the customary one first."""
        return _UNITS[self]

    def keys(self, field: str) -> list[str]:
        """Return the keys under which a file may give a field of this quantity."""
        return [f"{field}_{suffix}" for suffix in self.units]


_UNITS: dict[Quantity, dict[str, Unit]] = {
    Quantity.LENGTH: {"mm": _MILLI, "cm": _CENTI, "m": _SI},
    Quantity.ANGLE: {"deg": Unit(multiply=math.pi, divide=180.0), "rad": _SI},
    Quantity.SPEED: {"mm_s": _MILLI, "cm_s": _CENTI, "m_s": _SI},
    Quantity.CURVATURE: {"1_m": _SI, "1_mm": Unit(multiply=1000.0)},
    Quantity.DURATION: {"s": _SI, "ms": _MILLI},
    Quantity.FREQUENCY: {"hz": _SI},
    Quantity.DECAY: {"per_s": _SI},
    Quantity.TURNING: {"rad_s": _SI, "rpm": Unit(multiply=math.pi, divide=30.0)},
    Quantity.FORCE: {"n": _SI},
    Quantity.STIFFNESS: {"n_m": _SI, "n_mm": Unit(multiply=1000.0)},
    Quantity.IMPEDANCE: {"n_s_m": _SI},
    Quantity.MASS: {"kg": _SI, "g": _MILLI},
    Quantity.ROTARY_DAMPING: {"n_m_s_rad": _SI},
    Quantity.INERTIA: {"kg_m2": _SI, "g_cm2": Unit(divide=1e7)},
    Quantity.MODULUS: {"gpa": Unit(multiply=1e9), "mpa": Unit(multiply=1e6), "pa": _SI},
    Quantity.DENSITY: {"kg_m3": _SI, "g_cm3": Unit(multiply=1000.0)},
    Quantity.ACCELERATION: {"m_s2": _SI},
}

Length = Annotated[float, Quantity.LENGTH]
Angle = Annotated[float, Quantity.ANGLE]
Speed = Annotated[float, Quantity.SPEED]
Curvature = Annotated[float, Quantity.CURVATURE]
Duration = Annotated[float, Quantity.DURATION]
Frequency = Annotated[float, Quantity.FREQUENCY]
Decay = Annotated[float, Quantity.DECAY]
Turning = Annotated[float, Quantity.TURNING]
Force = Annotated[float, Quantity.FORCE]
Stiffness = Annotated[float, Quantity.STIFFNESS]
Impedance = Annotated[float, Quantity.IMPEDANCE]
Mass = Annotated[float, Quantity.MASS]
RotaryDamping = Annotated[float, Quantity.ROTARY_DAMPING]
Inertia = Annotated[float, Quantity.INERTIA]
Modulus = Annotated[float, Quantity.MODULUS]
Density = Annotated[float, Quantity.DENSITY]
Acceleration = Annotated[float, Quantity.ACCELERATION]


def split_key(key: str) -> tuple[str, Quantity | None]:
    """Split a key into the field it names and the quantity that its ending tells.

    The longest ending wins: `cable_speed_mm_s` is a speed, not a duration.
    """
    endings = [(suffix, quantity) for quantity in Quantity for suffix in quantity.units]
    for suffix, quantity in sorted(endings, key=lambda ending: -len(ending[0])):
        if key.endswith(f"_{suffix}") and len(key) > len(suffix) + 1:
            return key.removesuffix(f"_{suffix}"), quantity
    return key, None


def length_unit(name: str, *, file: str, field: str) -> float:
    """Return the metres in one unit of length.

    Arguments:
        name: "m", "cm" or "mm"
        file: the file or argument that names the unit, for the message
        field: the field that names it, for the message

    Raises:
        InputError: for any other name
    """
    units = Quantity.LENGTH.units
    if name not in units:
        raise InputError(
            file=file,
            field=field,
            expected='one of "m", "cm", "mm"',
            found=f'"{name}"',
            remedy="Name the unit that the numbers in the file are in.",
        )
    return units[name].to_si(1.0)
