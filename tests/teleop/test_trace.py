"""Recorded connections, and what files may look like."""

from pathlib import Path

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.teleop.delays import Steady
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.trace import Trace

from .rigs import DT
from .test_impaired import deliver, journeys


def written(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "trace.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_packets_fare_as_the_last_that_was_recorded(tmp_path: Path) -> None:
    trace = Trace.load(written(tmp_path, "t_s,delay_ms\n5.0,3\n5.01,\n5.02,8\n"))
    taken = dict(journeys(deliver(ImpairedLink(effects=(trace,)), 60)))
    # It begins anew after 30 ticks: 20 between its ends, and one mean spacing.
    assert trace.length == pytest.approx(0.03)
    for number in range(50):
        phase = number % 30
        if phase < 10:
            assert taken[number] == 3
        elif phase < 20:
            assert number not in taken
        else:
            assert taken[number] == 8


def test_numbers_count_packets_and_those_that_are_missing_were_lost(tmp_path: Path) -> None:
    text = "note,delay_s,number\n,0.002,7\nx,0.004,8\n,,9\n,0.002,12\n"
    trace = Trace.load(written(tmp_path, text))
    taken = dict(journeys(deliver(ImpairedLink(effects=(trace,)), 40)))
    by_phase = {0: 2, 1: 4, 5: 2}
    assert trace.length == pytest.approx(0.006, abs=0.0011)
    for number in range(6):
        assert taken.get(number) == by_phase.get(number)


def test_a_trace_comes_on_top_of_what_is_before() -> None:
    trace = Trace(times=np.array([0.0]), delays=np.array([0.004]))
    taken = journeys(deliver(ImpairedLink(effects=(Steady(0.01), trace)), 30))
    assert {delay for _, delay in taken} == {14}


def test_a_real_recording_keeps_its_distribution(tmp_path: Path) -> None:
    rng = np.random.default_rng(3)
    delays = rng.gamma(4.0, 0.01, 500)
    delays[rng.random(500) < 0.1] = np.nan
    rows = [f"{k},{'' if np.isnan(d) else f'{d:.6f}'}" for k, d in enumerate(delays)]
    trace = Trace.load(written(tmp_path, "\n".join(["number,delay_s", *rows])), period=DT)
    found = journeys(deliver(ImpairedLink(effects=(trace,)), 800))
    taken = dict(item for item in found if item[0] < 500)
    assert len(taken) == np.sum(np.isfinite(delays))
    for number, delay in taken.items():
        assert delay == max(round(delays[number] / DT), 1)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["a header and a row", "found nothing"]),
        ("t_s,delay_ms\n", ["a row for each packet", "only a header"]),
        ("t_s\n0\n", ["row 1", "delay_s", "delay_ms", "the columns t_s"]),
        ("delay_ms\n0\n", ["row 1", "t_s", "number", "the columns delay_ms"]),
        ("t_s,delay\n0,1\n", ["row 1", "delay_ms"]),
        ("t_s,delay_ms\n0,1\nx,1\n", ["row 3, column t_s", "a finite number", '"x"']),
        ("t_s,delay_ms\n\n0,1\n,1\n", ["row 4, column t_s", "a finite number", "nothing"]),
        ("t_s,delay_ms\n0,1\n0,1\n", ["row 3, column t_s", "more than in the row before"]),
        ("t_s,delay_ms\n0,-1\n", ["row 2, column delay_ms", "zero or more", "-1"]),
        ("t_s,delay_ms\n0,inf\n", ["row 2, column delay_ms", "a finite number", "inf"]),
        ("number,delay_ms\n0,1\n1.5,1\n", ["row 3, column number", "a whole number", "1.5"]),
    ],
)
def test_what_is_wrong_with_a_file_is_said(tmp_path: Path, text: str, words: list[str]) -> None:
    path = written(tmp_path, text)
    with pytest.raises(InputError) as error:
        Trace.load(path)
    for word in (str(path), *words):
        assert word in str(error.value)


def test_a_file_that_is_not_there_is_said_too(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="nothing there"):
        Trace.load(tmp_path / "none.csv")


@pytest.mark.parametrize(
    ("times", "delays", "says"),
    [
        ([], [], "one or more"),
        ([0.0, 1.0], [0.1], "as many"),
        ([0.0, 0.0], [0.1, 0.1], "increase"),
        ([0.0, np.nan], [0.1, 0.1], "increase"),
        ([0.0], [-0.1], "zero or more"),
        ([0.0], [np.inf], "zero or more"),
    ],
)
def test_recordings_that_make_no_sense(times: list[float], delays: list[float], says: str) -> None:
    with pytest.raises(ValueError, match=says):
        Trace(times=np.array(times), delays=np.array(delays))


def test_periods_that_make_no_sense(tmp_path: Path) -> None:
    with pytest.raises(ValueError, match="period"):
        Trace.load(written(tmp_path, "number,delay_s\n0,0\n"), period=0.0)
