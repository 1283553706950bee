"""How far a benchmark is: a bar on a terminal, lines elsewhere."""

from types import TracebackType
from typing import Self

from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn


class BenchProgress:
    """Shows what is measured.

    Arguments:
        console: where to
        name: of the benchmark
    """

    def __init__(self, console: Console, name: str) -> None:
        self._console = console
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TimeElapsedColumn(),
            TextColumn("{task.fields[note]}"),
            console=console,
            disable=not console.is_terminal,
            refresh_per_second=1,  # it shares the processor with what is measured
        )
        self._task = self._bar.add_task(name, total=None, note="")

    def __enter__(self) -> Self:
        self._bar.start()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        self._bar.stop()

    def observe(self, note: str, done: int, total: int) -> None:
        """Show what is measured next."""
        if self._console.is_terminal:
            self._bar.update(self._task, completed=done, total=total, note=note)
        elif done < total:
            self._console.print(
                f"part {done + 1} of {total}, {note}", highlight=False, soft_wrap=True
            )
