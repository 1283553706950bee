"""A result on the screen."""

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table as RichTable
from rich.text import Text

from sinuous.bench.result import Result

NAME = 12  # characters that are left for names on a narrow terminal
PAPER = 140  # characters of a line where there is no terminal


def print_result(console: Console, result: Result) -> None:
    """Print every table, then the notes; nothing in them is markup."""
    screen = console if console.is_terminal else Console(file=console.file, width=PAPER)
    for table in result.tables:
        shown = RichTable(
            title=Text(table.title), title_justify="left", box=SIMPLE_HEAD, padding=(0, 1, 0, 0)
        )
        first, *others = table.columns
        shown.add_column(Text(first.title), min_width=NAME)
        for column in others:
            texts = [column.title, *(column.text(row) for row in table.rows)]
            shown.add_column(Text(column.title), justify="right", min_width=max(map(len, texts)))
        for row in table.rows:
            shown.add_row(*(Text(column.text(row)) for column in table.columns))
        screen.print(shown)
    for note in result.notes:
        console.print(note, markup=False, highlight=False, soft_wrap=True)
