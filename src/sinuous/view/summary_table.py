"""A summary as a table for people."""

from collections.abc import Mapping
from typing import Any

from rich.console import Console
from rich.table import Table

from sinuous.view.units import factor, millijoules, millimetres, milliseconds, newtons, percent

NO_WALL = "no wall"
SLACK, CONTACTS = "steps with a slack cable", "steps that touched a wall"


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
        *_by_hand(summary["teleop"]),
        *_physics(summary["physics"]),
        ("seed", str(summary["seed"])),
    ]


def _by_hand(teleop: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    if teleop is None:
        return []
    return [
        ("tip to desired, RMS", millimetres(teleop["tracking_rms_m"])),
        ("force felt, RMS", newtons(teleop["felt_force_rms_n"])),
        ("force felt, largest", newtons(teleop["felt_force_max_n"])),
        ("energy made by the channel", millijoules(-teleop["channel_energy_least_j"])),
        ("ticks held by a fault", _count(teleop["fault_ticks"])),
    ]


def _physics(physics: Mapping[str, Any] | None) -> list[tuple[str, str]]:
    if physics is None:
        return []
    return [
        ("least cable tension", newtons(physics["least_tension_n"])),
        (SLACK, percent(physics["slack_fraction"])),
        (CONTACTS, _count(physics["wall_contacts"])),
        ("wall force, largest", newtons(physics["contact_force_max_n"])),
        ("deepest in a wall", millimetres(physics["penetration_max_m"])),
    ]


def print_summary(
    console: Console, summary: Mapping[str, Any], *, title: str | None = None
) -> None:
    """Print what `summarise` returns; counts that should be zero and are not stand out."""
    table = Table(title=title, show_header=False)
    table.add_column(style="bold")
    table.add_column(justify="right")
    physics = summary["physics"] or {}
    bad = {
        "margin violations": summary["margin_violations"],
        "solver failures": summary["solver_failures"],
        SLACK: physics.get("slack_fraction", 0),
        CONTACTS: physics.get("wall_contacts", 0),
    }
    for label, text in summary_rows(summary):
        table.add_row(label, text, style="red" if bad.get(label, 0) > 0 else None)
    console.print(table)


def _count(number: int) -> str:
    return str(number) if number else "none"
