"""Two columns for people."""

from collections.abc import Sequence

from rich.console import Console
from rich.table import Table
from rich.text import Text

Rows = Sequence[tuple[str, str]]


def print_rows(console: Console, title: str, rows: Rows) -> None:
    """Print labels and texts under a title; nothing in them is markup."""
    table = Table(title=Text(title), title_justify="left", show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for label, text in rows:
        table.add_row(Text(label), Text(text))
    console.print(table)
