"""`sinuous run`: a scenario with a progress bar, its table and its figures."""

import sys
from pathlib import Path

from rich.console import Console

from sinuous.cli.arguments import Run, assignments
from sinuous.cli.codes import GOOD, INTERRUPTED, NEGATIVE
from sinuous.cli.progress import RunProgress
from sinuous.files import file_error
from sinuous.scenario import load_scenario
from sinuous.session import End, Result
from sinuous.session import run as run_scenario
from sinuous.session.folder import FIGURES
from sinuous.view import print_summary, save_figures

CODES = {End.FINISHED: GOOD, End.INTERRUPTED: INTERRUPTED, End.PLANT_FAILED: NEGATIVE}


def run(arguments: Run) -> int:
    """Run a scenario and show what happened."""
    console = Console()
    scenario = load_scenario(arguments.scenario, set=assignments(arguments.set))
    with RunProgress(console, scenario) as progress:
        result = run_scenario(
            scenario, out=arguments.out, started=progress.start, observe=progress.observe
        )
    print_summary(console, result.summary, title=scenario.name)
    figures = _save_figures(result, Path(arguments.out) / FIGURES)
    console.print(f"Recording, summary and figures: {arguments.out}", markup=False, soft_wrap=True)
    for figure in figures:
        console.print(f"  {figure}", markup=False, highlight=False, soft_wrap=True)
    if result.end is not End.FINISHED:
        why = f": {result.fault}" if result.fault else ""
        print(f"sinuous: {result.end.value}{why}", file=sys.stderr)
    return CODES[result.end]


def _save_figures(result: Result, folder: Path) -> list[Path]:
    try:
        return save_figures(result.recording, folder)
    except OSError as error:
        raise file_error(folder, error, expected="a folder that can be written") from error
