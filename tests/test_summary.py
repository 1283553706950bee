import io
import json
from typing import Any

import numpy as np
import pytest
from rich.console import Console

from sinuous.control.report import Status
from sinuous.recording import Header, Recording, Sample, status_name
from sinuous.summary import summarise
from sinuous.view import print_summary

MARGIN = 0.005
# Rounding of a few additions and one square root in double precision.
ROUNDING = 1e-12


def make_run(steps: int, margin: float = MARGIN, **columns: Any) -> Recording:
    """A run whose columns are given; all else is zero."""
    header = Header(
        name="by hand",
        robot="",
        scenario="",
        actuator_names=("segment 1 cable 1",),
        rate_limits=np.array([[-1.0, 1.0]]),
        margin=margin,
        dt=0.1,
        seed=42,
        versions={"sinuous": "0.1.0"},
        zone_triangles=np.empty((0, 3, 3)),
        zone_parts=np.zeros(0, dtype=np.int64),
        radii=np.full(2, 0.008),
        disk_indices=np.zeros(0, dtype=np.int64),
    )
    still: dict[str, Any] = {
        "target": np.zeros(3),
        "configuration": np.zeros(1),
        "lengths": np.zeros(1),
        "rates": np.zeros(1),
        "nominal_points": np.zeros((2, 3)),
        "nominal_tip": np.zeros(3),
        "nominal_clearance": np.inf,
        "measured_points": np.zeros((2, 3)),
        "measured_tip": np.zeros(3),
        "measured_lengths": np.zeros(1),
        "local_rates": np.zeros(1),
        "clipped": 0.0,
        "offset": np.zeros(3),
        "actual_points": np.zeros((2, 3)),
        "actual_tip": np.zeros(3),
        "actual_clearance": np.inf,
        "status": "tracking",
        "solve_time": 0.001,
        "iterations": 1,
        "planes": 0,
        "step_fraction": 1.0,
        "active": (),
    }
    return Recording.from_samples(
        header,
        [
            Sample(time=0.1 * (k + 1), **still | {name: c[k] for name, c in columns.items()})
            for k in range(steps)
        ],
    )


def test_tip_error_is_that_of_the_actual_tip() -> None:
    tips = [np.array([0.003, 0.004, 0.0]), np.array([0.0, 0.0, 0.001])]
    summary = summarise(make_run(2, actual_tip=tips, nominal_tip=[np.ones(3)] * 2))
    assert summary["tip_error_rms_m"] == pytest.approx(np.sqrt(13.0) * 1e-3, rel=ROUNDING)
    assert summary["tip_error_final_m"] == pytest.approx(0.001, rel=ROUNDING)


def test_clearances_are_the_least_ones() -> None:
    run = make_run(
        3, nominal_clearance=[0.007, 0.006, np.inf], actual_clearance=[0.003, -0.001, 0.004]
    )
    summary = summarise(run)
    assert summary["min_clearance_nominal_m"] == 0.006
    assert summary["min_clearance_actual_m"] == -0.001


def test_violations_are_nominal_and_forgive_rounding_only() -> None:
    nominal = [MARGIN, MARGIN - 0.9e-9, MARGIN - 1.1e-9, -0.01, np.nan]
    run = make_run(5, nominal_clearance=nominal, actual_clearance=[0.0] * 5)
    assert summarise(run)["margin_violations"] == 3


def test_failures_are_the_steps_that_hold() -> None:
    status = [status_name(s) for s in (*Status, Status.HOLDING)]
    assert sorted(set(status)) == ["at_target", "blocked", "holding", "recovering", "tracking"]
    assert summarise(make_run(6, status=status))["solver_failures"] == 2


def test_times() -> None:
    summary = summarise(make_run(101, solve_time=[k * 1e-3 for k in range(101)]), wall_time=2.02)
    times: Any = summary["solve_time_s"]
    assert times == pytest.approx({"median": 0.050, "p99": 0.099, "max": 0.1}, rel=ROUNDING)
    assert summary["real_time_factor"] == pytest.approx(5.0, rel=ROUNDING)


def test_what_json_cannot_hold_is_null() -> None:
    summary = summarise(make_run(2))
    text = json.dumps(summary, allow_nan=False)
    assert json.loads(text) == summary
    assert summary["min_clearance_nominal_m"] is None
    assert summary["real_time_factor"] is None
    assert summary["margin_violations"] == 0
    assert summary["seed"] == 42
    assert summary["versions"] == {"sinuous": "0.1.0"}


def test_a_run_without_steps_has_a_summary() -> None:
    summary = summarise(make_run(0), wall_time=1.0)
    assert summary["tip_error_rms_m"] is None
    assert summary["tip_error_final_m"] is None
    assert summary["solve_time_s"] == {"median": None, "p99": None, "max": None}
    assert summary["real_time_factor"] == 0.0


def test_people_read_millimetres_and_milliseconds() -> None:
    stream = io.StringIO()
    run = make_run(1, actual_tip=[np.array([0.0012345, 0.0, 0.0])], status=["holding"])
    print_summary(Console(file=stream, width=80), summarise(run, wall_time=0.01), title="free")
    text = stream.getvalue()
    for expected in ("free", "1.234 mm", "1.000 ms", "no wall", "10 x", "42"):
        assert expected in text
