"""A recording of a real robot: what its motors were told and where its tip was."""

import math
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.calibration.columns import Columns, Found, find
from sinuous.errors import InputError
from sinuous.files import read_text
from sinuous.robots.pcc import PccRobot

# Without tracking for this many times the usual interval, what happened meanwhile is unknown.
GAP = 10.0
# Largest share of the time that may be missing.
MOST_MISSING = 0.8
# Extent of the tip's positions as a share of the robot's length: beyond it the unit is wrong.
TIP_EXTENT = (0.02, 4.5)
# Travel of a motor as a multiple of the cables' pitch radius.
TRAVEL = (0.05, 20.0)
# Share of the travel of the farthest motor below which another stands still.
STILL = 1e-3
# Tip motion over motor motion, as a multiple of length over pitch radius.
RATIO = (0.1, 3.0)


@dataclass(frozen=True, kw_only=True, eq=False)
class Recording:
    """Rows in time order.

    Arguments:
        file: where they come from
        times: (T,) [s], increasing
        motors: names of the motors (M,)
        readings: of the motors (T, M) [m]
        tips: of the tip, in the tracker's frame (T, 3) [m]
        patterns: which movement each row belongs to (T,); numbers into `names`
        names: of the movements
    """

    file: str
    times: Array
    motors: tuple[str, ...]
    readings: Array
    tips: Array
    patterns: IntArray
    names: tuple[str, ...]

    def rows(self, chosen: BoolArray) -> "Recording":
        """Only those rows."""
        return replace(
            self,
            times=self.times[chosen],
            readings=self.readings[chosen],
            tips=self.tips[chosen],
            patterns=self.patterns[chosen],
        )

    @property
    def gaps(self) -> IntArray:
        """Rows after which nothing was recorded for long."""
        steps = np.diff(self.times)
        return np.flatnonzero(steps > GAP * np.median(steps)) if len(steps) else np.zeros(0, int)


def read_recording(path: str | Path, columns: Columns | None = None) -> Recording:
    """Return what stands in a CSV file.

    Arguments:
        path: of the file; its first row names the columns
        columns: what the user says about them

    Raises:
        InputError: naming row and column, if something is missing, not a finite number, or the
            times do not increase
    """
    file = str(path)
    lines = [line.split(",") for line in read_text(path).splitlines() if line.strip()]
    if len(lines) < 2:
        raise InputError(
            file=file,
            expected="a header and rows of numbers",
            found="no row" if lines else "an empty file",
            remedy="Record the robot first: docs/calibration.md says what is needed.",
        )
    header = [cell.strip() for cell in lines[0]]
    found = find(header, columns or Columns(), file=file)
    values = _numbers(lines, header, found, file)
    count = len(found.motors)
    labels = [_label(row, found.pattern) for row in lines[1:]]
    names = tuple(dict.fromkeys(labels))
    order = {name: number for number, name in enumerate(names)}
    recording = Recording(
        file=file,
        times=values[:, 0],
        motors=tuple(header[index] for index in found.motors),
        readings=values[:, 1 : 1 + count] * np.array(found.cable_scale),
        tips=values[:, 1 + count :] * np.array(found.tip_scale),
        patterns=np.array([order[label] for label in labels]),
        names=names,
    )
    _check_times(recording)
    return recording


def _label(row: list[str], column: int | None) -> str:
    """The movement of a row; a pause that keeps its end belongs to it."""
    if column is None or column >= len(row):
        return "all"
    return row[column].strip().removesuffix("_hold")


def _numbers(lines: list[list[str]], header: list[str], found: Found, file: str) -> Array:
    out = np.empty((len(lines) - 1, len(found.numbers)))
    for number, cells in enumerate(lines[1:]):
        for k, index in enumerate(found.numbers):
            text = cells[index].strip() if index < len(cells) else ""
            try:
                out[number, k] = float(text)
            except ValueError:
                out[number, k] = math.nan
            if not math.isfinite(out[number, k]):
                raise InputError(
                    file=file,
                    field=f"row {number + 2}, column {header[index]}",
                    expected="a finite number",
                    found=f'"{text}"' if text else "nothing",
                    remedy="Take rows without a number out; the rest can be used.",
                )
    return out


