"""One thread, and what the numbers were measured on.

Imports nothing that computes: the number of threads has to be set before numpy is loaded.
"""

import os
import platform
from importlib.metadata import PackageNotFoundError, version
from pathlib import Path

from sinuous.errors import InputError

THREADS = (
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)

PACKAGES = ("sinuous", "numpy", "scipy", "numba", "daqp", "piqp", "casadi", "comma-deps-acados")


def one_thread() -> None:
    """Keep every library of this process to one thread."""
    os.environ.update(dict.fromkeys(THREADS, "1"))


def machine() -> dict[str, object]:
    """What the numbers depend on besides the code."""
    return {
        "cpu": cpu_model(),
        "cores": os.cpu_count(),
        "system": platform.system(),
        "threads": {name: os.environ.get(name, "") for name in THREADS},
        "load_average": list(os.getloadavg()) if hasattr(os, "getloadavg") else [],
    }


def cpu_model() -> str:
    """The processor's name as the system knows it."""
    try:
        lines = Path("/proc/cpuinfo").read_text(encoding="utf-8").splitlines()
    except OSError:
        return platform.processor() or "unknown"
    names = [line.partition(":")[2].strip() for line in lines if line.startswith("model name")]
    return names[0] if names else platform.machine()


def versions() -> dict[str, str]:
    """Versions of Python and of the packages that are compared."""
    return {"python": platform.python_version()} | {name: _version(name) for name in PACKAGES}


def _version(name: str) -> str:
    try:
        return version(name)
    except PackageNotFoundError:
        return "not installed"


def require(module: str, what: str) -> None:
    """Make sure that a module of the extra is there.

    Raises:
        InputError: naming the extra, if it is not
    """
    try:
        __import__(module)
    except ImportError as error:
        raise InputError(
            file=f"sinuous bench {what}",
            expected=f"the package {module}",
            found="that it is not installed",
            remedy="Install what benchmarks need: pip install sinuous[bench]",
        ) from error
