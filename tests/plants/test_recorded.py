"""A record is played back row by row, and a file that is wrong is refused in words."""

import csv
import os
from pathlib import Path

import numpy as np
import pytest

from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.errors import InputError
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.mismatched import Mismatch, MismatchedPlant
from sinuous.plants.recorded import Record, RecordedPlant, read_record_csv
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

REPOSITORY = "github.com/ContinuumRoboticsLab/opencr-mujoco"
# Of the model's tip to that of the real robot [m]: 18 mm on average. The nearest wrong way to
# count its cables, or to turn its base by 30 degrees, gives 33 mm.
NEAR = 25e-3
TIMES = np.array([2.0, 2.1, 2.5, 3.0])


def recorded(robot: PccRobot) -> Record:
    """Four rows of a robot that is off its model."""
    plant = MismatchedPlant(robot, seed=1, mismatch=Mismatch.representative())
    tips, lengths = list[np.ndarray](), list[np.ndarray]()
    for _ in TIMES:
        measured = plant.step(0.3 * robot.rate_limits[:, 1] * np.arange(9) / 9, 0.3)
        tips.append(measured.tip)
        lengths.append(measured.lengths)
    return Record(times=TIMES, tips=np.array(tips), lengths=np.array(lengths))


def write(path: Path, robot: PccRobot, record: Record, *, unit: str = "mm") -> Path:
    """The record as a file, with columns in another order and one that means nothing here."""
    scale = {"mm": 1000.0, "m": 1.0}[unit]
    names = [f"{name.replace(' ', '_')}_{unit}" for name in robot.actuator_names]
    with path.open("w", newline="") as file:
        rows = csv.writer(file)
        rows.writerow([*reversed(names), "label", "z_mm", "x_mm", "y_mm", "t_s"])
        for time, tip, lengths in zip(record.times, record.tips, record.lengths, strict=True):
            x, y, z = map(float, 1000.0 * tip)
            rows.writerow([*map(float, scale * lengths[::-1]), "rest", z, x, y, float(time)])
    return path


@pytest.mark.parametrize("unit", ["mm", "m"])
def test_a_file_says_what_was_written(tmp_path: Path, unit: str) -> None:
    robot = load_robot("opencr_v4")
    record = recorded(robot)
    found = read_record_csv(write(tmp_path / "run.csv", robot, record, unit=unit), robot)
    np.testing.assert_array_equal(found.times, record.times)
    np.testing.assert_allclose(found.tips, record.tips, rtol=1e-15)
    np.testing.assert_allclose(found.lengths, record.lengths, rtol=1e-15)


def test_columns_are_named_after_the_actuators_of_any_robot(tmp_path: Path) -> None:
    robot = load_robot("hachen2025")
    lengths = robot.lengths(robot.home)[None]
    record = Record(times=np.zeros(1), tips=np.zeros((1, 3)), lengths=lengths)
    path = write(tmp_path / "run.csv", robot, record)
    assert "segment_1_cable_1_mm" in path.read_text()
    assert "segment_3_backbone_mm" in path.read_text()
    np.testing.assert_allclose(read_record_csv(path, robot).lengths, lengths, rtol=1e-15)


def test_it_yields_the_last_row_at_or_before_with_its_age_and_holds_the_end() -> None:
    robot = load_robot("opencr_v4")
    record = recorded(robot)
    plant = RecordedPlant(robot, record, coil=(0.0, 0.0, 0.01))
    rows = [1, 1, 1, 1, 2, 2, 2, 2, 2, 3, 3, 3]  # every 0.1 s, from 2.1 s on
    for k, row in enumerate(rows, 1):
        measured = plant.step(np.full(9, np.nan), 0.1)
        np.testing.assert_array_equal(measured.tip, record.tips[row])
        np.testing.assert_array_equal(measured.lengths, record.lengths[row])
        assert measured.age == pytest.approx(2.0 + 0.1 * k - TIMES[row], abs=1e-6)
        assert measured.coil[2] == 0.01
        assert not measured.has_shape
        assert plant.finished == (row == 3)


def test_a_clock_that_counts_from_1970_is_no_trouble() -> None:
    robot = load_robot("opencr_v4")
    record = recorded(robot)
    late = Record(
        times=1.778538602e9 + 0.1 * np.arange(4), tips=record.tips, lengths=record.lengths
    )
    plant = RecordedPlant(robot, late)
    for row in (1, 2, 3):
        np.testing.assert_array_equal(plant.step(np.zeros(9), 0.1).tip, record.tips[row])


