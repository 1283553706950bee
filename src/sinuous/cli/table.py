"""Two columns for people."""

from collections.abc import Sequence

import numpy as np
from rich.console import Console
from rich.table import Table
from rich.text import Text

from sinuous.arrays import ArrayLike
from sinuous.view.units import MM_PER_M

Rows = Sequence[tuple[str, str]]


def print_rows(console: Console, title: str, rows: Rows) -> None:
    """Print labels and texts under a title; nothing in them is markup."""
    table = Table(title=Text(title), title_justify="left", show_header=False)
    table.add_column(style="bold", no_wrap=True)
    table.add_column(overflow="fold")
    for label, text in rows:
        table.add_row(Text(label), Text(text))
    console.print(table)


def millimetres(values: ArrayLike) -> str:
    """Lengths [m] as millimetres."""
    return ", ".join(f"{value * MM_PER_M:.4g}" for value in np.ravel(values)) + " mm"
