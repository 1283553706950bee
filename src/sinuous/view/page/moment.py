"""What the stage shows of a moment, live or recorded."""

from dataclasses import dataclass

from sinuous.arrays import Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Moment:
    """A robot in its passage. Everything is in the mesh's frame.

    Arguments:
        target: for the tip (3,) [m]
        nominal: body points of the model (S, 3) [m]
        actual: of the plant (S, 3) [m]
        tensions: of the plant's cables (C,) [N]; empty if it does not know them
        nearest: of the plant's body points, the one that is closest to a wall
        wall: the point of the wall that is closest to it (3,) [m]; nan without walls
        clearance: between the two, less the body's radius there [m]; inf without walls
        tip_force: on the operator's hand, drawn at the tip (3,) [N]
        pushed: of the model's body points, the one that walls push the most
        body_force: of the walls on that point (3,) [N]; zero if none is in the way
    """

    target: Array
    nominal: Array
    actual: Array
    tensions: Array
    nearest: int
    wall: Array
    clearance: float
    tip_force: Array
    pushed: int
    body_force: Array
