"""Memory that all processes of a session see, written and read without waiting.

Every part has one writer. A row is written, then its number, then the count of rows: whoever finds
its number there before and after copying a row has a whole one. (That relies on stores being seen
in their order, as x86 has it; on other processors it is likely, for the interpreter does much from
one store to the next, but not certain.) Nobody ever waits for anybody.
"""

from collections.abc import Mapping
from contextlib import suppress
from multiprocessing.shared_memory import SharedMemory
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.live.layout import TEXT, TICKS, TIPS, Part, Sizes, Timed
from sinuous.live.times import Times
from sinuous.teleop.motion import Plane, Walls

Row = Any
"""A row of a structured array."""


class Ring:
    """The newest rows of a growing table.

    Arguments:
        rows: where they are kept, a structured array with a field "number"
        written: how many have been written (1,)
    """

    def __init__(self, rows: Any, written: Any) -> None:
        self._rows, self._written = rows, written
        self._columns: Mapping[str, Any] = {name: rows[name] for name in rows.dtype.names}
        self._numbers = self._columns["number"]

    @property
    def written(self) -> int:
        """How many rows have been written so far."""
        return int(self._written[0])

    @property
    def capacity(self) -> int:
        """How many rows are kept."""
        return len(self._rows)

    def write(self, **fields: Any) -> None:
        """Add a row."""
        number = int(self._written[0])
        place = number % len(self._rows)
        self._numbers[place] = -1
        for name, value in fields.items():
            self._columns[name][place] = value
        self._numbers[place] = number
        self._written[0] = number + 1

    def read(self, number: int) -> Row | None:
        """A copy of a row; None if it is not there yet, or there no longer."""
        place = number % len(self._rows)
        if number < 0 or self._numbers[place] != number:
            return None
        row = self._rows[place].copy()
        return row if self._numbers[place] == number else None

    def block(self, first: int, rows: int, column: str) -> Array | None:
        """A column of some rows in a row; None if one of them is not there (any longer)."""
        places = np.arange(first, first + rows) % len(self._rows)
        values = self._columns[column][places]
        whole = np.array_equal(self._numbers[places], np.arange(first, first + rows))
        return values if whole else None


class Board:
    """What the processes share.

    Arguments:
        sizes: of the robot
        memory: that others see too; None for one process on its own
    """

    def __init__(self, sizes: Sizes, memory: SharedMemory | None = None) -> None:
        self._memory, layout = memory, sizes.board
        if memory is None:
            self._all = np.zeros(1, dtype=layout)
        else:
            self._all: Any = np.ndarray(1, dtype=layout, buffer=memory.buf)
        self.sizes = sizes
        self.ticks = Ring(self._all["tick"][0], self._all["ticks"])
        self.samples = Ring(self._all["sample"][0], self._all["samples"])
        self._tips, self._walls = self._all["tip"][0], self._all["wall"][0]
        counts, worst = self._all["counts"][0], self._all["worst"][0]
        self.times = tuple(Times(counts[kind], worst[kind]) for kind in Timed)

    @classmethod
    def create(cls, sizes: Sizes) -> "Board":
        """New memory, all zero."""
        memory = SharedMemory(create=True, size=sizes.board.itemsize)
        board = cls(sizes, memory)
        board._all["tick"]["number"] = board._all["sample"]["number"] = -1
        return board

    @classmethod
    def alone(cls, sizes: Sizes) -> "Board":
        """For one process."""
        board = cls(sizes)
        board._all["tick"]["number"] = board._all["sample"]["number"] = -1
        return board

    @classmethod
    def attach(cls, sizes: Sizes, name: str) -> "Board":
        """Memory that another process has created."""
        return cls(sizes, SharedMemory(name=name))

    @property
    def name(self) -> str:
        """By which other processes find it."""
        assert self._memory is not None
        return self._memory.name

    def get(self, field: str) -> Any:
        """A single number."""
        return self._all[field][0].item()

    def put(self, field: str, value: float) -> None:
        """Set a single number."""
        self._all[field] = value

    def cell(self, field: str) -> Any:
        """A single number as an array (1,), for those who need it often."""
        return self._all[field]

    def ready(self, part: Part) -> None:
        """A part is ready for the first tick."""
        self._all["ready"][0, part] = 1

    @property
    def all_ready(self) -> bool:
        """Whether both parts are."""
        return bool(np.all(self._all["ready"]))

    def fail(self, part: Part, why: str) -> None:
        """A part cannot go on."""
        self._all["fault"][0, part] = encoded(why)

    @property
    def fault(self) -> str:
        """Why a part could not go on; empty if all is well."""
        return "; ".join(bytes(text).decode() for text in self._all["fault"][0] if text)

    def tell_tips(self, tips: Array, walls: Walls) -> None:
        """Where the tip is measured (n, 3) [m] after each of the ticks to come.

        Arguments:
            walls: that the controller knows of until then
        """
        first = int(self._all["tips"][0])
        places = np.arange(first, first + len(tips)) % TIPS
        self._tips[places], self._walls[places] = tips, walls
        self._all["tips"] = first + len(tips)

    def tip(self, ticks: int) -> Array:
        """The tip (3,) [m] as measured after so many ticks."""
        return self._tips[ticks % TIPS].copy()

    def walls(self, ticks: int) -> Walls:
        """What the controller knew of walls after so many ticks."""
        held, near = self._walls[ticks % TIPS].copy()
        return Walls(Plane(*held), Plane(*near))

    def close(self) -> None:
        """Let go of the memory, and give it back if this process created it."""
        if self._memory is None:
            return
        self._all = self._tips = self._walls = np.zeros(0)
        del self.ticks, self.samples, self.times
        with suppress(BufferError):  # somebody holds a view: the memory ends with the process
            self._memory.close()

    def unlink(self) -> None:
        """Give the memory back; for whoever created it."""
        if self._memory is not None:
            with suppress(FileNotFoundError):
                self._memory.unlink()


def encoded(text: str) -> bytes:
    """A text in the room there is for it, cut between letters."""
    return text.encode()[: TEXT - 1].decode(errors="ignore").encode()


assert TICKS > TIPS  # a tip that is still looked up belongs to a tick that is still there
