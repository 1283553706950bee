"""`[fitted]` of a robot file: what `sinuous calibrate` found and kinematics cannot hold."""

from dataclasses import dataclass, field
from typing import Annotated, Literal

import numpy as np
from pydantic import Field

from sinuous.arrays import Array, ArrayLike
from sinuous.files import Angle, Curvature, FieldError, Length
from sinuous.robots.elastic import ElasticModel
from sinuous.robots.parts import Segment

NotNegative = Field(ge=0.0)
Positive = Field(gt=0.0)
Triple = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True, eq=False)
class Fitted:
    """What was found out about one real robot.

    Arguments:
        motors: name of the motor that pulls each cable, in the order of the robot's cables (C,)
        directions: +1 if larger readings of that motor pull, -1 if they release (C,)
        model: its statics; `model.slack` is measured in the motors' readings
        T_t_b: pose of the base in the frame of the tracker (4, 4)
    """

    motors: tuple[str, ...]
    directions: Array
    model: ElasticModel
    T_t_b: Array

    def pulls(self, readings: ArrayLike) -> Array:
        """By how much motors pull (..., C) [m] at their readings (..., C) [m]."""
        return self.directions * np.asarray(readings, dtype=float)


@dataclass(frozen=True, kw_only=True)
class FittedTable:
    """`[fitted]`, cables in the order of the robot's."""

    motors: Annotated[tuple[str, ...], Field(min_length=1)]
    directions: tuple[Literal[1, -1], ...]
    slack: tuple[Length, ...]
    hole_radius: tuple[Annotated[Length, Positive], ...]
    hole_angle: tuple[Angle, ...]
    twist: tuple[Angle, ...]
    stiffness_ratio: tuple[Annotated[float, Positive], ...]  # k / EI [1/m^3]
    friction: tuple[Annotated[Curvature, NotNegative], ...]
    rest_bend: tuple[tuple[Angle, Angle], ...]
    play: Annotated[Length, NotNegative] = 0.0
    base_position: tuple[Length, Length, Length] = (0.0, 0.0, 0.0)
    base_axes: tuple[Triple, Triple, Triple] = field(
        default=((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))
    )
    about: str = ""

    def __post_init__(self) -> None:
        axes = np.array(self.base_axes)
        if not (np.allclose(axes @ axes.T, np.eye(3), atol=1e-3) and np.linalg.det(axes) > 0.0):
            raise FieldError(
                "base_axes",
                expected="a rotation: three rows of unit length, at right angles, right-handed",
                remedy="Write the file anew with sinuous calibrate.",
            )

    def check(self, cables: int, segments: int) -> None:
        """Refuse a table that is not one of a robot with that many cables and segments."""
        each_cable = ("motors", "directions", "slack", "hole_radius", "hole_angle",
                      "stiffness_ratio")  # fmt: skip
        counts = dict.fromkeys(each_cable, cables)
        counts |= dict.fromkeys(("twist", "friction", "rest_bend"), segments)
        for name, count in counts.items():
            if len(getattr(self, name)) != count:
                each = "cable" if name in each_cable else "segment"
                raise FieldError(
                    ("fitted", name),
                    expected=f"{count} values, one for each {each}",
                    remedy="Write the file anew with sinuous calibrate.",
                )

    def part(self, segments: tuple[Segment, ...]) -> Fitted:
        """Return what the robot is built from."""
        counts = [len(segment.cable_angles) for segment in segments]
        T = np.eye(4)
        T[:3, :3], T[:3, 3] = self.base_axes, self.base_position
        around = np.stack([np.cos(self.hole_angle), np.sin(self.hole_angle)], axis=1)
        return Fitted(
            motors=self.motors,
            directions=np.array(self.directions, dtype=float),
            model=ElasticModel(
                lengths=np.array([segment.home_length for segment in segments]),
                segment=np.repeat(np.arange(len(segments)), counts),
                holes=np.array(self.hole_radius)[:, None] * around,
                twist=np.array(self.twist),
                stiffness=np.array(self.stiffness_ratio),
                slack=np.array(self.slack),
                rest=np.array(self.rest_bend),
                friction=np.array(self.friction),
                play=self.play,
            ),
            T_t_b=T,
        )
