"""Change single fields of a table from the command line: `--set mpc.horizon=5`."""

import copy
import re
import tomllib
from collections.abc import Iterable, Mapping
from typing import cast

from sinuous.errors import InputError
from sinuous.explain import show
from sinuous.quantities import split_key

_KEY = re.compile(r"[A-Za-z0-9_-]+(\[\d+\]|\.[A-Za-z0-9_-]+)*")
_EXAMPLE = "Write it like --set mpc.horizon=5 or --set segment[0].length_mm=60."


def override(data: Mapping[str, object], assignments: Iterable[str]) -> dict[str, object]:
    """Return a copy of a table with some fields set; missing tables are made.

    A value is read as TOML, and as text if it is a bare word. A key with a unit takes the
    place of the same field in another unit.

    Arguments:
        data: the table, unchanged
        assignments: like "mpc.horizon=5", "segment[0].length_mm=60"

    Raises:
        InputError: if an assignment is malformed or does not fit the table
    """
    result = copy.deepcopy(dict(data))
    for assignment in assignments:
        key, equals, text = (part.strip() for part in assignment.partition("="))
        if not equals or not text or not _KEY.fullmatch(key):
            raise _error("", "key=value", f'"{assignment}"', _EXAMPLE)
        _assign(result, key, _read_value(key, text))
    return result


def _read_value(key: str, text: str) -> object:
    try:
        table = tomllib.loads(f"value = {text}")
    except (ValueError, RecursionError):
        if text[0] in "[{\"'":
            raise _error(key, "a TOML value", text, "Check its brackets and quotes.") from None
        return text
    return table["value"] if len(table) == 1 else text


def _assign(table: dict[str, object], key: str, value: object) -> None:
    *path, last = key.replace("[", ".").replace("]", "").split(".")
    node: object = table
    for depth, part in enumerate(path):
        node = _descend(node, part, ".".join(path[:depth]), key)
    if isinstance(node, list):
        items = cast(list[object], node)
        items[_index(items, last, key)] = value
    elif isinstance(node, dict):
        fields = cast(dict[str, object], node)
        for other in [other for other in fields if _same_field(other, last)]:
            del fields[other]
        fields[last] = value
    else:
        raise _not_a_table(".".join(path), node, key)


def _descend(node: object, part: str, where: str, key: str) -> object:
    if isinstance(node, list):
        items = cast(list[object], node)
        return items[_index(items, part, key)]
    if isinstance(node, dict):
        return cast(dict[str, object], node).setdefault(part, {})
    raise _not_a_table(where, node, key)


def _same_field(one: str, other: str) -> bool:
    one_field, one_quantity = split_key(one)
    return (one_field, one_quantity) == split_key(other)


def _index(items: list[object], text: str, key: str) -> int:
    if text.isdecimal() and int(text) < len(items):
        return int(text)
    remedy = f"The list has {len(items)} items, counted from 0."
    raise _error(key, "the index of an item", show(text), remedy)


def _not_a_table(where: str, node: object, key: str) -> InputError:
    return _error(key, f"{where} to be a table or a list", show(node), "Check the key.")


def _error(key: str, expected: str, found: str, remedy: str) -> InputError:
    return InputError(file="--set", field=key, expected=expected, found=found, remedy=remedy)