@pytest.mark.parametrize("coil", [(0.0, 0.0, 0.0), (0.001, 0.002, 0.01)])
def test_its_truth_ends_at_the_recorded_tip_and_is_the_model_s_at_the_base(
    coil: tuple[float, float, float],
) -> None:
    robot = load_robot("opencr_v4")
    record = recorded(robot)
    truth = RecordedPlant(robot, record, coil=coil).truth
    model = robot.points(robot.configuration(record.lengths[0]))
    seen = truth.T_w_t[:3, 3] + truth.T_w_t[:3, :3] @ coil
    np.testing.assert_allclose(seen, record.tips[0], rtol=0, atol=1e-15)
    np.testing.assert_allclose(truth.points[-1], truth.T_w_t[:3, 3], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(truth.points[0], model[0])
    shift = np.linalg.norm(truth.points - model, axis=1)
    assert shift[1] < 2e-3 * shift[-1]  # the base keeps its direction
    assert np.all(np.diff(shift) > 0.0)


def test_a_controller_follows_a_target_beside_a_record() -> None:
    """Offline: it hears of every row, and its own plan reaches the target all the same."""
    robot = load_robot("opencr_v4")
    plant = RecordedPlant(robot, recorded(robot))
    mpc = ShapeConstrainedMPC(robot, SafeZone.unbounded(), margin=0.0, dt=0.1, horizon=2)
    state, measured = mpc.init(robot.home), None
    target = robot.tip(robot.home) + [0.01, 0.0, -0.001]
    for _ in range(20):
        state, command = mpc.step(state, target, measured)
        measured = plant.step(command.rates, mpc.dt)
    assert np.linalg.norm(robot.tip(state.c) - target) < 1e-4
    assert plant.finished


def test_files_that_are_wrong_are_refused_in_words(tmp_path: Path) -> None:
    robot = load_robot("opencr_v4")
    path = write(tmp_path / "run.csv", robot, recorded(robot))
    lines = path.read_text().splitlines()
    cases = {
        "segment_2_cable_3": [lines[0].replace("segment_2_cable_3_mm", "cable_6_mm"), *lines[1:]],
        "one column t_s or t_ms": [lines[0].replace("t_s", "time"), *lines[1:]],
        "a time after the one before": [*lines[:2], lines[3], lines[2]],
        "row 3": [*lines[:2], lines[2].replace("rest", "rest,extra")],
        "an empty file": [],
        "only a header": lines[:1],
    }
    for expected, wrong in cases.items():
        path.write_text("\n".join(wrong))
        with pytest.raises(InputError, match=expected) as error:
            read_record_csv(path, robot)
        assert error.value.file == str(path)
    with pytest.raises(InputError, match="a file"):
        read_record_csv(tmp_path / "none.csv", robot)


def test_records_that_do_not_fit_are_refused() -> None:
    robot = load_robot("hachen2025")
    record = recorded(load_robot("opencr_v4"))
    with pytest.raises(ValueError, match="12 actuators"):
        RecordedPlant(robot, record)
    for times in (TIMES[::-1], TIMES[:2], np.full(4, np.nan)):
        with pytest.raises(ValueError, match="record"):
            Record(times=times, tips=record.tips, lengths=record.lengths)


def opencr() -> Path:
    """The recording of the real robot, or a skip that says where to get it."""
    shared = Path(__file__).parents[3] / "shared" / "data"
    path = Path(os.environ.get("SINUOUS_DATA", shared)) / "opencr" / "ftdcr_v4_train.csv"
    if not path.exists():
        pytest.skip(
            f"needs ftdcr_v4_train.csv of {REPOSITORY} in $SINUOUS_DATA/opencr, "
            f"looked for it in {path.parent}"
        )
    return path


def test_a_real_robot_plays_back(tmp_path: Path) -> None:
    """Its file has cable displacements in the order of the actuators, whatever its column names."""
    robot = load_robot("opencr_v4")
    with opencr().open() as file:
        header, *rows = list(csv.reader(file))
    first = header.index("tip_x")
    values = np.array([[float(v) for v in (row[0], *row[2:])] for row in rows])
    tips = 1e-3 * values[:, first - 1 : first + 2]
    lengths = robot.lengths(robot.home) + 1e-3 * values[:, 1 : first - 1]
    record = Record(times=values[:, 0], tips=tips, lengths=lengths)
    found = read_record_csv(write(tmp_path / "v4.csv", robot, record), robot)
    plant, apart = RecordedPlant(robot, found), list[float]()
    steps = np.diff(record.times)
    for k, dt in enumerate(steps, 1):
        measured = plant.step(np.zeros(9), float(dt))
        np.testing.assert_allclose(measured.tip, tips[k], rtol=0, atol=1e-12)
        np.testing.assert_allclose(measured.lengths, lengths[k], rtol=0, atol=1e-12)
        model = robot.tip(robot.configuration(measured.lengths))
        apart.append(float(np.linalg.norm(model - measured.tip)))
    assert plant.finished
    assert np.mean(apart) < NEAR
