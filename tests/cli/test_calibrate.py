"""`sinuous calibrate` from files to files, and what it says if they are no good."""

import json
from pathlib import Path

import pytest
from tests.calibration.made import (
    ROBOT,
    as_csv,
    commands,
    recording,
    simulated,
    single_pulls,
    truth,
)

from sinuous.calibration.parameters import parameters
from sinuous.cli import main
from sinuous.robots.robot_file import load_pcc

# A few rows suffice to see that everything comes together.
MOVES = (0, 4, 8, 9)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of recordings: movements, single pulls, and one that is kept back."""
    folder = tmp_path_factory.mktemp("recordings")
    x = truth(1, parameters(ROBOT, own_zeros=True))
    made = simulated(x, [commands()[k] for k in MOVES], single_pulls(), seed=1)
    other = simulated(x, commands()[10:12], single_pulls(), seed=2)
    for name, text in (
        ("pulls", as_csv(recording(made, 0, start=0.0))),
        ("train", as_csv(recording(made, 1, start=1e4))),
        ("kept", as_csv(recording(other, 1, start=2e4))),
    ):
        (folder / f"{name}.csv").write_text(text, encoding="utf-8")
    return folder


def test_files_become_a_robot(files: Path, capsys: pytest.CaptureFixture[str]) -> None:
    code = main(
        ["calibrate", str(files / "train.csv"), "--pulls", str(files / "pulls.csv"),
         "--robot", "opencr_v4", "--validate", str(files / "kept.csv"),
         "--out", str(files / "mine.toml"), "--json", str(files / "mine.json")]
    )  # fmt: skip
    shown = capsys.readouterr().out
    assert code == 0
    assert "cross-validation 1" in shown
    said = json.loads((files / "mine.json").read_text(encoding="utf-8"))
    assert 0.0 < said["validation"]["tip_mean_m"] < said["validation"]["tip_rmse_m"] < 3e-3
    assert said["train"]["tip_rmse_m"] < 1.5e-3
    assert said["cross_validation"]["tip_rmse_m"] < 5e-3
    assert load_pcc(files / "mine.toml").fitted is not None
    assert (files / "mine_figures" / "validation.png").exists()
    assert main(["check", str(files / "mine.toml")]) == 0


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["no.csv", "--robot", "opencr_v4"], "no.csv"),
        (["train.csv", "--robot", "opencr_v5"], "opencr_v5"),
        (["train.csv", "--robot", "qin2020"], "a robot of segments"),
        (["train.csv", "--robot", "hachen2025"], "segments of fixed length"),
        (["train.csv", "--robot", "opencr_v4", "--cable-unit", "m"], "--cable-unit mm, cm or m"),
        (["train.csv", "--robot", "opencr_v4", "--tip-unit", "inch"], '"m", "cm", "mm"'),
        (["train.csv", "--robot", "opencr_v4", "--motors", "motor_1_mm,motor_2_mm"], "9 motors"),
        (["train.csv", "--robot", "opencr_v4", "--motors", "servo"], "a column servo"),
        (["train.csv", "--robot", "opencr_v4", "--out", "robot"], "ending in .toml"),
        (["train.csv", "--robot", "opencr_v4", "--json", " "], "--json: expected a name"),
    ],
)
def test_bad_input_ends_with_a_message(
    files: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    arguments: list[str],
    message: str,
) -> None:
    monkeypatch.chdir(files)
    assert main(["calibrate", *arguments]) == 2
    said = capsys.readouterr().err
    assert message in said
    assert "Traceback" not in said
