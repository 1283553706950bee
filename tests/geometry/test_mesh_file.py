"""Files that hold no mesh are refused in plain words; odd ones that do are read."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.geometry import shapes
from sinuous.geometry.mesh import check_mesh
from sinuous.geometry.mesh_file import read_mesh
from sinuous.geometry.safe_zone import SafeZone

BOX = shapes.box((0.1, 0.1, 0.1))
TEXT = b"hello, this is text\nwith a second line\n"
NOISE = np.random.default_rng(0).bytes(3000)
TRIANGLE = b"v 0 0 0\nv 1 0 0\nv 0 1 0\n"
PLY_POINT = (
    b"ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nproperty float y\n"
    b"property float z\nend_header\n0 0 0\n"
)
# What no user should meet: words of Python, of its packages, and of their insides.
LEAKS = ("module", "charset", "index", "broadcast", "dtype", "Error", "sequence", "object")


def exported(name: str, tmp_path: Path) -> bytes:
    """The box in the format that a name stands for."""
    kinds = {
        "binary.stl": {},
        "text.stl": {"file_type": "stl_ascii"},
        "a.obj": {},
        "binary.ply": {},
        "text.ply": {"encoding": "ascii"},
    }
    BOX.export(tmp_path / name, **kinds[name])
    return (tmp_path / name).read_bytes()


BROKEN: dict[str, tuple[bytes, str]] = {
    "empty.stl": (b"", "an empty file"),
    "words.stl": (TEXT, "text that is no mesh"),
    "words.obj": (TEXT, "text that is no mesh"),
    "words.ply": (TEXT, "text that is no mesh"),
    "noise.stl": (NOISE, "binary data that is no mesh"),
    "noise.obj": (NOISE, "binary data that is no mesh"),
    "noise.ply": (NOISE, "binary data that is no mesh"),
    "zeros.stl": (bytes(500), "binary data that is no mesh"),
    "short.stl": (bytes(80) + (100).to_bytes(4, "little") + bytes(50), "with 1 of its 100"),
    "nothing.stl": (b"solid x\nendsolid x\n", "no triangles"),
    "points.obj": (TRIANGLE, "no triangles, only points"),
    "lines.obj": (TRIANGLE + b"l 1 2 3\n", "no triangles, only lines"),
    "word.obj": (TRIANGLE + b"f 1 2 x\n", "a line that cannot be read"),
    "beyond.obj": (TRIANGLE + b"f 1 2 9\n", "vertices that do not exist"),
    "cut.obj": (b"v 0 0 0\nv 1 0", "a truncated file"),
    "nan.obj": (b"v 0 0 nan\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "not finite numbers"),
    "points.ply": (PLY_POINT, "no triangles, only points"),
    "head.ply": (PLY_POINT[:60], 'without its "end_header"'),
    "picture.png": (b"PNG", 'ends in ".png"'),
    "plain": (b"", "without an ending"),
}


@pytest.mark.parametrize("name", sorted(BROKEN))
def test_broken_files_are_refused(tmp_path: Path, name: str) -> None:
    data, found = BROKEN[name]
    (tmp_path / name).write_bytes(data)
    with pytest.raises(InputError) as caught:
        SafeZone.load(tmp_path / name, unit="mm")
    assert found in caught.value.found
    assert caught.value.file == str(tmp_path / name)
    assert caught.value.remedy.endswith(".")
    assert not any(leak in caught.value.found for leak in LEAKS)


@pytest.mark.parametrize("share", [0.3, 0.6, 0.95])
@pytest.mark.parametrize("name", ["binary.stl", "text.stl", "binary.ply", "text.ply"])
def test_truncated_files_are_called_so(tmp_path: Path, name: str, share: float) -> None:
    data = exported(name, tmp_path)
    (tmp_path / name).write_bytes(data[: int(share * len(data))])
    with pytest.raises(InputError, match="expected a readable STL, OBJ or PLY mesh") as caught:
        read_mesh(tmp_path / name, unit="m")
    assert "truncated" in caught.value.found
    assert not any(leak in caught.value.found for leak in LEAKS)


ODD: dict[str, tuple[str, Callable[[bytes], bytes]]] = {
    "a comment in Latin-1": ("a.obj", lambda data: "# Körper\n".encode("latin-1") + data),
    "a name in Latin-1": (
        "text.stl",
        lambda data: data.replace(b"solid ", "solid Körper ".encode("latin-1")),
    ),
    "bytes behind the end": ("binary.stl", lambda data: data + bytes(7)),
    "a head like that of text": ("binary.stl", lambda data: b"solid".ljust(80) + data[80:]),
}


@pytest.mark.parametrize("case", sorted(ODD))
def test_odd_files_are_read(tmp_path: Path, case: str) -> None:
    name, change = ODD[case]
    (tmp_path / name).write_bytes(change(exported(name, tmp_path)))
    report = check_mesh(tmp_path / name, unit="m")
    assert (report.triangles, report.findings) == (len(BOX.faces), ())


def test_what_is_no_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no such file"):
        read_mesh(tmp_path / "missing.stl", unit="m")
    (tmp_path / "folder.stl").mkdir()
    with pytest.raises(InputError, match="a folder"):
        read_mesh(tmp_path / "folder.stl", unit="m")
