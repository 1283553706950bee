"""From recordings to a robot file that predicts, and that every other verb reads."""

import json
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from tests.calibration.made import NOISE, ROBOT, commands, recording, simulated, single_pulls, truth

from sinuous.calibration.calibrate import Calibration, calibrate, in_pieces
from sinuous.calibration.cross_validation import FOLDS, folds, uses_several
from sinuous.calibration.figures import draw
from sinuous.calibration.fit import measure
from sinuous.calibration.parameters import parameters
from sinuous.calibration.problem import Problem
from sinuous.calibration.recording import Recording
from sinuous.calibration.report import as_json, rows
from sinuous.calibration.robot_text import robot_text
from sinuous.errors import InputError
from sinuous.files import read_toml, write_text
from sinuous.plants.calibrated import CalibratedPlant
from sinuous.robots.robot_file import load_pcc, robot_path

# Predictions of what was left out, beside the noise of three axes.
PREDICTED = 2.5 * NOISE
# Numbers in files have seven digits.
WRITTEN = 1e-6


@pytest.fixture(scope="module")
def made() -> Problem:
    x = truth(5, parameters(ROBOT, own_zeros=True))
    return simulated(x, commands(), single_pulls(), seed=5)


@pytest.fixture(scope="module")
def recorded(made: Problem) -> tuple[Recording, Recording]:
    """Single pulls and other movements."""
    return recording(made, 0, start=0.0), recording(made, 1, start=1e4)


@pytest.fixture(scope="module")
def found(recorded: tuple[Recording, Recording]) -> Calibration:
    pulls, moves = recorded
    return calibrate(moves, ROBOT, pulls=pulls)


def test_movements_left_out_are_predicted(found: Calibration) -> None:
    judged = found.cross_validation
    assert judged is not None
    assert judged.rmse < PREDICTED
    assert len(judged.by_pattern) == len(commands())
    several = found.judge(found.from_single)
    assert several is not None
    assert set(several.by_pattern) == {"movement 9", "movement 10", "movement 11", "movement 12"}


def test_a_recording_that_was_not_fitted_is_judged(found: Calibration) -> None:
    x = truth(5, parameters(ROBOT, own_zeros=True))
    other = [1.1 * commands()[k] for k in (12, 9, 3)]
    problem = simulated(x, other, single_pulls(), seed=9)
    kept_back = recording(problem, 1, start=2e4)
    judged = found.validate(kept_back)
    assert judged.rmse < PREDICTED
    assert judged.mean < judged.rmse
    moved = replace(kept_back, tips=kept_back.tips + 0.05)
    assert found.validate(moved).rmse == pytest.approx(judged.rmse)  # the mean offset is removed
    mixed = replace(kept_back, motors=kept_back.motors[::-1], readings=kept_back.readings[:, ::-1])
    assert found.validate(mixed).rmse == judged.rmse  # motors are known by their names
    with pytest.raises(InputError, match="expected the motors motor_0_mm"):
        found.validate(replace(kept_back, motors=tuple("abcdefghi")))


def test_the_file_is_the_robot_that_was_found(found: Calibration, tmp_path: Path) -> None:
    path = tmp_path / "robot.toml"
    text = robot_text(
        read_toml(robot_path("opencr_v4")), found.problem, found.found,
        x=found.fit.x, motors=found.motors, about="made up",
    )  # fmt: skip
    write_text(path, text)
    robot = load_pcc(path)
    assert robot.fitted is not None
    sequence = found.problem.sequences[1]
    order = [found.motors.index(name) for name in robot.fitted.motors]
    readings = np.empty_like(sequence.pulls)
    readings[:, order] = sequence.pulls * found.problem.identified.directions
    bends = robot.fitted.model.trace(robot.fitted.pulls(readings[:, order]))
    tips = robot.at(robot.fitted.T_t_b).tip(bends)
    np.testing.assert_allclose(tips, found.problem.tips(found.fit.x, sequence), atol=WRITTEN)
    plant = CalibratedPlant(robot)
    assert np.all(np.isfinite(plant.step(np.zeros(9), 0.01).tip))


