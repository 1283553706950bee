"""`sinuous calibrate`: from recordings to a robot file."""

import sys
from pathlib import Path

import numpy as np
from rich.console import Console
from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn

from sinuous.calibration.calibrate import Calibration, calibrate, in_pieces
from sinuous.calibration.columns import Columns
from sinuous.calibration.figures import draw
from sinuous.calibration.recording import Recording, read_recording
from sinuous.calibration.report import as_json, rows, warnings
from sinuous.calibration.robot_text import robot_text
from sinuous.cli.calibrate_arguments import Calibrate
from sinuous.cli.codes import GOOD
from sinuous.cli.table import print_rows
from sinuous.errors import InputError
from sinuous.files import file_error, read_toml, write_text
from sinuous.robots.robot_file import load_pcc, load_robot, robot_path

# Steps of the fits that a calibration takes, about: what a whole bar stands for.
USUAL_STEPS = 70


def run_calibrate(arguments: Calibrate) -> int:
    """Calibrate a robot, write its file, and show how good it is."""
    _check_names(arguments)
    console = Console()
    robot, columns = load_pcc(arguments.robot), _columns(arguments)
    data = in_pieces(read_recording(arguments.data, columns))
    pulls = _maybe_read(arguments.pulls, columns)
    kept_back = _maybe_read(arguments.validate, columns)
    with _Bar(console) as bar:
        found = calibrate(data, robot, pulls=pulls, observe=bar.observe)
    judged = None if kept_back is None else found.validate(kept_back)
    print_rows(console, f"{arguments.data}: {robot.name}", rows(found, judged))
    for text in [*_gaps(data), *warnings(found)]:
        print(f"sinuous: {text}", file=sys.stderr)
    if arguments.json is not None:
        write_text(arguments.json, as_json(found, judged))
        console.print(arguments.json, markup=False, highlight=False, soft_wrap=True)
    if arguments.out is not None:
        write_text(arguments.out, _robot_text(arguments, found))
        load_robot(Path(arguments.out))  # what every other verb will do
        console.print(arguments.out, markup=False, highlight=False, soft_wrap=True)
    _draw(console, arguments, found, kept_back)
    return GOOD


def _gaps(data: Recording) -> list[str]:
    """What the user should know about rows that are missing."""
    rows = data.gaps
    if not len(rows):
        return []
    longest = float(np.max(np.diff(data.times)))
    return [
        f"{data.file} has {len(rows)} gaps, up to {longest:.0f} s: what friction did meanwhile "
        "is not known"
    ]


def _robot_text(arguments: Calibrate, found: Calibration) -> str:
    return robot_text(
        read_toml(robot_path(arguments.robot)),
        found.problem,
        found.found,
        x=found.fit.x,
        motors=found.motors,
        about=f"fitted to {Path(arguments.data).name}",
    )


def _draw(
    console: Console, arguments: Calibrate, found: Calibration, kept_back: Recording | None
) -> None:
    folder = _figures(arguments)
    if folder is None:
        return
    shown = None if kept_back is None else (kept_back, found.predict(kept_back))
    try:
        figures = draw(found, folder, validation=shown)
    except OSError as error:
        raise file_error(folder, error, expected="a folder that can be written") from error
    for figure in figures:
        console.print(str(figure), markup=False, highlight=False, soft_wrap=True)


def _figures(arguments: Calibrate) -> Path | None:
    if arguments.figures is not None:
        return Path(arguments.figures)
    if arguments.out is not None:
        out = Path(arguments.out)
        return out.with_name(f"{out.stem}_figures")
    return None


def _maybe_read(name: str | None, columns: Columns) -> Recording | None:
    return None if name is None else read_recording(name, columns)


def _columns(arguments: Calibrate) -> Columns:
    def names(text: str | None) -> tuple[str, ...]:
        return tuple(part.strip() for part in text.split(",")) if text else ()

    return Columns(
        time=arguments.time,
        motors=names(arguments.motors),
        tip=names(arguments.tip),
        pattern=arguments.pattern,
        cable_unit=arguments.cable_unit,
        tip_unit=arguments.tip_unit,
    )


def _check_names(arguments: Calibrate) -> None:
    for option in ("data", "robot", "pulls", "validate", "out", "json", "figures"):
        name: str | None = getattr(arguments, option)
        if name is not None and not name.strip():
            raise InputError(
                file="DATA" if option == "data" else f"--{option}",
                expected="a name",
                found="an empty one",
                remedy="Name one.",
            )
    if arguments.out is not None and Path(arguments.out).suffix != ".toml":
        raise InputError(
            file="--out",
            expected="a robot file ending in .toml",
            found=arguments.out,
            remedy="The other verbs know robot files by that ending.",
        )


class _Bar:
    """A bar on a terminal, a line for each part elsewhere."""

    def __init__(self, console: Console) -> None:
        self._console, self._last = console, ""
        self._bar = Progress(
            TextColumn("[bold]{task.description}"),
            BarColumn(),
            TimeElapsedColumn(),
            console=console,
            disable=not console.is_terminal,
        )
        self._task = self._bar.add_task("calibrate", total=USUAL_STEPS)

    def __enter__(self) -> "_Bar":
        self._bar.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._bar.stop()

    def observe(self, note: str) -> None:
        """One more step of that part."""
        if self._console.is_terminal:
            self._bar.update(self._task, description=note, advance=1.0)
        elif note != self._last:
            self._console.print(note, highlight=False, soft_wrap=True)
        self._last = note
