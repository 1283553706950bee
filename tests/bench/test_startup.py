"""`sinuous bench startup`."""

from collections.abc import Callable
from typing import Any

import pytest


def test_processes_are_timed_and_drawn(bench: Callable[[str], dict[str, Any]]) -> None:
    found = bench("startup")
    assert found["figures"] == ["startup.png"]
    rows = {row["what"]: row for row in found["rows"]}
    assert list(rows) == ["python", "import sinuous", "sinuous --help", "first control step"]
    assert all(0.0 < row["least_s"] <= row["median_s"] <= row["max_s"] for row in rows.values())
    parts = sum(part["median_s"] for part in found["parts"])
    assert parts == pytest.approx(rows["first control step"]["median_s"])
