"""acados as the wheel `comma-deps-acados` brings it, or as it installs itself; it builds solvers.

The wheel has no interface for its own folders, so that the template finds them is arranged
here. Its CasADi is too old for this program and for Python 3.11: `HOW` says how to replace it.
"""

import contextlib
import ctypes
import os
import shutil
import subprocess
from collections.abc import Generator
from importlib import import_module
from pathlib import Path
from typing import Any

import casadi as ca

from sinuous.bench.peers.compile import FLAGS, cache_folder
from sinuous.bench.peers.silence import quiet

HOW = (
    "not installed. In an environment of its own: pip install sinuous[bench] comma-deps-acados, "
    "then pip install --force-reinstall --no-deps casadi, whose place that wheel takes"
)


def load() -> Any | None:
    """The module `acados_template`, ready to build, or None if there is none."""
    with contextlib.suppress(ImportError):
        return import_module("acados_template")
    try:
        package = import_module("acados")
        folder = Path(package.__path__[0])
        source = _source_folder(folder)
        os.environ.setdefault("ACADOS_SOURCE_DIR", str(source))
        os.environ.setdefault("TERA_PATH", str(source / "bin" / "t_renderer"))
        for name in ("blasfeo", "hpipm", "qpOASES_e", "acados"):
            ctypes.CDLL(str(source / "lib" / f"lib{name}.so"), ctypes.RTLD_GLOBAL)
        with quiet():
            return import_module("acados.acados_template")
    except (ImportError, OSError):
        return None


def _source_folder(package: Path) -> Path:
    """A folder laid out like acados's sources, of links into the wheel."""
    root = cache_folder() / "acados"
    links = {
        root / "interfaces" / "acados_template" / "acados_template": package / "acados_template",
        **{root / name: package / "install" / name for name in ("include", "lib", "bin")},
    }
    for link, target in links.items():
        link.parent.mkdir(parents=True, exist_ok=True)
        if link.is_symlink() and link.readlink() != target:
            link.unlink()
        if not link.is_symlink():
            link.symlink_to(target)
    return root


def linked(function: ca.Function, jacobian: ca.Function, folder: Path, command: str) -> ca.Function:
    """A function and its Jacobian in a library that acados's generated code calls.

    acados counts in int and CasADi in long long, so there are two: one for each.
    """
    name = function.name()
    with _inside(folder):
        generator = ca.CodeGenerator(f"{name}.c")
        generator.add(function)
        generator.add(jacobian)
        generator.generate()
        for library, extra in ((f"lib{name}.so", ["-Dcasadi_int=int"]), (f"{name}_casadi.so", [])):
            options = [*FLAGS, *extra, f"-Wl,-soname,{library}", f"{name}.c", "-o", library, "-lm"]
            subprocess.run([command, *options], check=True, capture_output=True)
    ctypes.CDLL(str(folder / f"lib{name}.so"))
    return ca.external(name, str(folder / f"{name}_casadi.so"))


def build(template: Any, ocp: Any, folder: Path) -> Any:
    """A solver of acados for a problem, generated and compiled in an empty folder."""
    with _inside(folder), quiet():
        return template.AcadosOcpSolver(ocp, json_file=str(folder / "ocp.json"))


def fresh_folder(name: str) -> Path:
    """An empty folder for generated code."""
    folder = cache_folder() / name
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True)
    return folder


@contextlib.contextmanager
def _inside(folder: Path) -> Generator[None]:
    before = Path.cwd()
    os.chdir(folder)
    try:
        yield
    finally:
        os.chdir(before)
