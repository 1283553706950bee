"""Recordings are read as they are meant, and what cannot be used is refused in words."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.made import ROBOT, as_csv, commands, recording, simulated, truth

from sinuous.calibration.columns import Columns
from sinuous.calibration.parameters import parameters
from sinuous.calibration.recording import Recording, check_fits, read_recording
from sinuous.errors import InputError

EXACT = 1e-15


@pytest.fixture(scope="module")
def moves() -> Recording:
    x = truth(1, parameters(ROBOT, own_zeros=False))
    return recording(simulated(x, commands(), [], seed=1), 0, start=100.0)


def written(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


def test_a_file_says_what_was_written(tmp_path: Path, moves: Recording) -> None:
    read = read_recording(written(tmp_path / "a.csv", as_csv(moves)))
    np.testing.assert_allclose(read.readings, moves.readings, atol=EXACT)
    np.testing.assert_allclose(read.tips, moves.tips, atol=EXACT)
    assert (read.motors, read.names) == (moves.motors, moves.names)
    np.testing.assert_array_equal(read.patterns, moves.patterns)
    check_fits(read, ROBOT)


def test_users_name_their_own_columns(tmp_path: Path, moves: Recording) -> None:
    header = {
        "timestamp": "clock",
        "pattern_label": "what",
        "tip_x": "px",
        "tip_y": "py",
        "tip_z": "pz",
    }
    header |= {name: name.removesuffix("_mm") for name in moves.motors}
    path = written(tmp_path / "a.csv", as_csv(moves, unit=1e2, header=header))
    said = Columns(
        time="clock", pattern="what", tip=("px", "py", "pz"), cable_unit="cm", tip_unit="cm",
        motors=tuple(header[name] for name in moves.motors),
    )  # fmt: skip
    read = read_recording(path, said)
    np.testing.assert_allclose(read.readings, moves.readings, atol=EXACT)
    np.testing.assert_allclose(read.tips, moves.tips, atol=EXACT)
    assert read.names == moves.names


def test_a_pause_belongs_to_its_movement(tmp_path: Path, moves: Recording) -> None:
    text = as_csv(moves).splitlines()
    text[3] = text[3].replace("movement 0", "movement 0_hold")
    read = read_recording(written(tmp_path / "a.csv", "\n".join(text)))
    assert read.names == moves.names


@pytest.mark.parametrize(
    ("change", "message"),
    [
        (lambda t: "", "a header and rows of numbers, found an empty file"),
        (lambda t: t.replace("tip_y", "tip_w"), r"row 1: expected columns of the tip.*--tip"),
        (lambda t: t.replace("timestamp", "when"), r"row 1: expected a column of the time.*--time"),
        (lambda t: t.replace("_mm", "_counts"), r"row 1: expected columns of the motors"),
        (lambda t: t.replace("\n100.5,movement 0,", "\n100.5,movement 0,nan,", 1),
         r"row 3, column motor_0_mm: expected a finite number"),
        (lambda t: t.replace("\n100.5,", "\n,", 1), r"row 3, column timestamp: .*found nothing"),
        (lambda t: t.replace("\n101.0,", "\n100.5,", 1), r"row 4: expected a time after"),
        (lambda t: t.replace("\n101.0,", "\n90.0,", 1), r"row 4: expected a time after"),
    ],
)  # fmt: skip
def test_bad_files_are_refused(tmp_path: Path, moves: Recording, change, message: str) -> None:  # pyright: ignore
    path = written(tmp_path / "a.csv", change(as_csv(moves)))
    with pytest.raises(InputError, match=message):
        read_recording(path)


def test_a_long_gap_is_named(tmp_path: Path, moves: Recording) -> None:
    late = replace(moves, times=np.where(np.arange(len(moves.times)) < 9, 0, 5000) + moves.times)
    with pytest.raises(InputError, match=r"row 11: .*without long gaps.*one of 5000 s here"):
        read_recording(written(tmp_path / "a.csv", as_csv(late)))


@pytest.mark.parametrize("factor", [1e3, 10.0, 0.1, 1e-3])
def test_wrong_units_are_seen_by_their_scale(moves: Recording, factor: float) -> None:
    check_fits(moves, ROBOT)
    with pytest.raises(InputError, match=r"Name it with --(cable|tip)-unit"):
        check_fits(replace(moves, tips=factor * moves.tips), ROBOT)
    with pytest.raises(InputError, match=r"Name it with --cable-unit"):
        check_fits(replace(moves, readings=factor * moves.readings), ROBOT)


def test_fewer_motors_than_cables_are_refused(moves: Recording) -> None:
    few = replace(moves, motors=moves.motors[:8], readings=moves.readings[:, :8])
    with pytest.raises(InputError, match=r"expected 9 motors, one for each cable.*found 8"):
        check_fits(few, ROBOT)


def test_what_stands_still_is_named(moves: Recording) -> None:
    readings = moves.readings.copy()
    readings[:, 3] = 1e-3
    with pytest.raises(InputError, match=r"found motor_3_mm standing still"):
        check_fits(replace(moves, readings=readings), ROBOT)
    with pytest.raises(InputError, match="a tip that stands still"):
        check_fits(replace(moves, tips=np.ones_like(moves.tips)), ROBOT)
