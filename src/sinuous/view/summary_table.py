"""A summary as a table for people."""

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.table import Table

from sinuous.view.units import factor, millimetres, milliseconds

NO_WALL = "no wall"


def summary_rows(summary: Mapping[str, Any]) -> list[tuple[str, str]]:
    """What `summarise` returns as (label, text) in millimetres and milliseconds."""
    times = summary["solve_time_s"]
    return [
        ("tip error, RMS", millimetres(summary["tip_error_rms_m"])),
        ("tip error, last step", millimetres(summary["tip_error_final_m"])),
        ("least clearance, nominal", millimetres(summary["min_clearance_nominal_m"], NO_WALL)),
        ("least clearance, actual", millimetres(summary["min_clearance_actual_m"], NO_WALL)),
        ("margin violations", _count(summary["margin_violations"])),
        ("solver failures", _count(summary["solver_failures"])),
        ("solve time, median", milliseconds(times["median"])),
        ("solve time, 99th percentile", milliseconds(times["p99"])),
        ("solve time, longest", milliseconds(times["max"])),
        ("real-time factor", factor(summary["real_time_factor"])),
        ("seed", str(summary["seed"])),
    ]


def print_summary(
    console: Console, summary: Mapping[str, Any], *, title: str | None = None
) -> None:
    """Print what `summarise` returns; counts that should be zero and are not stand out."""
    table = Table(title=title, show_header=False)
    table.add_column(style="bold")
    table.add_column(justify="right")
    bad = {"margin violations": "margin_violations", "solver failures": "solver_failures"}
    for label, text in summary_rows(summary):
        alarming = label in bad and summary[bad[label]] > 0
        table.add_row(label, text, style="red" if alarming else None)
    console.print(table)


def _count(number: int) -> str:
    return str(number) if number else "none"
