"""Compiled poses of a chain: of its tip and of its links, alone or with the guarded points.

Notation as in `chain_kernels`.
"""

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner, kernel
from sinuous.robots.chain_kernels import Chain, frames, points_of


@inner
def write_pose(m: int, R: Array, p: Array, T: Array) -> None:
    """Write frame m as a pose (4, 4)."""
    for i in range(3):
        for j in range(3):
            T[i, j] = R[m, i, j]
        T[i, 3] = p[m, i]
        T[3, i] = 0.0
    T[3, 3] = 1.0


@kernel
def poses_batch(chain: Chain, T_w_b: Array, c: Array, starts: IntArray, out: Array) -> None:
    """Poses (B, K, 4, 4) of the frames where the sections `starts` (K,) start.

    The number of sections stands for the frame after the last of them.
    """
    sections = chain.theta_column.size
    R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
    for b in range(c.shape[0]):
        frames(chain, T_w_b, c[b], R, p)
        for k in range(starts.size):
            write_pose(starts[k], R, p, out[b, k])


@kernel
def shapes_batch(chain: Chain, T_w_b: Array, c: Array, points: Array, tips: Array) -> None:
    """Points (B, S, 3) and tip poses (B, 4, 4) of configurations (B, n)."""
    sections = chain.theta_column.size
    R, p = np.empty((sections + 1, 3, 3)), np.empty((sections + 1, 3))
    for b in range(c.shape[0]):
        frames(chain, T_w_b, c[b], R, p)
        points_of(chain, c[b], R, p, points[b])
        write_pose(sections, R, p, tips[b])
