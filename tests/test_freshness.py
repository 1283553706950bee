"""Kernels on disk are used only while all that was compiled into them is as it was."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

from sinuous import freshness

SOURCES = {
    "__init__.py": "",
    "arrays.py": "X = 1\n",
    "low.py": "from sinuous.arrays import X\n",
    "middle.py": "from sinuous import low\nfrom sinuous.low import (\n    X,\n)\n",
    "high.py": "from sinuous.middle import X\n",
    "beside.py": "from sinuous.arrays import X\n",
}


@pytest.fixture
def package(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    folder = tmp_path / "sinuous"
    folder.mkdir()
    for name, text in SOURCES.items():
        (folder / name).write_text(text, encoding="utf-8")
    monkeypatch.setattr(freshness, "PACKAGE", folder)
    return folder


def stamp(path: Path) -> str:
    freshness._imports.cache_clear()
    freshness._text.cache_clear()
    return freshness.stamp(str(path))


def test_a_change_far_below_makes_what_imports_it_stale(package: Path) -> None:
    before = {name: stamp(package / name) for name in SOURCES}
    (package / "low.py").write_text("from sinuous.arrays import X\nY = 2\n", encoding="utf-8")
    after = {name: stamp(package / name) for name in SOURCES}
    changed = {name for name in SOURCES if before[name] != after[name]}
    assert changed == {"low.py", "middle.py", "high.py"}


def test_the_step_depends_on_the_geometry_it_calls() -> None:
    package = Path(freshness.__file__).parent
    reached = freshness._reached(package / "control" / "step" / "plan.py")
    assert package / "geometry" / "triangle.py" in reached
    assert package / "robots" / "chain_second.py" in reached
    assert package / "cli" / "main.py" not in reached


PROGRAM = """
import sys
sys.path.insert(0, sys.argv[1])
import sinuous
sinuous.__path__.insert(0, sys.argv[1] + "/sinuous")
import numpy as np
from sinuous.outer_kernel import outer
print(outer(1.0))
"""


def test_a_kernel_is_compiled_anew_when_one_that_it_calls_changes(tmp_path: Path) -> None:
    folder = tmp_path / "sinuous"
    folder.mkdir()
    (folder / "outer_kernel.py").write_text(
        "from sinuous.compiled import kernel\nfrom sinuous.inner_kernel import part\n\n\n"
        "@kernel\ndef outer(x):\n    return part(x)\n",
        encoding="utf-8",
    )
    answers = list[float]()
    for factor in (2.0, 3.0):
        (folder / "inner_kernel.py").write_text(
            "from sinuous.compiled import inner\n\n\n"
            f"@inner\ndef part(x):\n    return {factor} * x\n",
            encoding="utf-8",
        )
        # The stamp looks into the package; let the two files count as part of it.
        patched = PROGRAM.replace(
            "from sinuous.outer_kernel",
            "from sinuous import freshness; from pathlib import Path\n"
            "freshness.PACKAGE = Path(sys.argv[1]) / 'sinuous'\nfrom sinuous.outer_kernel",
        )
        done = subprocess.run(
            [sys.executable, "-c", patched, str(tmp_path)],
            env={**os.environ, "NUMBA_CACHE_DIR": str(tmp_path / "cache")},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stderr
        answers.append(float(done.stdout))
    assert answers == [2.0, 3.0]
