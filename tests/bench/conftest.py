"""Running a benchmark from the command line."""

import json
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from sinuous.cli.main import main

LEAST_FIGURE = 10_000  # bytes of a figure with something in it


@pytest.fixture
def bench(tmp_path: Path) -> Callable[[str], dict[str, Any]]:
    """Run the short version of a benchmark; what it wrote, with the names of its figures."""

    def run(what: str) -> dict[str, Any]:
        file, out = tmp_path / f"{what}.json", tmp_path / "figures"
        assert main(["bench", what, "--quick", "--json", str(file), "--out", str(out)]) == 0
        figures = sorted(out.iterdir())
        assert all(figure.stat().st_size > LEAST_FIGURE for figure in figures)
        return {**json.loads(file.read_text()), "figures": [figure.name for figure in figures]}

    return run
