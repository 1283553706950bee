"""CasADi functions as one library of machine code, kept for the next run."""

import hashlib
import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping
from pathlib import Path

import casadi as ca

FLAGS = ("-O3", "-march=native", "-fPIC", "-shared")


def compiler() -> str | None:
    """The C compiler of this machine, if there is one."""
    return next(filter(None, map(shutil.which, ("cc", "gcc", "clang"))), None)


def compiled(functions: Mapping[str, ca.Function], command: str) -> dict[str, ca.Function]:
    """The same functions from a library; compiling takes up to a minute, once.

    Raises:
        RuntimeError: if the compiler fails, with what it said
    """
    with tempfile.TemporaryDirectory() as folder:
        generator = ca.CodeGenerator("peer.c", {"with_header": False})
        for function in functions.values():
            generator.add(function)
        source = Path(generator.generate(f"{folder}/"))
        key = hashlib.sha256(source.read_bytes() + " ".join((command, *FLAGS)).encode())
        library = cache_folder() / f"{key.hexdigest()[:24]}.so"
        if not library.is_file():
            part = library.with_suffix(f".{os.getpid()}.part")
            call = [command, *FLAGS, str(source), "-o", str(part), "-lm"]
            done = subprocess.run(call, capture_output=True, text=True, check=False)
            if done.returncode:
                raise RuntimeError(f"the C compiler failed: {done.stderr.strip()[-2000:]}")
            part.replace(library)
    return {
        name: ca.external(function.name(), str(library)) for name, function in functions.items()
    }


def cache_folder() -> Path:
    """Where compiled code is kept."""
    root = os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache"
    folder = Path(root) / "sinuous" / "bench"
    try:
        folder.mkdir(parents=True, exist_ok=True)
    except OSError:
        return Path(tempfile.mkdtemp(prefix="sinuous-bench-"))
    return folder
