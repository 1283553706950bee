"""What the data of the horizons say."""

from collections.abc import Sequence
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data

REACHED = 1e-4  # the tip is there if it is no farther away [m]
PERIOD = 0.01  # of 100 Hz, which 99 % of the steps must keep [s]
RATE = 30.0  # of the steps in the statistics [Hz]


def errors(data: Data, rate: float = RATE) -> tuple[list[int], Array]:
    """Horizons and final tip errors (K, H) [m] behind the plates at a rate [Hz]."""
    rows = [row for row in data["attempts"] if row["rate_hz"] == rate]
    return list(rows[0]["horizons"]), np.array([row["error_m"] for row in rows])


def reached(data: Data, rate: float = RATE) -> dict[int, int]:
    """How many of the targets behind the plates each horizon reaches."""
    horizons, error = errors(data, rate)
    return dict(zip(horizons, np.sum(error <= REACHED, axis=0).tolist(), strict=True))


def guided(data: Data) -> tuple[int, int]:
    """How many of the targets are reached along way-points, and of how many."""
    found = [row["guided_error_m"] for row in data["attempts"] if row["rate_hz"] == RATE]
    return int(np.sum(np.array(found) <= REACHED)), len(found)


def escapes(data: Data) -> tuple[int, int]:
    """How many runs of a long horizon leave the dead end of a short one, and of how many."""
    found = [e for row in data["attempts"] for e in row.get("from_dead_end_error_m", ())]
    return int(np.sum(np.array(found) <= REACHED)), len(found)


def settled(data: Data, family: str) -> dict[int, float]:
    """Mean time [s] until the whole body rests, by horizon."""
    rows: Sequence[dict[str, Any]] = [r for r in data["settling"] if r["family"] == family]
    return {
        N: float(np.mean([row["settled_s"] for row in rows if row["horizon"] == N]))
        for N in data["horizons"]
    }


def families(data: Data) -> list[str]:
    """Of the scenes in which every target can be reached."""
    return list(dict.fromkeys(row["family"] for row in data["settling"]))


def restless(data: Data) -> dict[int, float]:
    """Mean change of an actuator's rate from step to step at rest [m/s], by horizon."""
    return {
        N: float(
            np.mean([r["rate_change_at_rest_m_s"] for r in data["settling"] if r["horizon"] == N])
        )
        for N in data["horizons"]
    }


def holds(data: Data) -> list[int]:
    """Horizons whose steps keep the period of 100 Hz, 99 of 100."""
    return [row["horizon"] for row in data["cost"] if row["p99_s"] < PERIOD]


def recommended(data: Data) -> int | None:
    """The horizon that holds 100 Hz, reaches most targets and then settles quickest.

    Counts that differ by less than one standard deviation of a count are the same. None if no
    horizon holds 100 Hz.
    """
    able = holds(data)
    if not able:
        return None
    count, total = reached(data), len(errors(data)[1])
    best = max(count[N] for N in able)
    spread = np.sqrt(best * (1.0 - best / total))
    able = [N for N in able if count[N] >= best - spread]
    times = [settled(data, family) for family in families(data)]
    return min(able, key=lambda N: sum(time[N] for time in times))
