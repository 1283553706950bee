"""How far a run is: a bar on a terminal, lines elsewhere."""

from math import ceil
from time import perf_counter
from types import TracebackType
from typing import Self

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn

from sinuous.recording import Sample
from sinuous.scenario import Scenario
from sinuous.session import steps_per_sample
from sinuous.view.units import MM_PER_M

LINE_EVERY = 100  # steps between two lines where there is no terminal


class RunProgress:
    """Shows every step of a run.

    Arguments:
        console: where to
        scenario: what is run
    """

    def __init__(self, console: Console, scenario: Scenario) -> None:
        self._console = console
        dt = scenario.controller.dt
        self._steps = sum(ceil(leg.steps(dt) / steps_per_sample(dt)) for leg in scenario.path)
        self._done = 0
        self._began = perf_counter()
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            MofNCompleteColumn(),
            TextColumn("{task.fields[note]}"),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task(scenario.name, total=self._steps, start=False, note="")

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if kind is None:
            self._bar.update(self._task, total=self._done)
        self._bar.stop()

    def start(self) -> None:
        """The first step is about to run."""
        self._began = perf_counter()
        self._bar.start()
        self._bar.start_task(self._task)

    def observe(self, sample: Sample) -> None:
        """Show a step."""
        self._done += 1
        if self._console.is_terminal:
            self._bar.update(self._task, completed=self._done, note=self._note(sample))
        elif self._done % LINE_EVERY == 0:
            line = f"sample {self._done} of at most {self._steps}: {self._note(sample)}"
            self._console.print(line, highlight=False, soft_wrap=True)

    def _note(self, sample: Sample) -> str:
        error = float(np.linalg.norm(sample.actual_tip - sample.target)) * MM_PER_M
        speed = self._done / max(perf_counter() - self._began, 1e-9)
        clearance = sample.nominal_clearance * MM_PER_M
        room = f"clearance {clearance:.2f} mm" if np.isfinite(clearance) else "no wall"
        return f"{speed:.0f} samples/s, tip error {error:.3f} mm, {room}, {sample.status}"
