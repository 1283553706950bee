"""A table as TOML, for recordings: the standard library reads TOML but does not write it."""

import json
import re
from collections.abc import Mapping
from typing import cast

_BARE_KEY = re.compile(r"[A-Za-z0-9_-]+")


def toml_text(table: Mapping[str, object]) -> str:
    """Return TOML that reads back as the same table; tables in lists are written inline."""
    return "\n".join(_lines(table, ())) + "\n"


def _lines(table: Mapping[str, object], path: tuple[str, ...]) -> list[str]:
    lines = [
        f"{_key(key)} = {_value(value)}"
        for key, value in table.items()
        if not isinstance(value, Mapping)
    ]
    for key, value in table.items():
        if isinstance(value, Mapping):
            name = (*path, key)
            lines += ["", f"[{'.'.join(map(_key, name))}]"]
            lines += _lines(cast(Mapping[str, object], value), name)
    return lines


def _key(key: str) -> str:
    return key if _BARE_KEY.fullmatch(key) else _quoted(key)


def _quoted(text: str) -> str:
    # JSON escapes what TOML wants escaped, except DEL.
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")


def _value(value: object) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        return _quoted(value)
    if isinstance(value, list):
        return "[" + ", ".join(_value(item) for item in cast(list[object], value)) + "]"
    if isinstance(value, Mapping):
        items = cast(Mapping[str, object], value).items()
        return "{ " + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in items) + " }"
    return str(value)  # numbers and dates write themselves as TOML does
