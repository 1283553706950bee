"""`sinuous teleop`: a scenario in real time."""

import json
import sys
from pathlib import Path

from rich.console import Console

from sinuous.cli.arguments import assignments
from sinuous.cli.codes import GOOD, INTERRUPTED, NEGATIVE
from sinuous.cli.teleop_arguments import Teleop
from sinuous.cli.teleop_leaders import leader_choice
from sinuous.cli.teleop_table import print_live
from sinuous.errors import InputError
from sinuous.files import write_text
from sinuous.live import LiveEnd, LiveSession, Recipe

CODES = {
    LiveEnd.FINISHED: GOOD,
    LiveEnd.STOPPED: GOOD,
    LiveEnd.INTERRUPTED: INTERRUPTED,
    LiveEnd.FAILED: NEGATIVE,
}
SHOW = 20.0  # how long a session lasts that nobody can end [s]


def teleop(arguments: Teleop) -> int:
    """Run a scenario in real time and say how it went."""
    console = Console()
    _check(arguments)
    hand = leader_choice(arguments.leader)
    session = LiveSession(
        Recipe(arguments.scenario, (*hand.fields, *assignments(arguments.set))),
        hand.make,
        baseline=arguments.baseline,
        started=lambda scenario: console.print(
            f"Live: {scenario.name}. Ctrl-C ends it.", markup=False, highlight=False
        ),
    )
    duration = arguments.duration
    if duration is None and not sys.stdout.isatty():
        duration = SHOW
    result = session.run(duration, record=arguments.out)
    print_live(console, result.numbers)
    if arguments.json is not None:
        numbers = {**result.numbers, "end": result.end.name.lower(), "fault": result.fault}
        write_text(Path(arguments.json), json.dumps(numbers, indent=2) + "\n")
    if CODES[result.end] != GOOD:
        why = f": {result.fault}" if result.fault else ""
        print(f"sinuous: {result.end.value}{why}", file=sys.stderr)
    return CODES[result.end]


def _check(arguments: Teleop) -> None:
    """Refuse what would be found out too late, in another process.

    Raises:
        InputError: if the duration is not positive
    """
    if arguments.duration is not None and not 0.0 < arguments.duration < float("inf"):
        raise InputError(
            file="--duration",
            expected="a positive number of seconds",
            found=f"{arguments.duration:g}",
            remedy="Write for example --duration 20.",
        )
