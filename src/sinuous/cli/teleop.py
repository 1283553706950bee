"""`sinuous teleop`: a scenario in real time."""

import json
import sys
from contextlib import ExitStack
from pathlib import Path

from rich.console import Console

from sinuous.cli.arguments import assignments
from sinuous.cli.browser import check_duration, check_port, open_page
from sinuous.cli.codes import GOOD, INTERRUPTED, NEGATIVE
from sinuous.cli.teleop_arguments import Teleop
from sinuous.cli.teleop_leaders import GIZMO, RECORDED, leader_choice
from sinuous.cli.teleop_table import print_live
from sinuous.errors import InputError
from sinuous.files import write_text
from sinuous.live import LiveEnd, LiveSession, Recipe
from sinuous.view.page.hands import hands_of
from sinuous.view.page.supervisor import PageSupervisor

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
    attended = sys.stdout.isatty()
    name = arguments.leader or (GIZMO if arguments.browser and attended else RECORDED)
    hand = leader_choice(name)
    recipe = Recipe(arguments.scenario, (*hand.fields, *assignments(arguments.set)))
    duration = arguments.duration
    if duration is None and not attended:
        duration = SHOW
    end = "Ctrl-C ends it." if duration is None else f"It ends after {duration:g} s."
    with ExitStack() as stack:
        if arguments.browser:
            page = stack.enter_context(
                PageSupervisor(
                    port=arguments.port,
                    hands=hands_of(name, hand.make),
                    ready=_Opener(console, end),
                    lost=_complain,
                )
            )
            session = LiveSession(
                recipe,
                hand.make,
                baseline=arguments.baseline,
                patient=True,
                started=page.started,
                observe=page.observe,
                recording=page.recording,
                failed=lambda fault: _failed(page, fault),
                refused=page.tell,
            )
            page.serve(session)
        else:
            session = LiveSession(
                recipe,
                hand.make,
                baseline=arguments.baseline,
                started=lambda scenario, _: _say(console, f"Live: {scenario.name}. {end}"),
            )
        result = session.run(duration, record=arguments.out)
    print_live(console, result.numbers)
    if arguments.json is not None:
        numbers = {**result.numbers, "end": result.end.name.lower(), "fault": result.fault}
        write_text(Path(arguments.json), json.dumps(numbers, indent=2) + "\n")
    if CODES[result.end] != GOOD:
        why = f": {result.fault}" if result.fault else ""
        print(f"sinuous: {result.end.value}{why}", file=sys.stderr)
    return CODES[result.end]


class _Opener:
    """Says where the page is, and opens it the first time.

    Arguments:
        console: to say it
        end: what ends the session
    """

    def __init__(self, console: Console, end: str) -> None:
        self._console, self._end, self._opened = console, end, False

    def __call__(self, address: str) -> None:
        _say(self._console, f"{address}  {self._end}")
        if not self._opened:
            self._opened = True
            open_page(address)


def _failed(page: PageSupervisor, fault: str) -> None:
    _complain(f"{fault}; the robot holds still: Reset on the page, or Ctrl-C")
    page.tell(f"{fault}\nThe robot holds still. Reset begins again.", lasting=True)


def _say(console: Console, text: str) -> None:
    console.print(text, markup=False, highlight=False, soft_wrap=True)


def _complain(text: str) -> None:
    print(f"sinuous: {text}", file=sys.stderr, flush=True)


def _check(arguments: Teleop) -> None:
    """Refuse what would be found out too late, in another process.

    Raises:
        InputError: if duration, port or hand cannot be
    """
    check_duration(arguments.duration)
    check_port(arguments.port)
    if arguments.leader == GIZMO and not arguments.browser:
        raise InputError(
            file="--leader",
            expected="a hand that needs no page, with --no-browser",
            found=f'"{GIZMO}", which is dragged on the page',
            remedy="Leave --no-browser out, or take another hand, such as --leader recorded.",
        )
