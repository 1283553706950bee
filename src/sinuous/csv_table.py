"""Columns of numbers with units in their names, such as `t_s,x_mm`, from CSV text to SI."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.explain import one_of
from sinuous.quantities import Quantity, Unit


def read_columns(
    text: str, *, file: str, columns: Mapping[str, Quantity], example: str
) -> dict[str, Array]:
    """Return columns (K,) in SI, by their names without units.

    Columns may be in any order; others are passed over. The first of those named is the time,
    which increases.

    Arguments:
        text: of the file
        file: where it comes from, for messages
        columns: names without units, and what they measure
        example: a header, for messages

    Raises:
        InputError: naming row and column, if something is missing, not a finite number, or the
            time does not increase
    """
    table = _Table(file=file, example=example)
    rows = [(row, line.split(",")) for row, line in enumerate(text.splitlines(), 1) if line.strip()]
    if not rows:
        raise table.error("", "a header and rows of numbers", "an empty file")
    header = [cell.strip() for cell in rows[0][1]]
    found = [table.column(header, name, quantity) for name, quantity in columns.items()]
    if len(rows) == 1:
        raise table.error("", "at least one row of numbers", "only a header")
    values = np.array(
        [
            [table.number(row, cells, header[index], index, unit) for index, unit in found]
            for row, cells in rows[1:]
        ]
    )
    late = np.flatnonzero(np.diff(values[:, 0]) <= 0.0)
    if late.size:
        (row, cells), index = rows[int(late[0]) + 2], found[0][0]
        where = f"row {row}, column {header[index]}"
        raise table.error(where, "a time after the one before", cells[index].strip())
    return {name: values[:, k].copy() for k, name in enumerate(columns)}


@dataclass(frozen=True, kw_only=True)
class _Table:
    """Where the text comes from, and what its header may look like."""

    file: str
    example: str

    def column(self, header: list[str], name: str, quantity: Quantity) -> tuple[int, Unit]:
        """Return the index and the unit of a column."""
        keys = quantity.keys(name)
        found = [index for index, cell in enumerate(header) if cell in keys]
        if len(found) != 1:
            raise InputError(
                file=self.file,
                field="row 1",
                expected=f"one column {one_of(keys)}",
                found=f"the columns {', '.join(header)}",
                remedy=f"Name the columns in the first row, like {self.example}.",
            )
        return found[0], quantity.units[header[found[0]].removeprefix(f"{name}_")]

    def number(self, row: int, cells: list[str], column: str, index: int, unit: Unit) -> float:
        """Return a cell in SI."""
        where = f"row {row}, column {column}"
        text = cells[index].strip() if index < len(cells) else ""
        try:
            value = unit.to_si(float(text))
        except ValueError:
            raise self.error(where, "a number", f'"{text}"' if text else "nothing") from None
        if not math.isfinite(value):
            raise self.error(where, "a finite number", text)
        return value

    def error(self, where: str, expected: str, found: str) -> InputError:
        """Return what is wrong, with advice."""
        remedy = (
            "Correct or remove that row."
            if where
            else f"Write a header like {self.example} and a row for each point."
        )
        return InputError(
            file=self.file, field=where, expected=expected, found=found, remedy=remedy
        )
