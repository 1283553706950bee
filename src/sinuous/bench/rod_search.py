"""Finding the shape at rest that a file speaks of."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial.transform import Rotation, Slerp

from sinuous.arrays import Array
from sinuous.bench.rod_file import RodShape
from sinuous.plants.physics.rod_statics import BareRod, Equilibrium

OTHER = 0.02  # of the length: a shape so far from that in the file may be another one at rest
FAILED = 1.0  # error of a shape that was not found, of the length


@dataclass(frozen=True, kw_only=True, eq=False)
class Found:
    """What came of one shape.

    Arguments:
        name: in the file
        points: at the stations (K, 3) [m]
        error: distances to those of the file (K,), by the length of the rod
        straight_error: the same for the shape into which the straight rod bends
        converged: whether it is at rest
        other: whether the straight rod came to rest elsewhere
        steps: of Newton's method
    """

    name: str
    points: Array
    error: Array
    straight_error: Array
    converged: bool
    other: bool
    steps: int


def find(bare: BareRod, arcs: Array, shape: RodShape) -> Found:
    """Let the loads grow on a straight rod; if that leads elsewhere, look near the file's shape.

    A rod can have several shapes at rest under the same loads, and a file tells one of them.
    Which of them the straight rod bends into depends on how the loads grow, of which it tells
    nothing.
    """
    first = bare.at_rest(shape.load)
    straight = _error(bare, arcs, shape, first)
    chosen, steps = first, first.iterations
    if not first.converged or np.max(straight) > OTHER:
        near = bare.near(shape.load, _guess(bare, arcs, shape))
        steps += near.iterations
        if near.converged and np.max(_error(bare, arcs, shape, near)) < np.max(straight):
            chosen = near
    return Found(
        name=shape.name,
        points=bare.points(chosen, arcs),
        error=_error(bare, arcs, shape, chosen),
        straight_error=straight,
        converged=chosen.converged,
        other=chosen is not first,
        steps=steps,
    )


def _error(bare: BareRod, arcs: Array, shape: RodShape, found: Equilibrium) -> Array:
    """Distances of the stations (K,) by the length; FAILED where nothing was found."""
    if not found.converged:
        return np.full(len(arcs), FAILED)
    return np.linalg.norm(bare.points(found, arcs) - shape.points, axis=1) / bare.length


def _guess(bare: BareRod, arcs: Array, shape: RodShape) -> Array:
    """Angles (n,) [rad] of the hinges nearly as the file's frames turn."""
    known, first = np.unique(np.concatenate([[0.0], arcs]), return_index=True)
    frames = np.concatenate([np.eye(3)[None], shape.frames])[first]
    cuts = np.linspace(0.0, bare.length, bare.links + 1)
    turning = Slerp(known, Rotation.from_matrix(frames))
    return bare.angles_of(turning(np.clip(cuts, known[0], known[-1])).as_matrix())
