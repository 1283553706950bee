"""Results on the screen and in files."""

import io
import json

import numpy as np
from rich.console import Console

from sinuous.bench.mpc import ratios
from sinuous.bench.printer import print_result
from sinuous.bench.result import Column, Result, Table

ROWS = [
    {"controller": "sinuous", "horizon": 2, "disks": 9, "median_ms": 0.1, "p99_ms": 0.2},
    {"controller": "slow [peer]", "horizon": 2, "disks": 9, "median_ms": 3.0, "p99_ms": 8.0},
    {"controller": "absent", "horizon": 2, "disks": 9, "status": "not installed"},
]
COLUMNS = (
    Column(key="controller", title="controller"),
    Column(key="median_ms", title="median", form=".2f"),
)


def result() -> Result:
    table = Table(name="rows", title="a title", columns=COLUMNS, rows=ROWS)
    about = {"nan": float("nan"), "array": (np.float64(1.5), np.inf), "path": object}
    return Result(what="mpc", tables=(table,), about=about, notes=("a [note]",))


def test_json_holds_everything_and_no_nan() -> None:
    read = json.loads(result().as_json())
    assert read["what"] == "mpc"
    assert read["rows"] == ROWS
    assert read["nan"] is None
    assert read["array"] == [1.5, None]


def test_a_table_shows_names_as_they_are_and_gaps_as_dashes() -> None:
    text = io.StringIO()
    print_result(Console(file=text), result())
    for words in ("a title", "slow [peer]", "3.00", "a [note]"):
        assert words in text.getvalue()
    absent = next(line for line in text.getvalue().splitlines() if "absent" in line)
    assert absent.split() == ["absent", "-"]


def test_ratios_are_peers_by_ours() -> None:
    (ratio,) = ratios(ROWS)
    assert ratio["peer"] == "slow [peer]"
    assert (ratio["median"], ratio["p99"]) == (3.0 / 0.1, 8.0 / 0.2)
