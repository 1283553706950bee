"""A calibrated plant rests where its statics say, remembers friction, and tells slack cables."""

from dataclasses import replace

import numpy as np
import pytest

from sinuous.calibration.tracking import nominal, ring, track
from sinuous.plants.calibrated import CalibratedPlant
from sinuous.robots.elastic import ElasticModel
from sinuous.robots.fitted_tables import Fitted
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_pcc

ANGLES = np.deg2rad([0, 120, 240, 30, 150, 270, 60, 180, 300])
# Settled to 1e-7 rad, on a robot of 0.19 m.
SETTLED = 1e-7
DT = 0.05


def calibrated(*, friction: float = 0.0, stiffness: float = 1e10) -> PccRobot:
    """The preset with cables of that stiffness and a millimetre of pretension."""
    robot = load_pcc("opencr_v4")
    model = ElasticModel(
        lengths=np.array([segment.home_length for segment in robot.segments]),
        segment=np.repeat([0, 1, 2], 3),
        holes=4.5e-3 * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1),
        twist=np.zeros(3),
        stiffness=np.full(9, stiffness),
        slack=np.full(9, -1e-3),
        rest=np.zeros((3, 2)),
        friction=np.full(3, friction),
    )
    fitted = Fitted(motors=("m",) * 9, directions=np.ones(9), model=model, T_t_b=np.eye(4))
    return replace(robot, fitted=fitted)


def test_with_stiff_cables_it_is_the_kinematic_robot() -> None:
    robot = calibrated()
    plant, rng = CalibratedPlant(robot), np.random.default_rng(0)
    lengths = robot.lengths(robot.home)
    for _ in range(20):
        c = robot.configuration(lengths + rng.normal(0, 1e-3, 9))
        rates = (robot.lengths(c) - lengths) / DT
        measured = plant.step(rates, DT)
        lengths = lengths + rates * DT
        np.testing.assert_allclose(measured.lengths, lengths)
        np.testing.assert_allclose(measured.tip, robot.tip(c), atol=1e-4)
        np.testing.assert_array_equal(measured.tip, plant.truth.points[-1])


def test_steps_of_another_size_come_to_the_same_rest() -> None:
    robot = calibrated(stiffness=3e6)
    rates = 1e-3 * np.array([-2, 1, 1, -2, 2, 0, -1, 2, -1.0])
    tips = list[np.ndarray]()
    for count in (1, 10):
        plant = CalibratedPlant(robot)
        for _ in range(count):
            plant.step(rates, 1.0 / count)
        tips.append(plant.truth.T_w_t[:3, 3])
    np.testing.assert_allclose(tips[0], tips[1], atol=SETTLED)


def test_friction_keeps_a_little_of_the_way_there() -> None:
    rates, ends = 1e-3 * np.array([-2, 1, 1, -2, 2, 0, -1, 2, -1.0]), list[float]()
    for friction in (0.0, 1.0):
        plant = CalibratedPlant(calibrated(friction=friction, stiffness=3e6))
        before = plant.truth.T_w_t[:3, 3]
        for sign in (1, -1):
            for _ in range(20):
                plant.step(sign * rates, 0.05)
        ends.append(float(np.linalg.norm(plant.truth.T_w_t[:3, 3] - before)))
    assert ends[0] < SETTLED
    assert 0.5e-3 < ends[1] < 20e-3


def test_cables_let_go_are_slack() -> None:
    plant = CalibratedPlant(calibrated(stiffness=3e6))
    assert not np.any(plant.slack)
    plant.step(5e-3 * (np.arange(9) == 4), 1.0)
    np.testing.assert_array_equal(plant.slack, np.arange(9) == 4)


def test_a_robot_that_was_not_calibrated_is_refused() -> None:
    with pytest.raises(ValueError, match=r"needs a \[fitted\] table"):
        CalibratedPlant(load_pcc("opencr_v4"))


def test_a_controller_that_knows_the_calibration_follows_better() -> None:
    base = calibrated(stiffness=3e6)
    assert base.fitted is not None
    unknown = nominal(base, load_pcc("opencr_v4"))
    assert len(ring(base)) == 1200
    knows = track(base, base, feedback=False, compensated=True)
    guesses = track(unknown, base, feedback=False)
    assert knows.rms < 0.2 * guesses.rms
