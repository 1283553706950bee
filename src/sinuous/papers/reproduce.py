"""Runs a paper's experiments and leaves data, figures and claims in a folder."""

import json
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path
from time import perf_counter

from sinuous.bench.machine import machine, versions
from sinuous.bench.result import plain
from sinuous.files import file_error, write_text
from sinuous.papers.claims import Claim, rows
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.workers import Observe, ignore, workers
from sinuous.view.style import stamped

QUICK_STAMP = "quick run: too short to judge by"
CLAIMS = "claims.json"
DATA, FIGURES = "data", "figures"


@dataclass(frozen=True, kw_only=True)
class Paper:
    """A paper.

    Arguments:
        name: on the command line
        title: who wrote what
        experiments: in the order in which to run them
        claims: in the paper's order
    """

    name: str
    title: str
    experiments: tuple[Experiment, ...]
    claims: tuple[Claim, ...]


@dataclass(frozen=True, kw_only=True)
class Reproduced:
    """What came out.

    Arguments:
        claims: rows of `claims.json`
        figures: their files
        seconds: how long each experiment took, by its name
    """

    claims: list[dict[str, object]]
    figures: list[Path]
    seconds: dict[str, float]


def reproduce(
    paper: Paper,
    out: Path,
    *,
    only: Sequence[str] = (),
    quick: bool = False,
    processes: int = 1,
    observe: Observe = ignore,
    finished: Callable[[Experiment, float], None] = ignore,
) -> Reproduced:
    """Run experiments and write `data/NAME.json`, `figures/NAME/*.png` and `claims.json`.

    Data are written before figures are drawn, and figures and claims come from the data alone.

    Arguments:
        out: folder, made if it is not there
        only: names of experiments, all if empty; claims that need others stay open
        quick: short versions, which say so in every figure
        processes: how many to use
        observe: hears how far an experiment is
        finished: hears of every experiment that is done and its time [s]

    Raises:
        InputError: if the folder cannot be written
    """
    found, figures, seconds = dict[str, Data](), list[Path](), dict[str, float]()
    chosen = [one for one in paper.experiments if not only or one.name in only]
    with workers(processes, observe) as team:
        for experiment in chosen:
            began = perf_counter()
            data = experiment.run(team, quick)
            text = json.dumps(plain({"quick": quick, **data}), allow_nan=False)
            write_text(out / DATA / f"{experiment.name}.json", text + "\n")
            found[experiment.name] = json.loads(text)
            seconds[experiment.name] = perf_counter() - began
            observe(f"{experiment.title}: figures", 0, 1)
            with stamped(QUICK_STAMP if quick else ""):
                figures += _draw(experiment, found[experiment.name], out)
            finished(experiment, perf_counter() - began)
    claims = rows(paper.claims, found)
    whole = {
        "paper": paper.title,
        "quick": quick,
        "versions": versions(),
        "machine": machine(),
        "seconds": seconds,
        "claims": claims,
    }
    write_text(out / CLAIMS, json.dumps(plain(whole), indent=1, allow_nan=False) + "\n")
    return Reproduced(claims=claims, figures=figures, seconds=seconds)


def _draw(experiment: Experiment, data: Data, out: Path) -> list[Path]:
    folder = out / FIGURES / experiment.name
    try:
        folder.mkdir(parents=True, exist_ok=True)
        return experiment.draw(data, folder)
    except OSError as error:
        raise file_error(folder, error, expected="a folder that can be written") from error
