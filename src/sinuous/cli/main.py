"""Parse, call, and turn what happened into an exit code.

Nothing that computes is imported before it is needed, so that help and mistakes are instant.
"""

import sys
from collections.abc import Sequence

import tyro

from sinuous.cli.arguments import Bench, Check, Compare, Export, Reproduce, Run
from sinuous.cli.calibrate_arguments import Calibrate
from sinuous.cli.codes import BAD_INPUT, GOOD, INTERRUPTED
from sinuous.cli.replay_arguments import Replay
from sinuous.cli.teleop_arguments import Teleop
from sinuous.errors import InputError


def main(argv: Sequence[str] | None = None) -> int:
    """Run a command line and return its exit code.

    Arguments:
        argv: the arguments without the program's name, None for those of the process
    """
    try:
        verb = tyro.cli(
            Run | Teleop | Replay | Check | Calibrate | Export | Compare | Reproduce | Bench,  # pyright: ignore[reportArgumentType]
            prog="sinuous",
            description="Steer tendon-driven continuum robots inside a mesh without touching it.",
            args=None if argv is None else list(argv),
        )
    except SystemExit as stop:  # help, or a mistake that tyro has explained
        return stop.code if isinstance(stop.code, int) else GOOD
    try:
        return _call(verb)
    except InputError as error:
        print(f"sinuous: {error}", file=sys.stderr)
        return BAD_INPUT
    except KeyboardInterrupt:
        print("sinuous: interrupted", file=sys.stderr)
        return INTERRUPTED


def _call(
    verb: Run | Teleop | Replay | Check | Calibrate | Export | Compare | Reproduce | Bench,
) -> int:
    match verb:
        case Run():
            from sinuous.cli.run import run

            return run(verb)
        case Teleop():
            from sinuous.cli.teleop import teleop

            return teleop(verb)
        case Replay():
            from sinuous.cli.replay import replay

            return replay(verb)
        case Check():
            from sinuous.cli.check import check

            return check(verb)
        case Calibrate():
            from sinuous.cli.calibrate import run_calibrate

            return run_calibrate(verb)
        case Export():
            from sinuous.cli.export import export

            return export(verb)
        case Compare():
            from sinuous.cli.compare import compare

            return compare(verb)
        case Reproduce():
            from sinuous.cli.reproduce import reproduce

            return reproduce(verb)
        case Bench():
            from sinuous.cli.bench import bench

            return bench(verb)
