"""Quantiles in a fixed room, and the pace of ticks."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.live.clock import SteppedClock
from sinuous.live.pace import Pace
from sinuous.live.times import FIRST, GROWTH, Times

DT = 1e-3


@given(st.lists(st.floats(0.0, 100.0), min_size=1, max_size=300))
def test_quantiles_are_exact_to_a_bin(values: list[float]) -> None:
    times = Times.new()
    for value in values:
        times.add(value)
    # A bin's upper end, so never below; values below a microsecond are not told apart.
    for name, share in (("median", 0.5), ("p99", 0.99)):
        exact = float(np.quantile(values, share, method="inverted_cdf"))
        found = getattr(times.quantiles, name)
        assert exact <= found * (1 + 1e-12)
        assert found <= max(exact * GROWTH, FIRST) * (1 + 1e-9)
    assert times.quantiles.max == max(values)
    assert times.number == len(values)


def test_no_times_are_zero() -> None:
    assert Times.new().quantiles == (0.0, 0.0, 0.0)


def test_those_beyond_a_time_are_counted() -> None:
    times = Times.new()
    for value in (0.5e-3, 0.9e-3, 1.1e-3, 2.0, -1.0):
        times.add(value)
    assert times.beyond(1e-3) == 2


def test_ticks_come_at_their_times() -> None:
    clock = SteppedClock()
    pace = Pace(clock, DT)
    pace.start(1.0)
    dues = []
    for _ in range(5):
        due, late = pace.wait()
        assert late == 0.0
        dues.append(due)
    assert dues == pytest.approx(1.0 + DT * np.arange(5))
    assert pace.slipped == 0.0


def test_a_short_delay_is_made_up_for() -> None:
    clock = SteppedClock()
    pace = Pace(clock, DT, slack=0.01)
    pace.start(0.0)
    pace.wait()
    clock.work(5.2e-3)
    lates = [pace.wait()[1] for _ in range(8)]
    assert lates[:5] == pytest.approx([4.2e-3, 3.2e-3, 2.2e-3, 1.2e-3, 0.2e-3])
    assert lates[6:] == pytest.approx([0.0, 0.0])
    assert clock.now() == pytest.approx(8 * DT)
    assert pace.slipped == 0.0


def test_overload_slows_time_down_and_says_by_how_much() -> None:
    clock = SteppedClock()
    pace = Pace(clock, DT, slack=0.01)
    pace.start(0.0)
    ticks = 1000
    for _ in range(ticks):
        pace.wait()
        clock.work(2.0 * DT)  # twice what there is time for
    # All that time is longer by is slipped, but for what is still to be made up for.
    over = clock.now() - ticks * DT
    assert pace.slipped == pytest.approx(over, abs=0.01 + 2 * DT)
    assert over == pytest.approx(ticks * DT, rel=0.02)
