"""The cables of a jointed robot: three to every module, each through its own hole in all plates."""

import numpy as np

from sinuous.arrays import Array
from sinuous.robots.jointed_kernels import CABLES
from sinuous.robots.parts import JointOrder
from sinuous.robots.routing import Routing


def hole_angles(modules: int, holes: int) -> Array:
    """Angles about y, from x towards z, of the holes of every module's cables (N, 3) [rad] (4).

    A cable keeps its hole: alpha_kj of (4) belongs to cable j of module k in every plate that it
    passes, and not to the plate (notes A1).
    """
    module, cable = np.arange(1, modules + 1), np.arange(CABLES)
    return 2.0 * np.pi * (module[:, None] / holes + cable / CABLES)


def hole_offsets(angles: Array, radius: float) -> Array:
    """Where the holes are in the plane of a plate (..., 3) [m] (5)."""
    return radius * np.stack([np.cos(angles), np.zeros_like(angles), np.sin(angles)], axis=-1)


def route(
    *, holes: Array, plate_offset: float, tube_length: float, orders: tuple[JointOrder, ...],
    first_column: int,
) -> Routing:  # fmt: skip
    """The cables (7): module k's pass the joints 1 to k and as many tubes, to its rear endplate.

    Arguments:
        holes: of every module's cables (N, 3, 3) [m]
        plate_offset: D [m]
        tube_length: H [m]
        orders: of the joints (N,)
        first_column: of the first joint's angles; a column before is an insertion stage
    """
    modules, n = len(orders), first_column + 2 * len(orders)
    module = np.repeat(np.arange(1, modules + 1), CABLES)  # of every cable
    joint = np.concatenate([np.arange(k) for k in module])  # of every crossing
    hole = np.repeat(holes.reshape(-1, 3), module, axis=0)
    half = np.array([0.0, plate_offset, 0.0])
    A = np.zeros((first_column + len(module), n))
    A[:first_column, :first_column] = np.eye(first_column)
    b = np.zeros(len(A))
    b[first_column:] = tube_length * module
    return Routing(
        A=A,
        b=b,
        first=np.concatenate([np.zeros(first_column + 1), np.cumsum(module)]).astype(np.int64),
        column=first_column + 2 * joint,
        axes=np.array([order.axes for order in orders])[joint],
        before=half - hole,
        after=half + hole,
    )
