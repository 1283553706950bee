"""The format of robot files with modules: millimetres and degrees, and what they must obey."""

from dataclasses import dataclass, field
from math import degrees
from typing import Annotated

from pydantic import Field

from sinuous.files import Angle, FieldError, Inertia, Length, Mass, RotaryDamping
from sinuous.robots.jointed import ROUNDING, JointedRobot, contact_bend
from sinuous.robots.jointed_kernels import CABLES
from sinuous.robots.mechanics import JointedMechanics
from sinuous.robots.mechanics_tables import CablePhysicsTable, NotNegative
from sinuous.robots.parts import JointOrder, SpeedLimits
from sinuous.robots.robot_tables import (
    LimitsTable,
    Positive,
    Ranges,
    RobotTable,
    check_ranges,
    one_each,
)


@dataclass(frozen=True, kw_only=True)
class ModulesTable:
    """`[modules]`: all alike, each a universal joint and a tube between two plates behind it."""

    count: Annotated[int, Field(ge=1)]
    holes: Annotated[int, Field(ge=CABLES)]  # in every plate, evenly spaced
    radius: Annotated[Length, Positive]
    plate_offset: Annotated[Length, Positive]  # from a plate to the centre of the joint beside it
    tube_length: Annotated[Length, Positive]
    joint_order: JointOrder | tuple[JointOrder, ...] = JointOrder.ZX  # of all, or of each
    max_bend: Annotated[Angle, Positive] | None = None

    def __post_init__(self) -> None:
        needed = CABLES * self.count
        if self.holes % CABLES or self.holes < needed:
            raise FieldError(
                "holes",
                expected=f"a multiple of {CABLES} and at least {needed}, {CABLES} for the cables "
                f"of each of {self.count} modules",
                remedy="Take more holes or fewer modules: cables that share a hole would rub.",
            )
        if len(self.orders) != self.count:
            raise FieldError(
                "joint_order",
                expected=f"one order, or {self.count}, one for each joint",
                remedy="Give as many orders as modules.",
            )
        contact = contact_bend(self.radius, self.plate_offset)
        if self.max_bend is not None and self.max_bend > contact + ROUNDING:
            raise FieldError(
                "max_bend",
                expected=f"at most {degrees(contact):.4g} degrees, where the plates of this "
                "radius and offset touch",
                remedy="Reduce it, or leave it out for that bend.",
            )

    @property
    def orders(self) -> tuple[JointOrder, ...]:
        """In which every joint turns."""
        one = self.joint_order
        return one if isinstance(one, tuple) else (one,) * self.count

    @property
    def bend_limit(self) -> float:
        """Largest bend of a joint [rad]: the stated one, or where plates touch."""
        contact = contact_bend(self.radius, self.plate_offset)
        return contact if self.max_bend is None else min(self.max_bend, contact)

    @property
    def cables_at_home(self) -> list[float]:
        """Length [m] of every module's cables in the straight robot."""
        one = self.tube_length + 2.0 * self.plate_offset
        return [k * one for k in range(1, self.count + 1)]


@dataclass(frozen=True, kw_only=True)
class JointedLimitsTable(LimitsTable):
    """`[limits.NAME]` of a robot of modules."""

    cable_length: Ranges | None = None  # by default the bends alone bound them


@dataclass(frozen=True, kw_only=True)
class JointedPhysicsTable(CablePhysicsTable):
    """`[physics]` of a robot of modules: all of it is for physics plants only."""

    module_mass: Annotated[Mass, Positive] = JointedMechanics.module_mass
    joint_damping: Annotated[RotaryDamping, NotNegative] = JointedMechanics.joint_damping
    joint_armature: Annotated[Inertia, NotNegative] = JointedMechanics.joint_armature

    @property
    def mechanics(self) -> JointedMechanics:
        """What the robot is built from."""
        return JointedMechanics(
            cables=self.cables,
            module_mass=self.module_mass,
            joint_damping=self.joint_damping,
            joint_armature=self.joint_armature,
        )


@dataclass(frozen=True, kw_only=True)
class JointedTable(RobotTable):
    """A robot file with modules."""

    modules: ModulesTable
    limits: Annotated[dict[str, JointedLimitsTable], Field(min_length=1)]
    physics: JointedPhysicsTable = field(default_factory=JointedPhysicsTable)

    def __post_init__(self) -> None:
        self.check_insertion(self.limits)
        for name, limits in self.limits.items():
            if limits.cable_length is not None:
                place, homes = ("limits", name, "cable_length"), self.modules.cables_at_home
                check_ranges(
                    place,
                    limits.cable_length,
                    homes,
                    part="module",
                    causes="the plate offset or the tube length",
                )

    def robot(self, limits: str) -> JointedRobot:
        """Return the robot with these limits."""
        chosen, modules = self.limits[limits], self.modules
        ranges = chosen.cable_length
        return JointedRobot(
            name=self.name,
            joints=modules.count,
            holes=modules.holes,
            radius=modules.radius,
            plate_offset=modules.plate_offset,
            tube_length=modules.tube_length,
            orders=modules.orders,
            bend_limit=modules.bend_limit,
            cable_lengths=() if ranges is None else tuple(one_each(ranges, modules.count)),
            speed=SpeedLimits(cable=chosen.cable_speed, insertion=chosen.insertion_speed or 0.0),
            insertion=self.insertion and self.insertion.part,
            tool=self.tool and self.tool.part,
            spacing=self.guard_spacing,
            mechanics=self.physics.mechanics,
        )
