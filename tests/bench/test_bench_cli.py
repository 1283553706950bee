"""`sinuous bench` on the command line."""

import json
import sys
from pathlib import Path

import pytest

from sinuous.cli import main

ROW_KEYS = {
    "controller",
    "horizon",
    "disks",
    "median_ms",
    "p99_ms",
    "max_ms",
    "wall_median_ms",
    "wall_p99_ms",
    "wall_max_ms",
    "min_margin_mm",
    "body_margin_mm",
    "violations",
    "failures",
    "tip_error_median_mm",
    "iterations_median",
}


def test_mpc_measures_prints_draws_and_writes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr("sinuous.bench.mpc.QUICK_STEPS", 5)
    monkeypatch.setattr("sinuous.bench.peers.setup.compiler", lambda: None)  # saves a minute
    monkeypatch.setattr("sinuous.bench.peers.acados.load", lambda: None)
    file, out = tmp_path / "new" / "mpc.json", tmp_path / "figures"
    argv = ("bench", "mpc", "--quick", "--json", str(file), "--out", str(out))
    assert main(argv) == 0
    printed = capsys.readouterr().out
    for words in ("CasADi IPOPT", "sinuous, disks only", str(file), str(out / "mpc.png")):
        assert words in printed
    assert (out / "mpc.png").stat().st_size > 10_000
    read = json.loads(file.read_text())
    rows = {row["controller"]: row for row in read["rows"]}
    no_compiler = {"CasADi IPOPT, no compiler"}  # the same as the other where there is none
    assert rows.keys() - no_compiler == {
        "sinuous",
        "sinuous, disks only",
        "CasADi IPOPT",
        "CasADi SQP",
        "CasADi SQP RTI",
        "acados RTI",
    }
    assert "pip install" in rows.pop("acados RTI")["status"]
    assert all(row.keys() >= ROW_KEYS for row in rows.values())
    assert {ratio["peer"] for ratio in read["ratios"]} == rows.keys() - {
        "sinuous",
        "sinuous, disks only",
    }
    for ratio in read["ratios"]:
        base, peer = rows["sinuous"], rows[ratio["peer"]]
        assert ratio["median"] == pytest.approx(peer["median_ms"] / base["median_ms"])
        assert ratio["p99"] == pytest.approx(peer["p99_ms"] / base["p99_ms"])
    run = read["peers"]["CasADi IPOPT"]["runs"][0]
    assert run["settings"]["ipopt.warm_start_init_point"] == "yes"
    assert "Number of Iterations" in run["log"]
    assert read["versions"].keys() >= {"python", "numpy", "numba", "casadi"}
    assert read["machine"]["threads"]["OMP_NUM_THREADS"] == "1"
    assert read["scene"]["steps"] == 5


def test_without_the_extra_one_message_names_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setitem(sys.modules, "casadi", None)
    assert main(("bench", "mpc", "--out", str(tmp_path))) == 2
    message = capsys.readouterr().err
    assert message.count("\n") == 1
    assert "casadi" in message
    assert "pip install sinuous[bench]" in message


@pytest.mark.parametrize(
    ("argv", "word"),
    [
        (("bench",), "mpc"),
        (("bench", "everything"), "everything"),
        (("bench", "mpc", "--out", " "), "--out"),
        (("bench", "mpc", "--json", ""), "--json"),
        (("bench", "mpc", "--fast"), "--fast"),
    ],
)
def test_wrong_arguments(
    argv: tuple[str, ...], word: str, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(argv) == 2
    output = capsys.readouterr()
    assert word in output.err
    assert "Traceback" not in output.err
    assert output.out == ""


def test_a_file_where_the_folder_should_be(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    file = tmp_path / "out"
    file.write_text("")
    assert main(("bench", "mpc", "--out", str(file))) == 2
    assert "a file where a folder should be" in capsys.readouterr().err
