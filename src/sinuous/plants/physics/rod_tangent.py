"""How loads on a chain of hinges change when its hinges turn.

A force F at r and a moment M, both fixed in the world, turn hinge i about its axis a_i at p_i by
Q_i = a_i . (M + (r - p_i) x F), if they act beyond it. Hinge j before it turns all of that but
the loads themselves, hinge j behind it moves r alone; with the sums over all loads beyond

    M_i = sum M + (r - p_i) x F,   D_i = sum (r - p_i) F',

dQ_i / dq_j = a_i . (D_h a_j - tr(D_h) a_j), h the later of i and j, and (a_j x a_i) . M_i more if
j comes before i. Moments that do not turn with the rod have no energy, so this has no symmetry.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray


class PointLoads(NamedTuple):
    """Loads in the world.

    Arguments:
        body: on which each acts (K,); bodies are numbered from the base, 0, to the tip
        place: where (K, 3) [m]
        force: (K, 3) [N]
        moment: (K, 3) [N m]
    """

    body: IntArray
    place: Array
    force: Array
    moment: Array


def load_stiffness(axis: Array, anchor: Array, body: IntArray, loads: PointLoads) -> Array:
    """Derivative -dQ/dq (n, n) of the moments of loads about the hinges.

    Arguments:
        axis: of the hinges, from the base to the tip (n, 3)
        anchor: of the hinges (n, 3) [m]
        body: which each hinge turns (n,), ascending
        loads: what acts
    """
    force = _beyond(loads.force, body, loads.body)
    first = _beyond(loads.place[:, :, None] * loads.force[:, None, :], body, loads.body)
    moment = _beyond(loads.moment + np.cross(loads.place, loads.force), body, loads.body)
    moment = moment - np.cross(anchor, force)
    first = first - anchor[:, :, None] * force[:, None, :]
    D = first - np.trace(first, axis1=1, axis2=2)[:, None, None] * np.eye(3)
    later = np.maximum.outer(np.arange(len(axis)), np.arange(len(axis)))
    by_row = np.einsum("ia,iab,jb->ij", axis, D, axis)  # h = i
    by_column = np.einsum("ia,jab,jb->ij", axis, D, axis)  # h = j
    turned = np.where(later == np.arange(len(axis))[:, None], by_row, by_column)
    return np.tril(np.cross(moment, axis) @ axis.T, -1) - turned


def _beyond(values: Array, hinges: IntArray, bodies: IntArray) -> Array:
    """Sums of values (K, ...) at bodies (K,) over all bodies that each hinge (n,) turns."""
    total = np.zeros((int(hinges[-1]) + 2, *values.shape[1:]))
    np.add.at(total, bodies, values)
    return np.cumsum(total[::-1], axis=0)[::-1][hinges]
