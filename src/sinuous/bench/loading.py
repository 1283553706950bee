"""What it takes to make a zone of a mesh file."""

import tracemalloc
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from time import process_time
from typing import TypeVar

import numpy as np
import trimesh

from sinuous.bench.result import Row
from sinuous.geometry.mesh import load_surface
from sinuous.geometry.safe_zone import SafeZone
from sinuous.geometry.surface import Surface

REPEATED = 3  # the median of so many is reported
BYTES_PER_MB = 1e6

T = TypeVar("T")


@dataclass(frozen=True, kw_only=True, eq=False)
class Loaded:
    """A zone, and what it took to get it."""

    zone: SafeZone
    row: Row


def load(mesh: trimesh.Trimesh, path: Path) -> Loaded:
    """Write the mesh to a file and make a zone of it a few times."""
    mesh.export(path)  # pyright: ignore[reportArgumentType]
    _make(path)  # kernels are loaded
    parts = np.median([_make(path)[1] for _ in range(REPEATED)], axis=0)
    tracemalloc.start()
    zone, _ = _make(path)
    peak = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    row = {
        "vertices": len(mesh.vertices),
        "triangles": len(mesh.faces),
        "load_s": float(parts[0]),
        "build_s": float(parts[1]),
        "grid_s": float(parts[2]),
        "peak_mb": peak / BYTES_PER_MB,
    }
    return Loaded(zone=zone, row=row)


def _make(path: Path) -> tuple[SafeZone, tuple[float, float, float]]:
    """As `SafeZone.load` does, with the processor time of its parts [s]."""
    surface, reading = _timed(lambda: _read(path))
    zone, building = _timed(lambda: SafeZone(surfaces=(surface,)))
    _, laying = _timed(lambda: zone.grid)
    return zone, (reading, building, laying)


def _read(path: Path) -> Surface:
    surface, _ = load_surface(path, unit="m")
    return surface


def _timed(task: Callable[[], T]) -> tuple[T, float]:
    began = process_time()
    done = task()
    return done, process_time() - began
