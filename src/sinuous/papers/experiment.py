"""One experiment of a paper: it runs, leaves plain data, and draws figures from that alone."""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from sinuous.papers.workers import Workers

Data = Mapping[str, Any]
"""What an experiment found, in JSON's types; keys carry their unit."""


@dataclass(frozen=True, kw_only=True)
class Experiment:
    """A part of a paper's evaluation.

    Arguments:
        name: of its data file and of its folder of figures
        title: in words
        section: of the paper
        run: does it; the second argument asks for a short version that shows that all of it
            works
        draw: writes its figures to a folder that exists and returns their paths
    """

    name: str
    title: str
    section: str
    run: Callable[[Workers, bool], Data]
    draw: Callable[[Data, Path], list[Path]]
