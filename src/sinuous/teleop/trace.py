"""Delays as they were recorded on a real network."""

import math
from bisect import bisect_right
from dataclasses import dataclass
from pathlib import Path
from typing import Self

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.explain import one_of
from sinuous.files import read_text
from sinuous.quantities import Quantity, Unit
from sinuous.teleop.checks import positive
from sinuous.teleop.impaired import Course, Delays

EXAMPLE = "t_s,delay_ms"
_NUMBER = "number"
_ROUNDING = 1e-9  # of times that are sums of ticks [s]


@dataclass(frozen=True, kw_only=True, eq=False)
class Trace:
    """Every packet fares as the last one that was recorded at or before its time of sending.

    At its end a recording begins anew, one mean spacing after its last packet. Its delays come on
    top of those before it.

    Arguments:
        times: of sending, increasing (K,) [s]
        delays: (K,) [s]; nan for a packet that was lost

    Raises:
        ValueError: if there is no packet, shapes differ, times do not increase, or a delay is
            negative or infinite
    """

    times: Array
    delays: Array

    def __post_init__(self) -> None:
        times, delays = (np.array(v, dtype=np.float64) for v in (self.times, self.delays))
        if times.ndim != 1 or times.shape != delays.shape or not times.size:
            raise ValueError("times and delays must be as many, one or more")
        if not np.all(np.isfinite(times)) or np.any(np.diff(times) <= 0.0):
            raise ValueError("times must be finite and increase")
        if np.any(delays < 0.0) or np.any(np.isinf(delays)):
            raise ValueError("delays must be zero or more, or nan for a lost packet")
        object.__setattr__(self, "times", times - times[0])
        object.__setattr__(self, "delays", delays)

    @classmethod
    def load(cls, path: str | Path, *, period: float = 1e-3) -> Self:
        """A recording from a CSV file.

        Its header names the time of sending or the number of a packet, and the delay, with units:
        `t_s,delay_ms` or `number,delay_ms`. Rows are in that order. A packet without a delay was
        lost; so was one whose number is missing. Other columns are passed over.

        Arguments:
            period: from packet to packet, for a file with numbers [s]

        Raises:
            InputError: naming row and column, if something is missing, not a number, or in the
                wrong order
            ValueError: if the period is not positive
        """
        positive("period", period)
        (_, header), *rows = _cells(str(path), read_text(path))
        table = _Table(file=str(path), header=header)
        first, unit = table.clock()
        column, delay_unit = table.find("delay", Quantity.DURATION)
        if not rows:
            raise table.error("", "a row for each packet", "only a header")
        times, delays = list[float](), list[float]()
        for row, cells in rows:
            time = table.number(row, cells, first, unit)
            if times and time <= times[-1]:
                raise table.error(
                    f"row {row}, column {header[first]}",
                    "more than in the row before",
                    cells[first],
                )
            times.append(time)
            delays.append(table.delay(row, cells, column, delay_unit))
        if header[first] == _NUMBER:
            return cls._numbered(times, delays, period)
        return cls(times=np.array(times), delays=np.array(delays))

    @classmethod
    def _numbered(cls, numbers: list[float], delays: list[float], period: float) -> Self:
        """A recording by number, with a lost packet put in at the beginning of every gap."""
        every = list[tuple[float, float]]()
        for number, delay in zip(numbers, delays, strict=True):
            if every and number > every[-1][0] + 1.0:
                every.append((every[-1][0] + 1.0, math.nan))
            every.append((number, delay))
        places, found = np.array(every).T
        return cls(times=period * (places - places[0]), delays=found)

    @property
    def length(self) -> float:
        """Time after which it begins anew [s]; a single packet stands for all times."""
        return float(self.times[-1] * len(self.times) / max(len(self.times) - 1, 1))

    def open(self, rng: np.random.Generator) -> Course:
        """Its course in one run, which is no matter of luck."""
        times, delays, length = self.times.tolist(), self.delays.tolist(), self.length

        def course(time: float, copies: Delays) -> Delays:
            since = math.fmod(time, length) if length > 0.0 else 0.0
            delay = delays[bisect_right(times, since + _ROUNDING) - 1]
            return () if math.isnan(delay) else tuple(copy + delay for copy in copies)

        return course


def _cells(file: str, text: str) -> list[tuple[int, list[str]]]:
    """Rows that are not empty, with their numbers."""
    lines = [(row, line) for row, line in enumerate(text.splitlines(), 1) if line.strip()]
    if not lines:
        table = _Table(file=file, header=[])
        raise table.error("", "a header and a row for each packet", "nothing")
    return [(row, [cell.strip() for cell in line.split(",")]) for row, line in lines]


@dataclass(frozen=True, kw_only=True)
class _Table:
    """Where cells come from, and how they are read."""

    file: str
    header: list[str]

    def clock(self) -> tuple[int, Unit]:
        """Index and unit of the time of sending, or of the number."""
        if self.header.count(_NUMBER) == 1:
            return self.header.index(_NUMBER), Unit()
        return self.find("t", Quantity.DURATION, or_else=_NUMBER)

    def find(self, name: str, quantity: Quantity, *, or_else: str = "") -> tuple[int, Unit]:
        """Index and unit of a column."""
        keys = quantity.keys(name)
        found = [index for index, cell in enumerate(self.header) if cell in keys]
        if len(found) != 1:
            choices = [*keys, or_else] if or_else else keys
            raise self.error(
                "row 1", f"one column {one_of(choices)}", f"the columns {', '.join(self.header)}"
            )
        return found[0], quantity.units[self.header[found[0]].removeprefix(f"{name}_")]

    def delay(self, row: int, cells: list[str], column: int, unit: Unit) -> float:
        """A delay [s]; nan where there is none."""
        if column >= len(cells) or not cells[column]:
            return math.nan
        value = self.number(row, cells, column, unit)
        if value < 0.0:
            where = f"row {row}, column {self.header[column]}"
            raise self.error(where, "zero or more, or nothing for a lost packet", cells[column])
        return value

    def number(self, row: int, cells: list[str], column: int, unit: Unit) -> float:
        """A cell in SI."""
        name = self.header[column]
        text = cells[column] if column < len(cells) else ""
        try:
            value = float(text)
        except ValueError:
            value = math.nan
        if not math.isfinite(value) or (name == _NUMBER and value != round(value)):
            what = "a whole number" if name == _NUMBER else "a finite number"
            found = f'"{text}"' if text else "nothing"
            raise self.error(f"row {row}, column {name}", what, found)
        return unit.to_si(value)

    def error(self, where: str, expected: str, found: str) -> InputError:
        """What is wrong, with advice."""
        remedy = (
            f"Write a header like {EXAMPLE}, a row for each packet, no delay if it was lost."
            if where in ("", "row 1")
            else "Correct or remove that row."
        )
        return InputError(
            file=self.file, field=where, expected=expected, found=found, remedy=remedy
        )
