"""Which columns of a recording are what: named by the user, or found by their names."""

from dataclasses import dataclass

from sinuous.errors import InputError
from sinuous.files import length_unit

TIMES = ("timestamp", "t_s", "time_s", "time", "t")
PATTERNS = ("pattern_label", "pattern", "label")
TIPS = (("tip_x", "tip_y", "tip_z"), ("x", "y", "z"))
ENDINGS = ("mm", "cm", "m")


@dataclass(frozen=True, kw_only=True)
class Columns:
    """What a user says about the columns; what is left out is found by its name.

    Arguments:
        time: column of the time [s]
        motors: columns of the motors' positions
        tip: columns of the tip's x, y and z
        pattern: column of the names of the movements
        cable_unit, tip_unit: mm, cm or m; by default what the names end with, else mm
    """

    time: str | None = None
    motors: tuple[str, ...] = ()
    tip: tuple[str, ...] = ()
    pattern: str | None = None
    cable_unit: str | None = None
    tip_unit: str | None = None


@dataclass(frozen=True, kw_only=True)
class Found:
    """Where in a row everything stands, and metres in one unit."""

    time: int
    motors: tuple[int, ...]
    tip: tuple[int, ...]
    pattern: int | None
    cable_scale: tuple[float, ...]
    tip_scale: tuple[float, ...]

    @property
    def numbers(self) -> tuple[int, ...]:
        """Columns that must hold numbers."""
        return (self.time, *self.motors, *self.tip)


def find(header: list[str], said: Columns, *, file: str) -> Found:
    """Return where everything stands in a header.

    Raises:
        InputError: if a column is missing
    """
    look = _Header(names=header, file=file)
    time = look.one(said.time, TIMES, "--time", "the time in seconds")
    tip = look.tip(said.tip)
    pattern = look.maybe(said.pattern, PATTERNS)
    motors = look.motors(said.motors, {time, pattern, *tip})
    return Found(
        time=time,
        motors=motors,
        tip=tip,
        pattern=pattern,
        cable_scale=tuple(look.scale(k, said.cable_unit, "--cable-unit") for k in motors),
        tip_scale=tuple(look.scale(k, said.tip_unit, "--tip-unit") for k in tip),
    )


@dataclass(frozen=True, kw_only=True)
class _Header:
    names: list[str]
    file: str

    def one(self, said: str | None, usual: tuple[str, ...], option: str, what: str) -> int:
        if said is not None:
            return self._named(said, option)
        for name in usual:
            if name in self.names:
                return self.names.index(name)
        raise self._missing(f"a column of {what}, such as {usual[0]}", option)

    def maybe(self, said: str | None, usual: tuple[str, ...]) -> int | None:
        if said is not None:
            return self._named(said, "--pattern")
        return next((self.names.index(name) for name in usual if name in self.names), None)

    def tip(self, said: tuple[str, ...]) -> tuple[int, ...]:
        if said:
            if len(said) != 3:
                raise self._missing("three columns, x, y and z of the tip", "--tip")
            return tuple(self._named(name, "--tip") for name in said)
        for usual in TIPS:
            for names in (usual, *(tuple(f"{n}_{u}" for n in usual) for u in ENDINGS)):
                if all(name in self.names for name in names):
                    return tuple(map(self.names.index, names))
        raise self._missing("columns of the tip's position, such as tip_x, tip_y, tip_z", "--tip")

    def motors(self, said: tuple[str, ...], taken: set[int | None]) -> tuple[int, ...]:
        if said:
            return tuple(self._named(name, "--motors") for name in said)
        found = tuple(
            index
            for index, name in enumerate(self.names)
            if index not in taken and name.rpartition("_")[2] in ENDINGS
        )
        if not found:
            raise self._missing("columns of the motors' positions, such as servo_1_mm", "--motors")
        return found

    def scale(self, index: int, said: str | None, option: str) -> float:
        ending = self.names[index].rpartition("_")[2]
        unit = said or (ending if ending in ENDINGS else "mm")
        return length_unit(unit, file=option, field="")

    def _named(self, name: str, option: str) -> int:
        if name not in self.names:
            raise self._missing(f"a column {name}, named by {option}", option)
        return self.names.index(name)

    def _missing(self, expected: str, option: str) -> InputError:
        return InputError(
            file=self.file,
            field="row 1",
            expected=expected,
            found=f"the columns {', '.join(self.names)}",
            remedy=f"Correct the header, or name what is there with {option}.",
        )
