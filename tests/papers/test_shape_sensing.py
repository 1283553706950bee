"""Whole-body sensing: what the experiment stores is what it found, and more sensors know more."""

import json
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from sinuous.papers.experiment import Data
from sinuous.papers.hachen2025.shape_sensing.experiment import (
    MISMATCHES,
    QUICK_INDIVIDUALS,
    QUICK_POSES,
    ROBOTS,
    SENSORS,
    SHAPE_SENSING,
    individual,
    pose,
    rig,
)
from sinuous.papers.workers import Workers

FUSED = "encoders, fibre, tip"


@pytest.fixture(scope="module")
def data() -> Data:
    """The short version, as it is read back from its file."""
    return json.loads(json.dumps(SHAPE_SENSING.run(Workers(), True)))


def row(
    data: Data, sensors: str, robot: str = "hachen2025", mismatch: str = "representative"
) -> Any:
    wanted = (robot, mismatch, sensors)
    return next(r for r in data["rows"] if (r["robot"], r["mismatch"], r["sensors"]) == wanted)


def test_every_robot_mismatch_and_set_of_sensors_has_a_row(data: Data) -> None:
    kinds = {(r["robot"], r["mismatch"], r["sensors"]) for r in data["rows"]}
    assert len(kinds) == len(data["rows"]) == len(ROBOTS) * len(MISMATCHES) * len(SENSORS)
    count = QUICK_INDIVIDUALS * QUICK_POSES
    for one in data["rows"]:
        assert len(one["tip_error_m"]) == len(one["body_rms_m"]) == count
        points = len(one["rms_by_point_m"])
        assert sum(one["histogram"]) == count * points * 3


def test_a_row_sums_up_its_individuals(data: Data) -> None:
    found = [individual(("opencr_v4", "uneven bends", seed, QUICK_POSES))[FUSED]
             for seed in range(QUICK_INDIVIDUALS)]  # fmt: skip
    error = np.array([one["error"] for one in found])
    variance = np.array([one["variance"] for one in found])
    stored = row(data, FUSED, "opencr_v4", "uneven bends")
    tips = np.linalg.norm(error[:, :, -1], axis=2).ravel()
    np.testing.assert_allclose(stored["tip_error_m"], tips, rtol=1e-12)
    within = error**2 <= 4.0 * variance
    np.testing.assert_allclose(stored["coverage_by_axis"], np.mean(within, axis=(0, 1, 2)))
    assert stored["mean_square_normalised"] == pytest.approx(np.mean(error**2 / variance))


def test_more_sensors_know_the_tip_better(data: Data) -> None:
    for robot in ROBOTS:
        rms = {
            sensors: np.sqrt(np.mean(np.square(row(data, sensors, robot)["body_rms_m"])))
            for sensors in SENSORS
        }
        assert rms[FUSED] < 0.5 * rms["encoders alone"]
        assert rms[FUSED] < rms["encoders, tip"]


def test_without_mismatch_the_model_is_right(data: Data) -> None:
    for robot in ROBOTS:
        assert max(row(data, "encoders alone", robot, "none")["tip_error_m"]) < 1e-12


def test_poses_keep_the_robot_s_limits() -> None:
    rng = np.random.default_rng(0)
    for name in ROBOTS:
        robot = rig(name).robot
        for _ in range(100):
            c = pose(robot, rng)
            assert c.shape == robot.home.shape
            assert np.min(robot.bend_slack(c)) > -1e-12


def test_its_items_can_go_to_another_process() -> None:
    assert pickle.loads(pickle.dumps(individual)) is individual


def test_it_draws_its_figures(data: Data, tmp_path: Path) -> None:
    paths = SHAPE_SENSING.draw(data, tmp_path)
    assert [path.name for path in paths] == ["shape.png", "along_the_body.png", "calibration.png"]
    assert all(path.stat().st_size > 20_000 for path in paths)
