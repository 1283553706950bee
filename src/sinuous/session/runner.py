"""Runs a scenario to its end and keeps what happened, however it ends."""

import signal
import threading
from collections.abc import Callable, Generator
from contextlib import contextmanager, nullcontext
from dataclasses import dataclass
from enum import Enum
from pathlib import Path
from time import perf_counter
from typing import Any

from sinuous.measurement import Measurement
from sinuous.plants.plant import PlantFault
from sinuous.recording import Recording, Sample
from sinuous.scenario import Scenario
from sinuous.scenario.start import check_start
from sinuous.session.folder import RunFolder
from sinuous.session.header import make_header
from sinuous.session.loop import steps
from sinuous.summary import summarise


class End(Enum):
    """How a run ended."""

    FINISHED = "finished: the path is done"
    INTERRUPTED = "interrupted: what ran until then is kept"
    PLANT_FAILED = "the plant failed"


@dataclass(frozen=True, kw_only=True, eq=False)
class Result:
    """A run.

    Arguments:
        recording: every step
        summary: what `sinuous.summary.summarise` says about it
        end: how the run ended
        fault: of the plant; empty if there was none
    """

    recording: Recording
    summary: dict[str, Any]
    end: End
    fault: str = ""


def _nothing(*_: object) -> None:
    pass


def run(
    scenario: Scenario,
    *,
    out: str | Path | None = None,
    started: Callable[[], None] = _nothing,
    observe: Callable[[Sample], None] = _nothing,
) -> Result:
    """Run a scenario to its end, or until Ctrl-C or a failure of the plant.

    Arguments:
        scenario: what to do
        out: folder for `run.mcap` and `summary.json`, None to write nothing
        started: called when everything is ready for the first step
        observe: called with every step

    Raises:
        InputError: if the robot may not start where it stands, or the folder cannot be
            written; what was recorded before a disk got full stays readable
    """
    check_start(scenario)
    folder = None if out is None else RunFolder.prepare(out)
    warm_up(scenario)
    header = make_header(scenario)
    samples, end, fault = list[Sample](), End.FINISHED, ""
    opened = nullcontext() if folder is None else folder.record(header)
    with opened as recorder, interruptible() as interrupted:
        started()
        began = perf_counter()
        try:
            for sample in steps(scenario):
                if recorder is not None:
                    recorder.write(sample)
                samples.append(sample)
                observe(sample)
                if interrupted.is_set():
                    end = End.INTERRUPTED
                    break
        except KeyboardInterrupt:
            end = End.INTERRUPTED
        except PlantFault as error:
            end, fault = End.PLANT_FAILED, str(error)
        wall_time = perf_counter() - began
    recording = Recording.from_samples(header, samples)
    summary = summarise(recording, wall_time=wall_time)
    if folder is not None:
        folder.write_summary(summary)
    return Result(recording=recording, summary=summary, end=end, fault=fault)


def warm_up(scenario: Scenario) -> None:
    """Compile what the first step needs, so that no solve time contains it."""
    controller, c = scenario.controller, scenario.first_configuration
    robot, target = scenario.robot, scenario.path[0].at(controller.dt)
    measured = Measurement(tip=robot.tip(c), points=robot.points(c), lengths=robot.lengths(c))
    controller.step(controller.init(c), target, measured)


@contextmanager
def interruptible() -> Generator[threading.Event]:
    """Let Ctrl-C end the run between two steps; a second one ends it at once."""
    asked = threading.Event()
    if threading.current_thread() is not threading.main_thread():
        yield asked  # only the main thread may handle signals
        return

    def ask(number: int, frame: object) -> None:
        if asked.is_set():
            raise KeyboardInterrupt
        asked.set()

    before = signal.signal(signal.SIGINT, ask)
    try:
        yield asked
    finally:
        signal.signal(signal.SIGINT, before)
