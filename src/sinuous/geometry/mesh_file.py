"""Reading a mesh file, and saying in plain words what is wrong with one that cannot be read."""

import re
from collections.abc import Callable
from io import BytesIO
from os import PathLike
from pathlib import Path
from typing import Any, NoReturn, cast

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.errors import InputError
from sinuous.files import length_unit

EXPECTED = "a readable STL, OBJ or PLY mesh"
EXPORT_AGAIN = "Export the mesh again from the program that made it."

STL_HEAD, STL_TRIANGLE = 84, 50  # bytes of a binary STL file
STL_RECORD = np.dtype([("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
SHOWN = 1000  # bytes from which text is told from binary data
BLANK = b"\0 \t\n\r\v\f"
MARKS = {".stl": '"endsolid"', ".ply": '"end_header"'}
"""What a whole file has: an STL text in its last line, a PLY file after its header."""
PLY_HEADER_END = re.compile(rb"\n\s*end_header\s*\n")
PLY_FACES = re.compile(rb"^element face (\d+)", re.MULTILINE)


def read_mesh(path: str | PathLike[str], *, unit: str) -> tuple[Array, IntArray]:
    """Read vertices [m] (V, 3) and faces (F, 3) of an STL, OBJ or PLY file.

    Raises:
        InputError: if the unit is unknown or the file is missing, empty, of another format or
            broken
    """
    path = Path(path)
    metres = length_unit(unit, file=str(path), field="unit")
    kind = path.suffix.lower()
    if path.is_dir():
        _refuse(path, "a folder", "Name a file in it.")
    if not path.is_file():
        _refuse(path, "no such file", "Check the path; it is relative to the current directory.")
    if kind not in WRONG:
        found = f'a file that ends in "{path.suffix}"' if kind else "a file without an ending"
        _refuse(path, found, "Convert the mesh to one of these formats.")
    try:
        data = path.read_bytes()
    except OSError as error:
        found = f"one that cannot be opened ({(error.strerror or str(error)).lower()})"
        _refuse(path, found, "Check its permissions.")
    if found := _wrong_at_once(data, kind):
        _refuse(path, found)
    try:
        vertices, faces = _parse(data, kind)
    except Exception:  # whatever a parser stumbles over, the file is what is wrong
        _refuse(path, WRONG[kind](data))
    if kind == ".ply" and (promise := PLY_FACES.search(data)) and len(faces) < int(promise[1]):
        _refuse(path, f"a truncated file, with {len(faces)} of its {int(promise[1])} faces")
    if not len(faces):
        remedy = "Export the surface as triangles from the program that made it."
        _refuse(path, f"no triangles{_instead(data, kind, len(vertices))}", remedy)
    return vertices * metres, faces


def _refuse(path: Path, found: str, remedy: str = EXPORT_AGAIN) -> NoReturn:
    # Without the parser's own exception: it speaks of its insides and would only distract.
    raise InputError(file=str(path), expected=EXPECTED, found=found, remedy=remedy) from None


def _parse(data: bytes, kind: str) -> tuple[Array, IntArray]:
    if kind == ".stl" and _fits_binary_stl(data):
        return _binary_stl(data)
    import trimesh  # only here: importing it takes longer than everything else about a small mesh

    options: dict[str, Any] = {"process": False, "force": "mesh", "file_type": kind[1:]}
    if kind == ".obj":
        options["skip_materials"] = True
    text = data if kind == ".ply" else _utf8(data)
    mesh = cast(Any, trimesh.load(BytesIO(text), **options))
    vertices = np.asarray(mesh.vertices, dtype=np.float64).reshape(-1, 3)
    return vertices, np.asarray(getattr(mesh, "faces", ()), dtype=np.int64).reshape(-1, 3)


def _binary_stl(data: bytes) -> tuple[Array, IntArray]:
    """Three vertices of their own for every triangle; some programs add more behind the last."""
    count = _announced(data)
    triangles = np.frombuffer(data, STL_RECORD, count, offset=STL_HEAD)
    vertices = triangles["corners"].astype(np.float64).reshape(-1, 3)
    return vertices, np.arange(3 * count).reshape(-1, 3)


def _utf8(data: bytes) -> bytes:
    """Text in UTF-8; what is something else is taken as Latin-1, which any bytes are."""
    try:
        data.decode()
    except UnicodeDecodeError:
        return data.decode("latin-1").encode()
    return data


def _announced(data: bytes) -> int:
    """How many triangles the head of a binary STL file promises."""
    return int.from_bytes(data[80:STL_HEAD], "little")


def _fits_binary_stl(data: bytes) -> bool:
    """Whether the file has room for the triangles that it promises; text never has."""
    return len(data) >= STL_HEAD and len(data) >= STL_HEAD + STL_TRIANGLE * _announced(data)


def _is_text(data: bytes) -> bool:
    return b"\0" not in data[:SHOWN] and sum(c < 9 or 13 < c < 32 for c in data[:SHOWN]) == 0


def _alien(data: bytes) -> str:
    return "text that is no mesh" if _is_text(data) else "binary data that is no mesh"


def _wrong_at_once(data: bytes, kind: str) -> str:
    """What parsers do not notice, because they take what they understand; empty if nothing."""
    if not data:
        return "an empty file"
    if kind == ".obj":
        return "" if re.search(rb"^\s*v\s", data, re.MULTILINE) else _alien(data)
    if kind == ".stl" and _fits_binary_stl(data) and not _is_text(data):
        return "" if _announced(data) or len(data) == STL_HEAD else _alien(data)
    if kind == ".ply" and not data.startswith(b"ply"):
        return _alien(data)
    if kind == ".stl" and (not _is_text(data) or b"facet" not in data.lower()):
        return _wrong_stl(data)
    if kind == ".ply":
        whole = PLY_HEADER_END.search(data) is not None
    else:
        whole = b"endsolid" in data.rstrip(BLANK).rpartition(b"\n")[2].lower()
    return "" if whole else f"a truncated file, without its {MARKS[kind]}"


def _wrong_stl(data: bytes) -> str:
    """Why an STL file cannot be read."""
    if _is_text(data):
        if b"facet" in data.lower():
            return "an STL text file with a number or a word that cannot be read"
        named = data.lower().lstrip().startswith(b"solid") and b"endsolid" in data.lower()
        return "no triangles" if named else _alien(data)
    held, promised = max(len(data) - STL_HEAD, 0) // STL_TRIANGLE, _announced(data)
    # A number that is out of all proportion is no number of triangles but a piece of noise.
    if len(data) < STL_HEAD or (promised > 1000 * (held + 1)):
        return _alien(data)
    return f"a truncated file, with {held} of its {promised} triangles"


def _wrong_obj(data: bytes) -> str:
    """Why an OBJ file cannot be read."""
    if not _is_text(data):
        return _alien(data)
    if not data.endswith(b"\n"):
        return "a truncated file, or one with a line that cannot be read"
    return "an OBJ file with a line that cannot be read, or faces of vertices that do not exist"


def _wrong_ply(data: bytes) -> str:
    """Why a PLY file cannot be read; that it has a header is known."""
    return "a truncated file, or one whose content does not fit its header"


WRONG: dict[str, Callable[[bytes], str]] = {
    ".stl": _wrong_stl,
    ".obj": _wrong_obj,
    ".ply": _wrong_ply,
}


def _instead(data: bytes, kind: str, vertices: int) -> str:
    """What there is in place of triangles."""
    if kind == ".obj" and re.search(rb"^\s*l\s", data, re.MULTILINE):
        return ", only lines"
    points = vertices or kind == ".obj" or (kind == ".ply" and b"element vertex 0" not in data)
    return ", only points" if points else ""
