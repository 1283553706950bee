"""Meshes for the page: with corners that are one, and not more triangles than it can turn."""

import numpy as np

from sinuous.arrays import Array, IntArray

MOST = 40_000  # triangles that are sent
FIRST = 128  # cells along the longest side to begin with


def indexed(triangles: Array) -> tuple[Array, IntArray]:
    """Vertices (V, 3) and faces (T, 3) of triangles (T, 3, 3); corners at one place are one."""
    vertices, corner = np.unique(triangles.reshape(-1, 3), axis=0, return_inverse=True)
    return vertices, corner.reshape(-1, 3).astype(np.int64)


def thinned(triangles: Array, most: int = MOST) -> tuple[Array, IntArray]:
    """As `indexed`, with at most so many triangles: vertices of a cell become their mean.

    Only for looking at: a vertex moves by less than the diagonal of a cell.
    """
    vertices, faces = indexed(triangles)
    cells = FIRST
    while len(faces) > most:
        vertices, faces = _clustered(*indexed(triangles), cells)
        cells = cells * 3 // 4
    return vertices, faces


def _clustered(vertices: Array, faces: IntArray, cells: int) -> tuple[Array, IntArray]:
    low = vertices.min(axis=0)
    size = float(np.max(np.ptp(vertices, axis=0))) / cells
    _, own, shared = np.unique(
        np.floor((vertices - low) / size), axis=0, return_inverse=True, return_counts=True
    )
    own = own.ravel()
    means = np.stack([np.bincount(own, weights=vertices[:, i]) / shared for i in range(3)], axis=1)
    merged = own[faces]
    whole = (
        (merged[:, 0] != merged[:, 1])
        & (merged[:, 1] != merged[:, 2])
        & (merged[:, 2] != merged[:, 0])
    )
    _, first = np.unique(np.sort(merged[whole], axis=1), axis=0, return_index=True)
    return means, merged[whole][np.sort(first)].astype(np.int64)
