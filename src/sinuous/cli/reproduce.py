"""`sinuous reproduce`: a paper's experiments, with its claims as a table."""

import os
from pathlib import Path

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sinuous.bench.machine import one_thread
from sinuous.cli.arguments import Reproduce
from sinuous.cli.bench_progress import BenchProgress
from sinuous.cli.codes import GOOD
from sinuous.errors import InputError

HOLDS = {True: ("holds", "green"), False: ("does not hold", "red"), None: ("open", "yellow")}
PAPER_WIDTH = 160  # characters of a line where there is no terminal


def reproduce(arguments: Reproduce) -> int:
    """Run the experiments and print what became of every claim."""
    one_thread()  # before numpy is loaded, here and in the workers
    from sinuous.papers import reproduce as papers
    from sinuous.papers.experiment import Experiment
    from sinuous.papers.shelf import PAPERS
    from sinuous.papers.workers import ignore

    paper = PAPERS[arguments.paper]
    _check(arguments, [one.name for one in paper.experiments])
    console, out = Console(), Path(arguments.out)
    with BenchProgress(console, arguments.paper) as progress:

        def finished(experiment: Experiment, seconds: float) -> None:
            console.print(f"{experiment.title}: {seconds:.0f} s", highlight=False, soft_wrap=True)

        done = papers.reproduce(
            paper,
            out,
            only=arguments.only,
            quick=arguments.quick,
            processes=arguments.processes or os.cpu_count() or 1,
            # Without a terminal a line for each experiment is enough.
            observe=progress.observe if console.is_terminal else ignore,
            finished=finished,
        )
    _print_claims(console, done.claims)
    for name, count in ((papers.CLAIMS, len(done.claims)), (papers.FIGURES, len(done.figures))):
        console.print(f"{out / name}: {count}", markup=False, highlight=False, soft_wrap=True)
    if arguments.quick:
        console.print("A quick run: verdicts from so few runs say little.", highlight=False)
    return GOOD


def _check(arguments: Reproduce, names: list[str]) -> None:
    out = Path(arguments.out)
    if not arguments.out.strip() or (out.exists() and not out.is_dir()):
        raise InputError(
            file="--out",
            expected="a folder",
            found=f'"{arguments.out}"',
            remedy=f"Name a folder, like --out out/{arguments.paper}.",
        )
    for name in arguments.only:
        if name not in names:
            raise InputError(
                file="--only",
                expected=f"one of {', '.join(names)}",
                found=f'"{name}"',
                remedy="Leave it out to run all.",
            )
    if arguments.processes is not None and arguments.processes < 1:
        raise InputError(
            file="--processes",
            expected="one or more",
            found=str(arguments.processes),
            remedy="Leave it out to use every core.",
        )


def _print_claims(console: Console, claims: list[dict[str, object]]) -> None:
    screen = console if console.is_terminal else Console(file=console.file, width=PAPER_WIDTH)
    table = Table(box=SIMPLE_HEAD, padding=(0, 1, 0, 0))
    for title in ("section", "the paper says", "measured here", "verdict"):
        table.add_column(title, overflow="fold")
    for claim in claims:
        word, color = HOLDS[claim["holds"]]  # pyright: ignore[reportArgumentType]
        measured = str(claim["measured"])
        if claim["reason"]:
            measured = f"{measured}; {claim['reason']}" if measured else str(claim["reason"])
        table.add_row(
            Text(str(claim["section"])),
            Text(str(claim["printed"])),
            Text(measured),
            Text(word, style=color),
        )
    screen.print(table)
