"""A body as many copies of one cylinder: disks, the backbone between them, rigid tubes."""

from dataclasses import dataclass
from typing import NamedTuple, Self

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.recording import Header
from sinuous.view.page.frames import towards

AROUND = 32  # corners of a cross-section
CORE = 0.32  # radius of the backbone between disks, as a share of theirs
THICKNESS = 0.22  # of a disk, as a share of the distance to the next
SLIM = 0.93  # of a tube beside its end plates, so that cables in its wall can be seen
PLATE = 0.06  # thickness of an end plate, as a share of its radius


class Placed(NamedTuple):
    """Where the cylinders are: centres (M, 3) [m], w-first quaternions (M, 4), sizes (M, 3) [m]."""

    centres: Array
    turns: Array
    sizes: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class Cylinders:
    """Which cylinders make a body: stretches between points first, then disks.

    Arguments:
        slim: radius of every stretch (S - 1,) [m]
        rigid: whether it is one of a tube (S - 1,)
        disks: at which points disks are (D,)
        wide: their radii (D,) [m]
        thick: their thicknesses (D,) [m]
    """

    slim: Array
    rigid: BoolArray
    disks: IntArray
    wide: Array
    thick: Array

    @classmethod
    def of(cls, header: Header, points: Array) -> Self:
        """Those of a recorded body, given its points (S, 3) [m]."""
        radii, disks = header.radii, header.disk_indices
        share, rigid = np.ones(len(radii) - 1), np.zeros(len(radii) - 1, dtype=bool)
        if len(disks) > 1:
            before = 2 * disks[0] - disks[1]
            share[max(before, 0) : disks[-1]] = CORE
        for first, last in header.tubes:
            share[first:last], rigid[first:last] = SLIM, True
        gaps = np.linalg.norm(np.diff(points[disks], axis=0), axis=1)
        thick = np.full(len(disks), THICKNESS * float(np.mean(gaps)) if len(gaps) else 0.0)
        on_tube = np.isin(disks, header.tubes.ravel())
        thick[on_tube] = PLATE * radii[disks][on_tube]
        return cls(
            slim=np.minimum(radii[1:], radii[:-1]) * share,
            rigid=rigid,
            disks=disks,
            wide=radii[disks],
            thick=thick,
        )

    def placed(self, points: Array, along: Array) -> Placed:
        """Where they are on a body with those points and directions (S, 3)."""
        steps = np.diff(points, axis=0)
        lengths = np.linalg.norm(steps, axis=1)
        chords = steps / np.maximum(lengths, 1e-12)[:, None]
        return Placed(
            np.concatenate([0.5 * (points[1:] + points[:-1]), points[self.disks]]),
            towards(np.concatenate([chords, along[self.disks]])),
            np.concatenate(
                [
                    np.column_stack([self.slim, self.slim, lengths]),
                    np.column_stack([self.wide, self.wide, self.thick]),
                ]
            ),
        )


def cylinder() -> tuple[Array, IntArray]:
    """Vertices and faces of a cylinder about z, of radius 1 and length 1, with sharp edges."""
    angle = 2.0 * np.pi * np.arange(AROUND) / AROUND
    ring = np.column_stack([np.cos(angle), np.sin(angle)])
    low = np.column_stack([ring, np.full(AROUND, -0.5)])
    high = low + (0.0, 0.0, 1.0)
    centres = np.array([[0.0, 0.0, -0.5], [0.0, 0.0, 0.5]])
    i = np.arange(AROUND)
    j, n = (i + 1) % AROUND, AROUND
    wall = np.concatenate(
        [np.column_stack([i, j, n + j]), np.column_stack([i, n + j, n + i])]
    )  # caps have vertices of their own, so that their edges stay sharp
    bottom = np.column_stack([np.full(n, 4 * n), 2 * n + j, 2 * n + i])
    top = np.column_stack([np.full(n, 4 * n + 1), 3 * n + i, 3 * n + j])
    return np.concatenate([low, high, low, high, centres]), np.concatenate([wall, bottom, top])
