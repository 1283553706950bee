"""Turn what is wrong with a table into one message in the words of the file."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from difflib import get_close_matches
from typing import cast

from pydantic import ValidationError
from pydantic_core import ErrorDetails

from sinuous.errors import InputError
from sinuous.quantities import Unit

Place = tuple[str | int, ...]  # a path of field names and list indices from the top table

_LONGEST_SHOWN = 60  # characters of a found value: a message stays on a line or two

_NOUNS = {
    "valid number": "a number",
    "finite number": "a finite number",
    "valid integer": "a whole number",
    "valid string": "text",
    "valid boolean": "true or false",
    "valid list": "a list",
    "valid tuple": "a list",
    "valid array": "a list",
    "object": "a table",
    "valid dictionary": "a table",
}
_BOUNDS = {
    "greater_than": ("gt", "more than"),
    "greater_than_equal": ("ge", "at least"),
    "less_than": ("lt", "less than"),
    "less_than_equal": ("le", "at most"),
}


class FieldError(ValueError):
    """A field that does not fit with the others; raise it in a model's `__post_init__`.

    Arguments:
        field: the field's name in the model, or a path of names and indices below it
        expected: what would have been good
        remedy: what the user can do about it, one sentence
    """

    def __init__(self, field: str | Place, *, expected: str, remedy: str) -> None:
        super().__init__(expected)
        self.place: Place = (field,) if isinstance(field, str) else field
        self.expected = expected
        self.remedy = remedy


@dataclass(frozen=True, kw_only=True)
class Source:
    """A table as the user wrote it, and how its keys became fields."""

    file: str
    data: Mapping[str, object]
    keys: dict[Place, str] = field(default_factory=dict[Place, str])
    units: dict[Place, Unit] = field(default_factory=dict[Place, Unit])
    choices: dict[Place, list[str]] = field(default_factory=dict[Place, list[str]])

    def dotted(self, place: Place) -> str:
        """Return a place as the user wrote it, like `segment[1].pitch_radius_mm`."""
        text = ""
        for depth, part in enumerate(place):
            if isinstance(part, int):
                text += f"[{part}]"
            else:
                text += ("." if text else "") + self.keys.get(place[: depth + 1], part)
        return text

    def value(self, place: Place) -> object:
        """Return what the user wrote there, before any conversion."""
        node: object = self.data
        for depth, part in enumerate(place):
            key = part if isinstance(part, int) else self.keys.get(place[: depth + 1], part)
            node = cast(dict[str | int, object], node)[key]
        return node

    def unit(self, place: Place) -> Unit | None:
        """Return the unit of the number there, if its key names one."""
        for depth in range(len(place), 0, -1):
            if place[:depth] in self.units:
                return self.units[place[:depth]]
        return None

    def error(self, place: Place, *, expected: str, found: str, remedy: str) -> InputError:
        """Return the error that speaks of this place."""
        return InputError(
            file=self.file,
            field=self.dotted(place),
            expected=expected,
            found=found,
            remedy=remedy,
        )


def show(value: object) -> str:
    """Return a value as a message shows it: as TOML writes it, shortened."""
    if isinstance(value, dict):
        return "a table"
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, list):
        text = "[" + ", ".join(show(item) for item in cast(list[object], value)) + "]"
    else:
        text = f'"{value}"' if isinstance(value, str) else str(value)
    return text if len(text) <= _LONGEST_SHOWN else text[: _LONGEST_SHOWN - 3] + "..."


def one_of(names: Iterable[str]) -> str:
    """Return "a", "a or b", "a, b or c"."""
    *most, last = names
    return f"{', '.join(most)} or {last}" if most else last


def did_you_mean(name: str, known: Sequence[str], *, what: str) -> str:
    """Return the remedy for a name that is not known: the nearest ones, or all of them."""
    close = get_close_matches(name, known, n=3)
    if close:
        return f"Did you mean {one_of(close)}?"
    return f"Known {what}: {', '.join(known)}." if known else f"There are no {what} here."


def unknown_key(
    source: Source, table: Place, key: str, fields: Mapping[str, list[str]]
) -> InputError:
    """Return the error for a key that the table does not have.

    Arguments:
        fields: the table's fields and the keys under which each may be written
    """
    known = [known for keys in fields.values() for known in keys]
    if key in fields:
        remedy = f"Write {one_of(fields[key])}: a key carries its unit."
    else:
        remedy = did_you_mean(key, known, what="keys")
    return source.error(
        (*table, key),
        expected=f"a key of {source.dotted(table)}" if table else "a key of this file",
        found="an unknown one",
        remedy=remedy,
    )


def explain(error: ValidationError, resolved: object, source: Source) -> InputError:
    """Return the first problem that pydantic found as an error about the file.

    Where a field may be one thing or another (a number or a list), the alternative that
    got furthest into the value is the one the user meant.
    """
    problems = [(_place(problem["loc"], resolved), problem) for problem in error.errors()]
    start = problems[0][0]
    same = [(place, problem) for place, problem in problems if place[: len(start)] == start]
    place = max((place for place, _ in same), key=len)
    here = [problem for other, problem in same if other == place]
    return _problem(place, here, source)


def _place(loc: Place, resolved: object) -> Place:
    """Keep of pydantic's location what exists in the data; the rest names alternatives."""
    place: list[str | int] = []
    node = resolved
    for part in loc:
        if isinstance(node, dict) and part in node:
            node = cast(dict[str | int, object], node)[part]
        elif isinstance(node, list) and isinstance(part, int) and part < len(node):
            node = cast(list[object], node)[part]
        else:
            continue
        place.append(part)
    return tuple(place)


