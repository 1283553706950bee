"""`sinuous bench rate`."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.bench.scene import DT, targets

EXACT = 1e-12  # [m] rounding of lengths around 0.1 m


def test_both_rates_are_measured_and_drawn(bench: Callable[[str], dict[str, Any]]) -> None:
    found = bench("rate")
    assert found["figures"] == ["rate.png"]
    assert [row["rate_hz"] for row in found["rows"]] == pytest.approx([30.0, 1000.0])
    slow, fast = found["rows"]
    assert (slow["steps"], fast["steps"]) == (12, 400)
    for row, series in zip(found["rows"], found["series_mm"], strict=True):
        assert row["violations"] == row["failures"] == 0
        assert len(series["tracking"]) == len(found["time_s"]) == 12
        assert row["tracking_median_mm"] == pytest.approx(np.median(series["tracking"]))
    # One that is asked 1/30 s later cannot know more: both errors are the same drive's.
    assert slow["tracking_late_median_mm"] == pytest.approx(slow["tip_error_median_mm"])


def test_the_path_in_time_is_the_same_at_every_rate() -> None:
    slow, fast = targets(600), targets(6000, DT / 10)
    np.testing.assert_allclose(fast[::10], slow, rtol=0, atol=EXACT)
    jumps = np.linalg.norm(np.diff(fast, axis=0), axis=1) > 0.01
    assert np.flatnonzero(jumps).tolist() == [1999, 2599, 4299, 4899]
