"""Files of rod shapes at rest: what acts on a clamped rod, and where its points come to lie.

Two header rows, then six rows for each shape; docs/validation.md has the format. In the file the
straight rod lies along x. Here it stands along z, as all robots do.
"""

import csv
import math
from dataclasses import dataclass
from itertools import pairwise
from pathlib import Path

import numpy as np
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.files import read_text
from sinuous.plants.physics.rod_statics import Load

QUANTITIES = ("EulX", "EulY", "EulZ", "Px", "Py", "Pz")
LOADS = ("gravity", "mid_wrench", "tip_wrench")
HALVES = ("seg1_", "seg2_")
FROM_FILE = np.array([[0.0, 0.0, 1.0], [0.0, -1.0, 0.0], [1.0, 0.0, 0.0]])  # x to z
STRETCH = 1.02  # most that a line through the stations may be longer than the rod
COILED = 0.5  # and least, as long as it is one: a rod would have to be coiled up


@dataclass(frozen=True, kw_only=True, eq=False)
class RodShape:
    """One shape at rest in a frame whose z the clamped end points along.

    Arguments:
        name: in the file
        load: what acts
        points: at the stations (K, 3) [m]
        frames: orientations at the stations (K, 3, 3), z along the rod
    """

    name: str
    load: Load
    points: Array
    frames: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class RodFile:
    """Shapes of one rod.

    Arguments:
        arcs: arc lengths of the stations (K,) [m]
        shapes: all of them
    """

    arcs: Array
    shapes: tuple[RodShape, ...]


def read_rod_file(path: str | Path, *, length: float) -> RodFile:
    """Return the shapes in a CSV file.

    Arguments:
        path: of the file
        length: of the rod [m]

    Raises:
        InputError: naming row and column, if something is missing or no number, or if the
            positions cannot be those of a rod of that length
    """
    table = _Table(file=str(path), length=length)
    rows = list(csv.reader(read_text(path).splitlines()))
    while rows and not any(cell.strip() for cell in rows[-1]):
        rows.pop()
    return table.read([[cell.strip() for cell in row] for row in rows])


@dataclass(frozen=True, kw_only=True)
class _Table:
    """Where the text comes from, and how long the rod is said to be."""

    file: str
    length: float

    def read(self, rows: list[list[str]]) -> RodFile:
        if len(rows) < 2:
            raise self._error("", "two header rows and six rows for each shape", "less")
        columns, stations = self._columns(rows[0])
        arcs = self._arcs(rows[0], rows[1], stations)
        body = rows[2:]
        if not body or len(body) % len(QUANTITIES):
            raise self._error(
                "",
                f"two header rows and {len(QUANTITIES)} rows for each shape",
                f"{len(body)} rows after the header",
                "Are rows missing at the end, or is there a third header row?",
            )
        shapes = [
            self._shape(rows[0], columns, stations, start, body[start : start + len(QUANTITIES)])
            for start in range(0, len(body), len(QUANTITIES))
        ]
        self._check_scale(arcs, shapes)
        return RodFile(arcs=arcs, shapes=tuple(shapes))

    # --- header --------------------------------------------------------------------------

    def _columns(self, header: list[str]) -> tuple[list[int], list[list[int]]]:
        """Indices of the loads, and of the stations of each half."""
        for name in LOADS:
            if header.count(name) != 1:
                raise self._error("row 1", f"one column {name}", f"{header.count(name)}")
        stations = [[i for i, n in enumerate(header) if n.startswith(half)] for half in HALVES]
        for half, found in zip(HALVES, stations, strict=True):
            if not found:
                raise self._error("row 1", f"columns whose names start with {half}", "none")
        return [header.index(name) for name in LOADS], stations

    def _arcs(self, header: list[str], row: list[str], stations: list[list[int]]) -> Array:
        """Arc lengths of all stations [m], of which the file tells the share of each half."""
        arcs = list[float]()
        for number, half in enumerate(stations):
            shares = [self._number(2, header, row, column) for column in half]
            inside = all(0.0 <= share <= 1.0 for share in shares)
            if not inside or any(b <= a for a, b in pairwise(shares)):
                raise self._error(
                    f"row 2, columns {HALVES[number]}...",
                    "arc lengths that increase from 0 to 1 along each half",
                    ", ".join(f"{share:g}" for share in shares),
                    "Divide the arc lengths in each half by its length.",
                )
            arcs += [0.5 * self.length * (number + share) for share in shares]
        return np.array(arcs)

    # --- shapes --------------------------------------------------------------------------

    def _shape(
        self,
        header: list[str],
        loads: list[int],
        stations: list[list[int]],
        start: int,
        rows: list[list[str]],
    ) -> RodShape:
        first = start + 3  # rows are counted from 1, and two are the header
        names = [row[0] if row else "" for row in rows]
        shape = names[0].partition("_")[2]
        for offset, (quantity, name) in enumerate(zip(QUANTITIES, names, strict=True)):
            if name != f"{quantity}_{shape}":
                raise self._error(
                    f"row {first + offset}",
                    f'"{quantity}_{shape}", for each shape come {", ".join(QUANTITIES)}',
                    f'"{name}"',
                )
        columns = [*loads, *stations[0], *stations[1]]
        values = np.array(
            [
                [self._number(first + offset, header, row, column) for column in columns]
                for offset, row in enumerate(rows)
            ]
        )
        angular, linear = values[:3], FROM_FILE @ values[3:]
        frames = Rotation.from_euler("XYZ", angular[:, len(loads) :].T).as_matrix()
        return RodShape(
            name=shape,
            load=Load(
                gravity=linear[:, 0],
                forces=linear[:, 1:3].T,
                moments=(FROM_FILE @ angular[:, 1:3]).T,
            ),
            points=linear[:, len(loads) :].T,
            frames=FROM_FILE @ frames @ FROM_FILE.T,
        )

    def _check_scale(self, arcs: Array, shapes: list[RodShape]) -> None:
        """Refuse positions that belong to a rod of another length, or other units."""
        for number, shape in enumerate(shapes):
            line = float(np.sum(np.linalg.norm(np.diff(shape.points, axis=0), axis=1)))
            reach = float(np.linalg.norm(shape.points[0])) + line
            share = reach / float(arcs[-1])
            if not COILED < share < STRETCH:
                first = 3 + len(QUANTITIES) * number
                raise self._error(
                    f"rows {first + 3} to {first + 5}",
                    f"positions of a rod of {arcs[-1]:g} m up to the last station",
                    f"a line through them of {reach:.4g} m",
                    "Correct --length, or give positions in metres.",
                )

    def _number(self, row: int, header: list[str], cells: list[str], column: int) -> float:
        text = cells[column] if column < len(cells) else ""
        where = f"row {row}, column {header[column]}"
        try:
            value = float(text)
        except ValueError:
            raise self._error(where, "a number", f'"{text}"' if text else "nothing") from None
        if not math.isfinite(value):
            raise self._error(where, "a finite number", text)
        return value

    def _error(
        self, where: str, expected: str, found: str, remedy: str = "Correct or remove that shape."
    ) -> InputError:
        return InputError(
            file=self.file, field=where, expected=expected, found=found, remedy=remedy
        )