def _problem(place: Place, problems: list[ErrorDetails], source: Source) -> InputError:
    first = problems[0]
    cause = first.get("ctx", {}).get("error")
    if isinstance(cause, FieldError):
        return _field_error(place, cause, source)
    if first["type"] == "missing" and isinstance(first["loc"][-1], str):
        return _missing((*place, first["loc"][-1]), source)
    found = show(source.value(place))
    unit = source.unit(place) or Unit()
    expected = one_of(dict.fromkeys(_expected(problem, unit) for problem in problems))
    remedy = _remedy(expected, found, source.dotted(place))
    return source.error(place, expected=expected, found=found, remedy=remedy)


def _remedy(expected: str, found: str, name: str) -> str:
    if found.startswith('"') and "number" in expected:
        return "Write the number without quotes."
    if found == "a table" and expected == "a list":
        return f"Write its header with double brackets, [[{name}]]."
    if found.startswith("[") and expected == "a table":
        return f"Write its header with single brackets, [{name}]."
    return "Correct this value."


def _field_error(table: Place, cause: FieldError, source: Source) -> InputError:
    place = (*table, *cause.place)
    try:
        found = show(source.value(place))
    except (KeyError, IndexError):
        found = "nothing"
    return source.error(place, expected=cause.expected, found=found, remedy=cause.remedy)


def _missing(place: Place, source: Source) -> InputError:
    keys = source.choices.get(place, [str(place[-1])])
    where = source.dotted(place[:-1]) or "the file"
    return source.error(
        place,
        expected="a value",
        found="nothing",
        remedy=f"Add {one_of(keys)} to {where}.",
    )


def _expected(problem: ErrorDetails, unit: Unit) -> str:
    """Return what one of pydantic's complaints asks for, bounds in the user's unit."""
    context = problem.get("ctx", {})
    if problem["type"] in _BOUNDS:
        name, words = _BOUNDS[problem["type"]]
        return f"{words} {unit.from_si(float(context[name])):g}"
    if problem["type"] in ("too_short", "too_long"):
        limit = context.get("min_length", context.get("max_length"))
        words = "at least" if problem["type"] == "too_short" else "at most"
        noun = "a table" if context.get("field_type") == "Dictionary" else "a list"
        return f"{noun} of {words} {limit}"
    if problem["type"] == "missing":
        return f"a list of at least {int(problem['loc'][-1]) + 1}"
    if problem["type"] == "string_too_short":
        return "a text that is not empty"
    text = (
        problem["msg"]
        .removeprefix("Value error, ")
        .removeprefix("Input should be ")
        .removeprefix("a ")
        .removeprefix("an ")
    )
    for words, noun in _NOUNS.items():
        if text.startswith(words):
            return noun
    return text.replace("'", '"')