def _check_times(recording: Recording) -> None:
    late = np.flatnonzero(np.diff(recording.times) <= 0.0)
    if late.size:
        raise InputError(
            file=recording.file,
            field=f"row {late[0] + 3}",
            expected="a time after the one before",
            found=f"{recording.times[late[0] + 1]:.6f} s",
            remedy="Sort the rows by time, and keep one recording in a file.",
        )
    steps = np.diff(recording.times)
    missing = float(np.sum(steps[recording.gaps]))
    if steps.size and missing > MOST_MISSING * float(np.sum(steps)):
        first = int(recording.gaps[0])
        raise InputError(
            file=recording.file,
            field=f"row {first + 3}",
            expected="a recording without long gaps: what the motors did in between decides how "
            "the robot stands after it",
            found=f"gaps that make {missing:.0f} s of {np.sum(steps):.0f} s, one of "
            f"{steps[first]:.0f} s here",
            remedy="Record again, or leave the pieces before and after out.",
        )


def check_fits(recording: Recording, robot: PccRobot) -> None:
    """Refuse a recording that cannot be one of this robot.

    Raises:
        InputError: if there are not as many motors as cables, nothing moves, or a unit is wrong
    """
    _check_motors(recording, len(robot.actuator_names))
    _check_moves(recording)
    check_units(recording, robot)


def check_units(recording: Recording, robot: PccRobot) -> None:
    """Refuse a recording whose numbers are too large or too small for this robot.

    Raises:
        InputError: if a unit is wrong
    """
    length = sum(segment.home_length for segment in robot.segments)
    pitch = float(np.mean(np.concatenate([segment.pitch_radii for segment in robot.segments])))
    away = recording.tips - np.median(recording.tips, axis=0)
    extent = 2.0 * float(np.max(np.linalg.norm(away, axis=1)))
    way = float(np.max(np.ptp(recording.readings, axis=0)))
    slow, fast = RATIO
    for what, value, share, limits, of in (
        ("tip", extent, extent / length, TIP_EXTENT, f"a robot of {1e3 * length:.0f} mm"),
        ("cable", way, way / pitch, TRAVEL, f"cables {1e3 * pitch:.1f} mm from the backbone"),
        ("cable", way, way * length / max(extent * pitch, 1e-12), (1.0 / fast, 1.0 / slow),
         f"a tip that moves through {1e3 * extent:.0f} mm"),
    ):  # fmt: skip
        if not limits[0] <= share <= limits[1]:
            raise InputError(
                file=recording.file,
                field=f"{what} columns",
                expected=f"movements that fit {of}",
                found=f"{1e3 * value:.4g} mm, far too {'little' if share < limits[0] else 'much'}",
                remedy=f"Is the unit right? Name it with --{what}-unit mm, cm or m.",
            )


def _check_motors(recording: Recording, cables: int) -> None:
    if len(recording.motors) != cables:
        raise InputError(
            file=recording.file,
            field="row 1",
            expected=f"{cables} motors, one for each cable of the robot",
            found=f"{len(recording.motors)}: {', '.join(recording.motors)}",
            remedy="Name them with --motors, or take the robot file that has as many cables.",
        )


def _check_moves(recording: Recording) -> None:
    travel = np.ptp(recording.readings, axis=0)
    least = STILL * float(np.max(travel))
    still = [name for name, way in zip(recording.motors, travel, strict=True) if way <= least]
    if still or np.all(recording.tips == recording.tips[0]):
        raise InputError(
            file=recording.file,
            expected="a recording in which every motor and the tip move",
            found=f"{', '.join(still)} standing still" if still else "a tip that stands still",
            remedy="Record movements of every cable: what stands still cannot be fitted.",
        )
