"""`sinuous bench`: measure, print, write, draw."""

from pathlib import Path
from typing import TYPE_CHECKING

from rich.console import Console

from sinuous.bench.machine import one_thread
from sinuous.cli.arguments import Bench
from sinuous.cli.bench_progress import BenchProgress
from sinuous.cli.bench_rod import refuse_rod
from sinuous.cli.codes import GOOD
from sinuous.errors import InputError

if TYPE_CHECKING:
    from sinuous.bench.benchmark import Benchmark


def bench(arguments: Bench) -> int:
    """Run a benchmark in one thread and show what it found."""
    one_thread()  # before numpy is loaded
    from sinuous.bench.printer import print_result
    from sinuous.files import file_error, write_text

    for option, name in (("--out", arguments.out), ("--json", arguments.json)):
        if name is not None and not name.strip():
            raise InputError(
                file=option, expected="a name", found="an empty one", remedy="Name one."
            )
    out = Path(arguments.out)
    try:
        out.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise file_error(out, error, expected="a folder that can be written") from error
    console, benchmark = Console(), _benchmark(arguments)
    with BenchProgress(console, arguments.what) as progress:
        result = benchmark.run(arguments.quick, progress.observe)
    print_result(console, result)
    if arguments.json is not None:
        write_text(arguments.json, result.as_json())
        console.print(arguments.json, markup=False, highlight=False, soft_wrap=True)
    try:
        figures = benchmark.draw(result, out)
    except OSError as error:
        raise file_error(out, error, expected="a folder that can be written") from error
    for figure in figures:
        console.print(str(figure), markup=False, highlight=False, soft_wrap=True)
    return GOOD


def _benchmark(arguments: Bench) -> "Benchmark":
    if arguments.what == "rod":
        from sinuous.cli.bench_rod import rod_task

        return rod_task(arguments).benchmark()
    refuse_rod(arguments)
    match arguments.what:
        case "mpc":
            from sinuous.bench.mpc import MPC

            return MPC
        case "scaling":
            from sinuous.bench.scaling import SCALING

            return SCALING
        case "tails":
            from sinuous.bench.tails import TAILS

            return TAILS
        case "rate":
            from sinuous.bench.rate import RATE

            return RATE
        case "qp":
            from sinuous.bench.qp import QP

            return QP
        case "ik":
            from sinuous.bench.ik import IK

            return IK
        case "link":
            from sinuous.bench.link import LINK

            return LINK
        case "startup":
            from sinuous.bench.startup import STARTUP

            return STARTUP
