"""When compiled code that is kept on disk is out of date.

Numba looks at the file of a kernel alone, although the kernels that it calls are compiled into
it: after a change of theirs the old ones would go on running, or crash.
"""

import re
from functools import cache
from hashlib import sha256
from pathlib import Path

PACKAGE = Path(__file__).parent
IMPORT = re.compile(r"^\s*from sinuous\.([\w.]+) import ([^\n(]*|\([^)]*\))", re.MULTILINE)


def stamp(path: str) -> str:
    """A hash of a module of this package and of all that it imports from it, however far."""
    digest = sha256()
    for source in sorted(_reached(Path(path))):
        digest.update(_text(source).encode())
    return digest.hexdigest()


def _reached(path: Path) -> set[Path]:
    reached, waiting = set[Path](), [path]
    while waiting:
        source = waiting.pop()
        if source not in reached:
            reached.add(source)
            waiting += _imports(source)
    return reached


@cache
def _imports(source: Path) -> tuple[Path, ...]:
    """Files of the package that one file imports."""
    found = list[Path]()
    for module, names in IMPORT.findall(_text(source)):
        place = PACKAGE.joinpath(*module.split("."))
        # A module, or modules out of a folder.
        candidates = [place, *(place / name for name in re.findall(r"\w+", names))]
        found += [file for one in candidates if (file := one.with_suffix(".py")).is_file()]
    return tuple(found)


@cache
def _text(source: Path) -> str:
    return source.read_text(encoding="utf-8") if source.is_file() else ""
