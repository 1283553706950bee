"""Targets that sweep past outside zones that are not convex."""

from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from trimesh.transformations import rotation_matrix

from sinuous.arrays import Array, ArrayLike
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.papers.hachen2025.undisturbed import DT, FREE, Place, place

SPEED = 0.01  # of the target [m/s]
HOLD = 3.0  # before the sweep and after it, and at every way-point [s]

CHAMBER = (0.2, 0.2, 0.45)  # [m]
RIDGE = 0.06  # side of a square bar that reaches into it edge first [m]
RIDGE_HEIGHT = 0.29  # of its middle [m]
MARGIN = 0.003  # [m]


@dataclass(frozen=True, kw_only=True, eq=False)
class Sweep:
    """A target that first leads the tip somewhere and then moves along a line.

    Arguments:
        here: robot and zone
        before: targets (B, 3) [m] until the tip rests beside the beginning of the line
        line: targets (K, 3) [m] on the line, and held at its end
    """

    here: Place
    before: Array
    line: Array


def _past_the_centre() -> Sweep:
    """Inside the arch of the inverted U, 5 mm above the centre that it bends about."""
    return _in_the_arch(height=0.050)


def _between_the_legs() -> Sweep:
    """Between the legs of the inverted U: either leg is the nearest one."""
    return _in_the_arch(height=0.030)


def _across_a_ridge() -> Sweep:
    """Through a ridge that reaches into a chamber, from one of its faces to the other."""
    return _sweep(_chamber(), [], (-0.025, 0.0, 0.260), (0.025, 0.0, 0.260))


SWEEPS: dict[str, Callable[[], Sweep]] = {
    "past the centre of an arch": _past_the_centre,
    "between the legs of a U": _between_the_legs,
    "through a ridge": _across_a_ridge,
}


def _in_the_arch(height: float) -> Sweep:
    over = [(0.0158, 0.0, 0.0805), (0.0478, 0.0, 0.0927), (0.0797, 0.0, 0.0804)]
    return _sweep(place("inverted_u"), over, (0.070, 0.0, height), (0.025, 0.0, height))


def _sweep(here: Place, stops: list[tuple[float, ...]], start: ArrayLike, end: ArrayLike) -> Sweep:
    a, b = np.array(start), np.array(end)
    steps = round(float(np.linalg.norm(b - a)) / SPEED / DT)
    held = round(HOLD / DT)
    return Sweep(
        here=here,
        before=np.repeat([*map(np.array, stops), a], held, axis=0),
        line=np.concatenate([np.linspace(a, b, steps + 1)[1:], np.tile(b, (held, 1))]),
    )


@lru_cache
def _chamber() -> Place:
    """A box with the ridge above the robot."""
    robot = place(FREE).robot
    turned = rotation_matrix(np.pi / 4.0, [0.0, 1.0, 0.0])
    turned[2, 3] = RIDGE_HEIGHT
    ridge = shapes.box([RIDGE, 1.5 * CHAMBER[1], RIDGE])
    ridge.apply_transform(turned)
    room = SafeZone.from_mesh(shapes.box(CHAMBER, centre=[0.0, 0.0, 0.1]))
    zone = room.minus(ridge, name="ridge")
    return Place(robot=robot, zone=zone, start=robot.home, margin=MARGIN)
