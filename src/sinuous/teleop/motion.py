"""What a virtual force may know: where the follower should be, where it is, what is in its way."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array

# Not write-protected, which would be another type to compiled code; nothing writes to it.
_ZERO = np.zeros(3)


class Plane(NamedTuple):
    """Where walls stop the tip, in the world, as a controller knew in its last step.

    Arguments:
        place: of the tip (3,) [m]
        way: from where it would be without walls to there (3,) [m]; zero if none is in the way
    """

    place: Array = _ZERO
    way: Array = _ZERO


class Walls(NamedTuple):
    """What a controller knows of walls.

    Arguments:
        held: they hold the tip back from its target
        near: the body is closer to them than it should be
    """

    held: Plane = Plane()
    near: Plane = Plane()


NO_WALLS = Walls()


class Motion(NamedTuple):
    """Where the follower should be, and where it is, on the wave side (A,).

    Arguments:
        X_sd, V_sd: desired [m], and its velocity over the last tick [m/s]
        X_s, V_s: measured [m], and its velocity over the last tick [m/s]
        held, near: walls, see `Walls`
    """

    X_sd: Array
    V_sd: Array
    X_s: Array
    V_s: Array
    held: Plane = NO_WALLS.held
    near: Plane = NO_WALLS.near