def test_kinematics_with_the_effective_pitch_come_nearer(
    found: Calibration, made: Problem, tmp_path: Path
) -> None:
    text = robot_text(
        read_toml(robot_path("opencr_v4")), found.problem, found.found,
        x=found.fit.x, motors=found.motors, about="made up",
    )  # fmt: skip
    write_text(tmp_path / "robot.toml", text)
    robot = load_pcc(tmp_path / "robot.toml")
    assert robot.fitted is not None
    pulls = found.problem.sequences[1].pulls
    true = robot.tip(robot.fitted.model.trace(pulls))
    spread = [
        np.mean(np.linalg.norm((tips - true) - np.mean(tips - true, axis=0), axis=1))
        for tips in (_kinematic(robot, pulls), _kinematic(ROBOT, pulls))
    ]
    assert spread[0] < 0.8 * spread[1]


def _kinematic(robot, pulls):  # pyright: ignore
    straight = robot.lengths(np.zeros(6))
    return robot.tip(robot.configuration(straight - pulls))


def test_json_and_table_say_the_same(
    found: Calibration, recorded: tuple[Recording, Recording]
) -> None:
    judged = found.validate(recorded[1])
    said = json.loads(as_json(found, judged))
    assert said["validation"]["tip_rmse_m"] == judged.rmse
    assert said["validation"]["tip_mean_m"] == judged.mean
    assert said["train"]["tip_rmse_m"] == found.train.rmse
    assert set(said["cross_validation"]["patterns"]) == set(recorded[1].names)
    assert sorted(said["motors"]) == sorted(recorded[1].motors)
    for each in said["parameters"].values():
        assert np.all(np.array(each["low"]) <= each["value"])
        assert np.all(np.array(each["high"]) >= each["value"])
    assert any(f"{1e3 * judged.rmse:.2f} mm RMSE" in text for _, text in rows(found, judged))


def test_figures_are_drawn(
    found: Calibration, recorded: tuple[Recording, Recording], tmp_path: Path
) -> None:
    moves = recorded[1]
    files = draw(found, tmp_path / "figures", validation=(moves, found.predict(moves)))
    assert [file.name for file in files] == ["residuals.png", "movements.png", "validation.png"]
    assert all(file.stat().st_size > 10_000 for file in files)


def test_folds_leave_out_whole_movements_once() -> None:
    patterns = np.repeat(np.arange(14), 5)
    apart = patterns < 3
    fold = folds(patterns, apart)
    assert np.all((fold == -1) == apart)
    assert set(fold[~apart]) == set(range(FOLDS))
    for k in range(3, 14):
        assert len(set(fold[patterns == k])) == 1
    assert len(set(folds(np.zeros(10, dtype=int), np.zeros(10, dtype=bool)))) == 1


def test_movements_of_several_segments_are_known(made: Problem) -> None:
    several = uses_several(made)[~made.own_zeros]
    numbers = made.sequences[1].patterns - 9
    assert set(numbers[several]) == {9, 10, 11, 12}


def test_errors_that_last_count_less() -> None:
    rng, patterns = np.random.default_rng(0), np.zeros(4000, dtype=int)
    white = rng.normal(0, 1e-3, (4000, 3))
    assert measure(white, patterns).size == pytest.approx(1e-3, rel=0.05)
    assert measure(white, patterns).memory < 1.3
    lasting = np.repeat(white[:400], 10, axis=0)
    assert measure(lasting, patterns).memory == pytest.approx(10.0, rel=0.2)


def test_a_recording_without_names_is_cut_into_pieces(
    recorded: tuple[Recording, Recording],
) -> None:
    moves = recorded[1]
    nameless = replace(moves, names=("all",), patterns=np.zeros(len(moves.times), dtype=int))
    assert len(in_pieces(nameless).names) == 10
    assert in_pieces(moves) is moves


def test_only_robots_of_fixed_length_can_be_calibrated(
    recorded: tuple[Recording, Recording],
) -> None:
    with pytest.raises(InputError, match="segments of fixed length"):
        calibrate(recorded[1], load_pcc("hachen2025"))
