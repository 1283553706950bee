"""The numbers of a live session on a terminal."""

from typing import Any

from rich.console import Console
from rich.table import Table

LOOPS = {
    "tick_lateness_s": "1 kHz loop: late by",
    "tick_work_s": "1 kHz loop: takes",
    "step_lateness_s": "controller: begins late by",
    "solve_time_s": "controller: takes",
    "step_due_to_command_s": "controller: command after its step was due",
    "message_to_command_s": "oldest message to first command",
    "frame_lateness_s": "30 Hz view: late by",
    "idle_tick_lateness_s": "a 1 kHz loop that does nothing: late by",
}
MS_PER_S = 1e3


def print_live(console: Console, numbers: dict[str, Any]) -> None:
    """Lateness and what it led to."""
    table = Table(title=str(numbers["scenario"]))
    table.add_column("")
    for name in ("median", "p99", "max"):
        table.add_column(f"{name} [ms]", justify="right")
    for key, title in LOOPS.items():
        times = numbers[key]
        if times is not None:
            table.add_row(title, *(f"{MS_PER_S * times[k]:.3f}" for k in ("median", "p99", "max")))
    console.print(table)
    misses, steps = numbers["mpc_deadline_misses"], numbers["steps"]
    factor = numbers["real_time_factor"] or 0.0
    console.print(
        f"{numbers['simulated_s']:.1f} s at {factor:.3f} of real time; "
        f"{misses} of {steps} commands after the next step was due; "
        f"{numbers['margin_violations']} margin violations in {numbers['samples']} samples",
        highlight=False,
        soft_wrap=True,
    )
