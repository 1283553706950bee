"""The command line: what it prints, what it writes and how it ends."""

import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import pytest

from sinuous.cli import main
from sinuous.session import runner

EXAMPLES = Path(__file__).parent.parent / "examples"
FREE = str(EXAMPLES / "scenarios" / "free_space.toml")
TUBE = str(EXAMPLES / "scenarios" / "winding_tube.toml")
SHORT = ("--set", "path.max_steps=5", "path.waypoints_mm=[[0, 0, 200], [0, 5, 200]]")
FIGURES = ["clearance.png", "rates.png", "shapes.png", "solve_time.png", "tip_error.png"]


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a short run."""
    out = tmp_path_factory.mktemp("runs") / "first"
    assert main(("run", FREE, "--out", str(out), *SHORT)) == 0
    return out


def test_run_writes_everything_and_prints_the_numbers(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = tmp_path / "out"
    assert main(("run", FREE, "--out", str(out), *SHORT)) == 0
    printed = capsys.readouterr()
    assert printed.err == ""
    for text in ("free space", "tip error, RMS", "margin violations", "real-time factor"):
        assert text in printed.out
    assert str(out / "figures" / "shapes.png") in printed.out
    assert "\x1b" not in printed.out  # not a terminal: plain lines
    assert sorted(path.name for path in (out / "figures").iterdir()) == FIGURES
    assert json.loads((out / "summary.json").read_text())["solver_failures"] == 0


def test_run_tells_how_far_it_is_without_a_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    argv = ("run", FREE, "--out", str(tmp_path), "--set", "path.max_steps=110")
    assert main((*argv, "--set", "path.waypoints_mm=[[0, 80, 100]]")) == 0
    assert "sample 100 of at most 110: " in capsys.readouterr().out


def test_run_shows_a_bar_on_a_terminal(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("FORCE_COLOR", "1")
    assert main(("run", FREE, "--out", str(tmp_path), *SHORT)) == 0
    printed = capsys.readouterr().out
    assert "10/10" in printed
    assert "tip error" in printed


def test_ctrl_c_ends_with_130_and_keeps_what_ran(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        os.kill(os.getpid(), signal.SIGINT)

    monkeypatch.setattr("sinuous.cli.progress.RunProgress.observe", interrupt)
    assert main(("run", FREE, "--out", str(tmp_path), *SHORT)) == 130
    assert "interrupted" in capsys.readouterr().err
    assert (tmp_path / "summary.json").is_file()
    assert main(("check", str(tmp_path))) == 0


def test_ctrl_c_before_the_first_step(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupt(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(runner, "warm_up", interrupt)
    assert main(("run", FREE, "--out", str(tmp_path), *SHORT)) == 130
    assert capsys.readouterr().err == "sinuous: interrupted\n"


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("hachen2025", ("a good robot", "40 to 90 mm", "tip at home", "20 mm/s")),
        ("opencr_v4", ("a good robot", "62.5 mm", "counted in the motor")),
        ("qin2020", ("130 mm from joint", "39.09 deg", "of 18 holes", "0, 650, 0 mm", "200 mm/s")),
        (str(EXAMPLES / "robots" / "endoscope.toml"), ("insertion", "0 to 120 mm", "0, 0, 12 mm")),
        (FREE, ("a good scenario", "free space", "4 legs")),
        (TUBE, ("a good scenario", "winding tube", "mm; 1")),
    ],
)
def test_check_tells_what_a_file_holds(
    name: str, words: tuple[str, ...], capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(("check", name)) == 0
    printed = capsys.readouterr().out
    for word in words:
        assert word in printed


def test_check_tells_about_meshes_paths_and_runs(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(("check", str(EXAMPLES / "meshes" / "post.stl"), "--unit", "mm")) == 0
    printed = capsys.readouterr().out
    assert "14, 114, 14 mm" in printed
    assert "watertight" in printed

    path = tmp_path / "path.csv"
    path.write_text("t_s,x_mm,y_mm,z_mm\n0,0,0,200\n2,0,30,160\n")
    assert main(("check", str(path))) == 0
    printed = capsys.readouterr().out
    assert "0 to 2 s" in printed
    assert "25 mm/s" in printed

    for name in (folder, folder / "run.mcap"):
        assert main(("check", str(name))) == 0
        assert "10, every 33.33 ms" in capsys.readouterr().out


def test_check_overrides_the_scenario(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(("check", FREE, "--set", "mpc.horizon=9")) == 0
    assert "horizon 9" in capsys.readouterr().out


def test_check_target(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(("check", FREE, "--target", "0,20,200")) == 0
    assert "reachable: yes" in capsys.readouterr().out
    assert main(("check", FREE, "--target", "0,0,300")) == 1
    printed = capsys.readouterr().out
    assert "reachable: no" in printed
    assert "30.0000 mm" in printed  # 270 mm is the longest that it gets
    assert "backbone at its length limit" in printed


def test_compare(folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    other = tmp_path / "other"
    assert main(("run", FREE, "--out", str(other), *SHORT, "name=printed", "mpc.cost=printed")) == 0
    capsys.readouterr()
    out = tmp_path / "both"
    assert main(("compare", str(folder), str(other / "run.mcap"), "--out", str(out))) == 0
    printed = capsys.readouterr().out
    assert "free space" in printed
    assert "printed" in printed
    assert str(out / "comparison.png") in printed
    assert (out / "comparison.png").is_file()


def test_compare_takes_the_wall_time_from_the_summary(
    folder: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    summary = json.loads((folder / "summary.json").read_text())
    assert summary["real_time_factor"] > 0.0
    assert main(("compare", str(folder), str(folder), "--out", str(tmp_path))) == 0
    printed = capsys.readouterr().out
    assert f"{summary['real_time_factor']:.3g} " in printed

    (folder / "summary.json").write_text("[]")
    try:
        assert main(("compare", str(folder), str(folder), "--out", str(tmp_path))) == 2
        assert "not a JSON object" in capsys.readouterr().err
    finally:
        (folder / "summary.json").write_text(json.dumps(summary))


@pytest.mark.parametrize("argv", [(), ("run",), ("check",), ("compare",)])
def test_help_is_the_manual(argv: tuple[str, ...], capsys: pytest.CaptureFixture[str]) -> None:
    assert main((*argv, "--help")) == 0
    assert "usage: sinuous" in capsys.readouterr().out


def test_help_imports_nothing_that_computes() -> None:
    code = (
        "import sys; from sinuous.cli import main; main(['--help']); "
        "sys.exit(any(name in sys.modules for name in ('numba', 'numpy', 'scipy', 'matplotlib')))"
    )
    subprocess.run([sys.executable, "-c", code], check=True, stdout=subprocess.DEVNULL)
