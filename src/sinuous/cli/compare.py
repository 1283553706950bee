"""`sinuous compare`: two runs side by side."""

import json
from pathlib import Path
from typing import Any, cast

from rich.console import Console
from rich.table import Table
from rich.text import Text

from sinuous.cli.arguments import Compare
from sinuous.cli.codes import GOOD
from sinuous.errors import InputError
from sinuous.files import file_error, read_text
from sinuous.recording import Recording, read
from sinuous.session.folder import RECORDING, SUMMARY
from sinuous.summary import summarise
from sinuous.view import save_comparison
from sinuous.view.summary_table import summary_rows

Summary = dict[str, Any]


def compare(arguments: Compare) -> int:
    """Print the numbers of two runs and draw them into one figure."""
    if not arguments.out.strip():
        raise InputError(
            file="--out", expected="a folder", found="an empty name", remedy="Name a folder."
        )
    first, second = _load(arguments.first), _load(arguments.second)
    labels = _labels(arguments, first[0], second[0])
    out = Path(arguments.out)
    try:
        figures = save_comparison(
            first[0], second[0], out, labels=labels, summaries=(first[1], second[1])
        )
    except OSError as error:
        raise file_error(out, error, expected="a folder that can be written") from error
    console = Console()
    table = Table()
    table.add_column(no_wrap=True)
    for label in labels:
        table.add_column(Text(label), justify="right")
    rows = zip(summary_rows(first[1]), summary_rows(second[1]), strict=True)
    for (label, text), (_, other) in rows:
        table.add_row(label, text, other)
    console.print(table)
    for figure in figures:
        console.print(str(figure), markup=False, highlight=False, soft_wrap=True)
    return GOOD


def _load(name: str) -> tuple[Recording, Summary]:
    """A run, and its numbers: those in its folder know the wall time."""
    path = Path(name)
    if not name.strip():
        raise InputError(
            file="RUN", expected="the folder of a run", found="an empty name", remedy="Name one."
        )
    recording = read(path / RECORDING if path.is_dir() else path)
    beside = (path if path.is_dir() else path.parent) / SUMMARY
    summary = cast(Summary, summarise(recording))
    if beside.is_file():
        stored = _stored(beside)
        summary |= {key: stored[key] for key in summary.keys() & stored.keys()}
    return recording, summary


def _stored(path: Path) -> Summary:
    try:
        stored: object = json.loads(read_text(path))
    except ValueError:
        stored = None
    if isinstance(stored, dict):
        return cast(Summary, stored)
    raise InputError(
        file=str(path),
        expected="the summary of a run",
        found="something that is not a JSON object",
        remedy="Run it again, or remove this file.",
    )


def _labels(arguments: Compare, first: Recording, second: Recording) -> tuple[str, str]:
    """The names of the runs, or those of their folders if they are the same."""
    a, b = first.header.name, second.header.name
    if a == b:
        a, b = _folder(arguments.first), _folder(arguments.second)
    return (a, b) if a != b else (f"{a} (1)", f"{b} (2)")


def _folder(name: str) -> str:
    path = Path(name).resolve()
    return path.parent.name if path.name == RECORDING else path.name
