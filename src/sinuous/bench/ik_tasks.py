"""What `sinuous bench ik` asks for: targets all over the disc, and straight paths through it."""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.control.geometric_ik import CHI, GeometricIK

SEED = 2020
STEP = 1e-3  # of a path [m]
TARGETS, QUICK_TARGETS = 1000, 20
PATHS, QUICK_PATHS, QUICK_POINTS = 12, 1, 20


@dataclass(frozen=True, kw_only=True, eq=False)
class IKTasks:
    """Targets in the plane of the representative chi.

    Arguments:
        targets: spread evenly over the disc (T, 3) [m]
        paths: each (K, 3) [m]; straight, between two points of the disc
        start: the reference pose (n,)
    """

    targets: Array
    paths: tuple[Array, ...]
    start: Array


def draw_tasks(ik: GeometricIK, quick: bool) -> IKTasks:
    """The same on every machine."""
    rng = np.random.default_rng(SEED)
    targets, paths = (QUICK_TARGETS, QUICK_PATHS) if quick else (TARGETS, PATHS)
    points = QUICK_POINTS if quick else None
    return IKTasks(
        targets=ik.on_plane(_in_disc(rng, ik.radius(CHI), targets), CHI),
        paths=tuple(straight_path(ik, rng, STEP)[:points] for _ in range(paths)),
        start=ik.reference(CHI),
    )


def straight_path(ik: GeometricIK, rng: np.random.Generator, step: float) -> Array:
    """Targets (K, 3) [m], a step [m] apart, from one random point of the disc towards another."""
    first, last = ik.on_plane(_in_disc(rng, ik.radius(CHI), 2), CHI)
    length = float(np.linalg.norm(last - first))
    return first + (last - first) * np.arange(0.0, length, step)[:, None] / length


def _in_disc(rng: np.random.Generator, radius: float, count: int) -> Array:
    r = radius * np.sqrt(rng.uniform(size=count))
    angle = rng.uniform(0.0, 2.0 * np.pi, count)
    return np.stack([r * np.cos(angle), r * np.sin(angle)], axis=1)
