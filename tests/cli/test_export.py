"""`sinuous export`: what it writes opens in MuJoCo, taut, and with the cables of the robot."""

import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.cli import main
from sinuous.plants.physics.build import physical_body
from sinuous.plants.physics.engine import require_mujoco
from sinuous.robots.robot_file import PRESETS, load_jointed, preset_names

BAD_INPUT = 2
WRITTEN = 1e-7  # [m] MuJoCo writes six digits of every number
ENDOSCOPE = Path(__file__).parents[2] / "examples" / "robots" / "endoscope.toml"


def exported(robot: str, folder: Path) -> Any:
    """The model that MuJoCo reads from what is written."""
    file = folder / "robot.xml"
    assert main(("export", robot, "--mjcf", str(file))) == 0
    return require_mujoco().MjModel.from_xml_path(str(file))


def test_its_tendons_are_the_robots_cables(tmp_path: Path) -> None:
    model, robot = exported("qin2020", tmp_path), load_jointed("qin2020")
    mujoco, body = require_mujoco(), physical_body(robot)
    data = mujoco.MjData(model)
    for c in np.random.default_rng(0).uniform(-0.4, 0.4, (100, 10)):
        body.pose(model, data, c)
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.ten_length, robot.lengths(c), rtol=0, atol=WRITTEN)
    names = [model.tendon(i).name for i in range(model.ntendon)]
    assert names == [model.actuator(i).name for i in range(model.nu)] == list(robot.actuator_names)


@pytest.mark.parametrize("robot", [*preset_names(), str(ENDOSCOPE)])
def test_it_opens_taut_and_stays_so(robot: str, tmp_path: Path) -> None:
    """With all inputs at zero, as the viewer starts it."""
    model, mujoco = exported(robot, tmp_path), require_mujoco()
    data = mujoco.MjData(model)
    for _ in range(300):
        mujoco.mj_step(model, data)
    assert not np.any(data.warning.number)
    assert np.max(np.abs(data.qvel)) < 1e-3
    assert np.max(np.abs(data.qpos)) < 0.1
    assert np.all(data.actuator_force < -5.0)


def test_an_input_shortens_its_cable(tmp_path: Path) -> None:
    model, mujoco = exported("qin2020", tmp_path), require_mujoco()
    data = mujoco.MjData(model)
    data.ctrl[12:15] = 5e-3 * np.cos(2 * np.pi * np.arange(3) / 3)
    for _ in range(500):
        mujoco.mj_step(model, data)
    home = load_jointed("qin2020").lengths(np.zeros(10))
    np.testing.assert_allclose(data.ten_length[12:15] - home[12:15], data.ctrl[12:15], atol=1e-3)
    assert np.all(np.abs(data.ctrl) < model.actuator_ctrlrange[:, 1])


def test_it_says_how_to_open_it_and_what_stays(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    exported(str(ENDOSCOPE), tmp_path)
    printed = capsys.readouterr().out
    assert f"python -m mujoco.viewer --mjcf={tmp_path / 'robot.xml'}" in printed
    assert "1 actuator that is no cable stays at home" in printed


def test_a_robot_that_mujoco_cannot_hold_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    text = (PRESETS / "qin2020.toml").read_text()
    file = tmp_path / "light.toml"
    file.write_text(text.replace("module_mass_g = 120", "module_mass_g = 1e-20"))
    assert main(("export", str(file), "--mjcf", str(tmp_path / "robot.xml"))) == BAD_INPUT
    printed = capsys.readouterr().err
    assert printed.count("\n") == 1
    assert "expected a robot that MuJoCo can hold" in printed
    assert "Look at the masses and sizes" in printed
    assert not (tmp_path / "robot.xml").exists()


def test_without_mujoco_the_extra_is_named(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    absent: Any = None
    monkeypatch.setitem(sys.modules, "mujoco", absent)
    assert main(("export", "qin2020", "--mjcf", str(tmp_path / "robot.xml"))) == BAD_INPUT
    assert "pip install sinuous[physics]" in capsys.readouterr().err


def test_a_place_that_cannot_be_written_is_named(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(("export", "qin2020", "--mjcf", str(tmp_path))) == BAD_INPUT
    assert str(tmp_path) in capsys.readouterr().err
