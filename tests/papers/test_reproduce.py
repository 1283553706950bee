"""`sinuous reproduce`: data first, figures and claims from them, and a stamp on what is quick."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from matplotlib.figure import Figure
from matplotlib.image import imread

import sinuous as sn
from sinuous.cli import main
from sinuous.papers.claims import Claim, Found, Verdict
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.hachen2025.paper import HACHEN2025
from sinuous.papers.reproduce import Paper, reproduce
from sinuous.papers.sketch import sketch, unsketch
from sinuous.papers.workers import Workers, workers
from sinuous.session.header import make_header
from sinuous.view.style import save


def squares(team: Workers, quick: bool) -> Data:
    numbers = [1.0, 2.0] if quick else [1.0, 2.0, 3.0]
    return {"values": team.map("squares", square, numbers), "unknown": float("nan")}


def square(x: float) -> float:
    return x * x


def draw(data: Data, folder: Path) -> list[Path]:
    def curve(figure: Figure) -> None:
        figure.subplots().plot(data["values"])

    assert data["unknown"] is None  # figures see what the file holds
    assert (folder.parent.parent / "data" / "squares.json").is_file()
    return [save(folder / "curve.png", (2.0, 2.0), curve)]


def judge(found: Found) -> Verdict:
    total = sum(found["squares"]["values"])
    return Verdict(measured=f"{total:g}", holds=total == 14.0)


def claim(needs: str) -> Claim:
    return Claim(name=needs, section="I", printed="it is 14", needs=(needs,), judge=judge)


PAPER = Paper(
    name="toy",
    title="Toys",
    experiments=(
        Experiment(name="squares", title="Squares", section="I", run=squares, draw=draw),
    ),
    claims=(claim("squares"), claim("cubes")),
)  # fmt: skip


def read(path: Path) -> Any:
    return json.loads(path.read_text())


def test_data_figures_and_claims(tmp_path: Path) -> None:
    done = reproduce(PAPER, tmp_path)
    assert read(tmp_path / "data" / "squares.json") == {
        "quick": False, "values": [1.0, 4.0, 9.0], "unknown": None,
    }  # fmt: skip
    assert done.figures == [tmp_path / "figures" / "squares" / "curve.png"]
    written = read(tmp_path / "claims.json")
    assert written["paper"] == "Toys"
    assert not written["quick"]
    assert written["versions"]["sinuous"]
    first, second = written["claims"]
    assert (first["holds"], first["measured"]) == (True, "14")
    assert (second["holds"], second["reason"]) == (None, "cubes did not run this time")


def test_a_quick_run_says_so_in_data_and_figures(tmp_path: Path) -> None:
    for name, quick in (("whole", False), ("quick", True)):
        reproduce(PAPER, tmp_path / name, quick=quick)
    assert read(tmp_path / "quick" / "data" / "squares.json")["quick"]
    assert read(tmp_path / "quick" / "claims.json")["claims"][0]["holds"] is False
    whole, quick = (
        imread(tmp_path / name / "figures" / "squares" / "curve.png")[:25, -150:]
        for name in ("whole", "quick")
    )
    red = np.array([0xD5, 0x5E, 0x00, 0xFF]) / 0xFF
    assert np.any(np.all(np.abs(quick - red) < 0.01, axis=2))
    assert not np.any(np.all(np.abs(whole - red) < 0.01, axis=2))


def test_as_many_processes_as_one_likes_find_the_same_in_order() -> None:
    numbers, heard = [float(k) for k in range(20)], list[int]()
    with workers(2, lambda what, done, count: heard.append(done)) as team:
        found = team.map("roots", math.sqrt, numbers)
    assert found == [math.sqrt(x) for x in numbers]
    assert heard == list(range(21))


def test_what_is_wrong_is_said(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    (tmp_path / "file").write_text("")
    for arguments, word in (
        (["--out", str(tmp_path / "file")], "a folder"),
        (["--out", str(tmp_path), "--only", "nothing"], "one of timing"),
        (["--out", str(tmp_path), "--processes", "0"], "one or more"),
    ):
        assert main(["reproduce", "hachen2025", *arguments]) == 2
        assert word in capsys.readouterr().err


def test_the_experiments_have_different_names_and_every_claim_finds_its_data() -> None:
    names = [one.name for one in HACHEN2025.experiments]
    assert len(names) == len(set(names))
    assert {name for one in HACHEN2025.claims for name in one.needs} <= set(names)


def test_one_experiment_from_the_command_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    code = main([
        "reproduce", "hachen2025", "--out", str(tmp_path), "--quick", "--only", "printed",
        "--processes", "1",
    ])  # fmt: skip
    assert code == 0
    said = capsys.readouterr().out
    assert "the next prediction starts from x*[0|k-1]" in said
    claims = {row["id"]: row for row in read(tmp_path / "claims.json")["claims"]}
    # Three misprints, both sides in the same data.
    for name in ("restart", "steady_error", "penalty_sign"):
        assert claims[name]["holds"] is False
    data = read(tmp_path / "data" / "printed.json")
    assert data["restart"]["printed_tip_error_m"][0] == data["restart"]["printed_tip_error_m"][-1]
    assert data["restart"]["ours_tip_error_m"][-1] < 1e-5
    assert data["penalty"]["printed"][-1] > data["penalty"]["printed"][0]
    assert data["penalty"]["ours"][-1] < data["penalty"]["ours"][0]
    assert claims["mpc_is_stable"]["holds"] is None
    assert (tmp_path / "figures" / "printed" / "misprints.png").is_file()


def test_a_sketch_draws_what_it_was_made_from() -> None:
    scenario = sn.load_scenario(
        Path(__file__).parents[2] / "examples" / "scenarios" / "free_space.toml",
        set=["path.max_steps=30"],
    )
    run = sn.run(scenario).recording
    plain = json.loads(json.dumps(sketch(run)))
    again = unsketch(plain, make_header(scenario))
    assert len(again) <= 60
    np.testing.assert_allclose(again.actual_points[-1], run.actual_points[-1], atol=1e-6)
    np.testing.assert_allclose(again.actual_points[0], run.actual_points[0], atol=1e-6)
    # Every way-point is there.
    for target in np.unique(run.target, axis=0):
        assert np.any(np.all(np.abs(again.target - target) < 1e-6, axis=1))
