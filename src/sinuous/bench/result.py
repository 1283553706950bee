"""What a benchmark found: tables for people and programs, and how it was found."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import cast

Row = Mapping[str, object]


@dataclass(frozen=True, kw_only=True)
class Column:
    """A column on the screen.

    Arguments:
        key: of the row
        title: in the table's head
        form: of a number, such as ".3f"; other values are shown as they are
    """

    key: str
    title: str
    form: str = ""

    def text(self, row: Row) -> str:
        """What the cell of a row says; a dash where nothing was measured."""
        value = row.get(self.key)
        if value is None or (isinstance(value, float) and not math.isfinite(value)):
            return "-"
        return format(value, self.form) if isinstance(value, int | float) else str(value)


@dataclass(frozen=True, kw_only=True)
class Table:
    """Rows with the same keys.

    Arguments:
        name: its key in the JSON file
        title: above it on the screen
        columns: those that are shown; the JSON file holds all keys
        rows: numbers carry their unit in the key
    """

    name: str
    title: str
    columns: tuple[Column, ...]
    rows: Sequence[Row]


@dataclass(frozen=True, kw_only=True)
class Result:
    """A benchmark's answer.

    Arguments:
        what: its name on the command line
        tables: in the order in which to read them
        about: scene, settings, versions, machine and whatever else belongs to the numbers
        notes: sentences for the screen
    """

    what: str
    tables: tuple[Table, ...]
    about: Mapping[str, object] = field(default_factory=dict[str, object])
    notes: tuple[str, ...] = ()

    def table(self, name: str) -> Table:
        """The table of that name."""
        return next(table for table in self.tables if table.name == name)

    def as_json(self) -> str:
        """All of it as one JSON object; what is not a finite number is null."""
        tables = {table.name: list(table.rows) for table in self.tables}
        whole = {"what": self.what, **tables, **self.about, "notes": list(self.notes)}
        return json.dumps(plain(whole), indent=1, allow_nan=False) + "\n"


def plain(value: object) -> object:
    """The same in JSON's types, with None for what is not finite."""
    if isinstance(value, Mapping):
        pairs = cast(Mapping[object, object], value).items()
        return {str(key): plain(each) for key, each in pairs}
    if isinstance(value, list | tuple):
        return [plain(each) for each in cast(Sequence[object], value)]
    if isinstance(value, bool | int | str) or value is None:
        return value
    if isinstance(value, float):
        return float(value) if math.isfinite(value) else None
    return str(value)
