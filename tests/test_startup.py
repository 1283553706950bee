"""Start-up: what is imported, what is compiled, and what is said about it."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

import sinuous

HEAVY = ("numba", "numpy", "scipy", "trimesh", "matplotlib", "rosbags", "pydantic")
USE_ONE_KERNEL = """
import numpy as np
from sinuous.geometry.topology import linked
assert linked(np.array([0]), np.array([2]), 3).tolist() == [0, 1, 0]
"""
SAID = "sinuous is compiling its inner loops for this machine, once"


def _python(code: str, **environment: str) -> str:
    """Run code in a process of its own, warnings being errors; what it writes to stderr."""
    command = [sys.executable, "-W", "error", "-c", code]
    done = subprocess.run(
        command, env=os.environ | environment, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stderr
    return done.stderr


def _absent(names: tuple[str, ...]) -> str:
    return f"import sys; found = [n for n in {names} if n in sys.modules]; assert not found, found"


@pytest.mark.parametrize("argv", [[], ["run"], ["check"], ["compare"]])
def test_help_imports_nothing_heavy(argv: list[str]) -> None:
    _python(f"from sinuous.cli import main; main({[*argv, '--help']})\n{_absent(HEAVY)}")


def test_the_package_imports_nothing_heavy() -> None:
    _python(f"import sinuous\n{_absent(HEAVY)}")


def test_a_binary_mesh_needs_no_mesh_library() -> None:
    mesh = Path(__file__).parent.parent / "examples" / "meshes" / "inverted_u.stl"
    load = "from sinuous.geometry.mesh import check_mesh\n"
    load += f"assert check_mesh({str(mesh)!r}, unit='mm').usable\n"
    _python(f"{load}{_absent(('trimesh', 'networkx', 'scipy.sparse', 'matplotlib'))}")


def test_compiling_is_announced_once_and_loading_is_silent(tmp_path: Path) -> None:
    said = _python(USE_ONE_KERNEL * 2, NUMBA_CACHE_DIR=str(tmp_path))
    assert said.count("\n") == 1
    assert said.startswith(SAID)
    assert _python(USE_ONE_KERNEL, NUMBA_CACHE_DIR=str(tmp_path)) == ""


def test_the_announcement_is_an_ordinary_log_message(tmp_path: Path) -> None:
    quiet = "import logging; logging.getLogger('sinuous').setLevel(logging.ERROR)\n"
    assert _python(quiet + USE_ONE_KERNEL, NUMBA_CACHE_DIR=str(tmp_path)) == ""


def test_kernels_of_others_are_not_announced(tmp_path: Path) -> None:
    code = "import numba, sinuous.compiled\nassert numba.njit(lambda x: x + 1)(1) == 2"
    assert _python(code, NUMBA_CACHE_DIR=str(tmp_path)) == ""


@pytest.fixture
def sealed(tmp_path: Path) -> Path:
    """A copy of the package in whose folders no cache can be made, not even by root."""
    package = tmp_path / "copy" / "sinuous"
    ignore = shutil.ignore_patterns("__pycache__")
    shutil.copytree(Path(sinuous.__file__).parent, package, ignore=ignore)
    for folder in (package, *(p for p in package.rglob("*") if p.is_dir())):
        (folder / "__pycache__").write_text("in the way")
    return package.parent


def test_the_cache_moves_to_the_users_folder(tmp_path: Path, sealed: Path) -> None:
    home = tmp_path / "home"
    where = {"HOME": str(home), "XDG_CACHE_HOME": str(home / "cache"), "PYTHONPATH": str(sealed)}
    where |= {"LOCALAPPDATA": str(home / "cache"), "NUMBA_CACHE_DIR": ""}
    assert _python(USE_ONE_KERNEL, **where).startswith(SAID)
    assert list(home.rglob("*.nbi"))
    assert _python(USE_ONE_KERNEL, **where) == ""


def test_without_any_place_for_a_cache_everything_still_works(tmp_path: Path, sealed: Path) -> None:
    home = tmp_path / "home"
    home.write_text("in the way")
    where = {"HOME": str(home), "XDG_CACHE_HOME": str(home / "cache"), "PYTHONPATH": str(sealed)}
    where |= {"LOCALAPPDATA": str(home / "cache"), "NUMBA_CACHE_DIR": ""}
    assert "Set NUMBA_CACHE_DIR to one that can be written" in _python(USE_ONE_KERNEL, **where)
