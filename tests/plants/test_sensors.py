"""Sensors: when they read, how far they are off, and that they add nothing to what they see."""

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.measurement import Measurement
from sinuous.plants.fibre import ShapeSensing
from sinuous.plants.mismatched import Mismatch, MismatchedPlant
from sinuous.plants.plant import Plant
from sinuous.plants.sensors import Accuracy, ShapeTracker, Timing, TipTracker
from sinuous.robots.robot_file import load_robot

from .puppet import Replaced, Runner, Sealed, TruthRead

ROUNDING = 1e-9  # [s] of a clock that adds up a few thousand steps
EXACT = TipTracker()


def watch(tracker: TipTracker, dt: float, steps: int) -> list[Measurement]:
    """What a tracker says of a tip whose x is the time."""
    sensor = tracker.on(Runner(), 0)
    return [sensor.step(np.zeros(1), dt) for _ in range(steps)]


def due(rate: float, dt: float, steps: int) -> list[float]:
    """Ends of steps at or first after the multiples of 1 / rate, by counting in whole ns."""
    ends = [round(1e9 * dt) * k for k in range(1, steps + 1)]
    instants = [round(1e9 / rate) * k for k in range(1, int(steps * dt * rate) + 2)]
    taken = {next((end for end in ends if end >= at), None) for at in instants}
    return sorted(1e-9 * end for end in taken if end is not None)


# All of them are whole numbers of nanoseconds.
TIMES = [(40.0, 0.001), (40.0, 0.04), (40.0, 0.01), (8.0, 0.03), (100.0, 0.003), (40.0, 0.025)]


@pytest.mark.parametrize(("rate", "dt"), TIMES)
def test_a_reading_is_taken_at_the_first_step_end_at_or_after_each_instant(
    rate: float, dt: float
) -> None:
    steps = 2000
    seen = watch(TipTracker(timing=Timing(rate=rate)), dt, steps)
    taken = [0.0, *due(rate, dt, steps)]
    for k, measured in enumerate(seen, 1):
        last = max(t for t in taken if t <= k * dt + ROUNDING)
        assert measured.tip[0] == pytest.approx(last, abs=ROUNDING)
        assert measured.age == pytest.approx(k * dt - last, abs=ROUNDING)


def test_without_a_rate_it_reads_at_every_step() -> None:
    for k, measured in enumerate(watch(EXACT, 0.01, 50), 1):
        assert measured.tip[0] == pytest.approx(0.01 * k, abs=ROUNDING)
        assert measured.age == 0.0


@pytest.mark.parametrize("delay", [0.004, 0.03, 0.1])
def test_a_reading_arrives_after_its_delay(delay: float) -> None:
    """Taken every 25 ms, seen at the first step of 1 ms at or after its time plus the delay."""
    seen = watch(TipTracker(timing=Timing(rate=40.0, delay=delay)), 0.001, 500)
    for k, measured in enumerate(seen, 1):
        last = max(0, (k - round(1000 * delay)) // 25) * 0.025
        assert measured.tip[0] == pytest.approx(last, abs=ROUNDING)
        assert measured.age == pytest.approx(0.001 * k - last, abs=ROUNDING)


def test_before_the_first_reading_it_yields_that_of_the_start() -> None:
    seen = watch(TipTracker(timing=Timing(rate=10.0)), 0.03, 4)
    assert [measured.tip[0] for measured in seen[:3]] == [0.0, 0.0, 0.0]
    assert seen[2].age == pytest.approx(0.09)  # what it says of the start is old by now
    assert seen[3].age == 0.0
    assert seen[3].tip[0] == pytest.approx(0.12)


def test_encoders_are_always_of_this_moment() -> None:
    for k, measured in enumerate(
        watch(TipTracker(timing=Timing(rate=5.0, delay=0.3)), 0.01, 99), 1
    ):
        assert measured.lengths[0] == pytest.approx(0.01 * k, abs=ROUNDING)


def test_the_coil_moves_with_the_tip_s_frame() -> None:
    measured = watch(TipTracker(coil=(0.01, 0.002, 0.03)), 0.5, 1)[0]
    np.testing.assert_allclose(measured.tip, [0.5 - 0.002, 0.01, 0.03], rtol=0, atol=1e-15)
    np.testing.assert_array_equal(measured.coil, [0.01, 0.002, 0.03])


def errors(accuracy: Accuracy, *, seed: int, count: int) -> Array:
    """Readings less the truth (count, 3)."""
    seen = watch_errors(TipTracker(accuracy=accuracy), seed, count)
    return np.array(seen)


def watch_errors(tracker: TipTracker, seed: int, count: int) -> list[Array]:
    sensor = tracker.on(Runner(), seed)
    found = list[Array]()
    for _ in range(count):
        measured = sensor.step(np.zeros(1), 0.01)
        found.append(measured.tip - sensor.truth.T_w_t[:3, 3])
    return found


def test_noise_has_the_stated_spread_per_axis_and_no_mean() -> None:
    """5 standard errors of 4,000 readings."""
    found = errors(Accuracy(noise=1e-3), seed=1, count=4000)
    assert np.all(np.abs(np.std(found, axis=0) / 1e-3 - 1.0) < 5 / np.sqrt(2 * 4000))
    assert np.all(np.abs(np.mean(found, axis=0)) < 5e-3 / np.sqrt(4000))
    neighbours = np.mean(found[1:] * found[:-1], axis=0) / 1e-6
    assert np.all(np.abs(neighbours) < 5 / np.sqrt(4000))


def test_bias_stays_and_has_the_stated_length_in_any_direction() -> None:
    """Over 400 seeds the mean of a component's square is a third, by 5 standard errors."""
    found = [errors(Accuracy(bias=1e-3), seed=seed, count=3) for seed in range(400)]
    for one in found:
        np.testing.assert_allclose(one, np.tile(one[0], (3, 1)), rtol=0, atol=1e-15)
        assert np.linalg.norm(one[0]) == pytest.approx(1e-3)
    directions = np.array([one[0] for one in found]) / 1e-3
    assert np.all(np.abs(np.mean(directions, axis=0)) < 5 / np.sqrt(3 * 400))
    spread = np.sqrt(4.0 / 45.0 / 400)  # of the square of a component of a unit vector
    assert np.all(np.abs(np.mean(directions**2, axis=0) - 1.0 / 3.0) < 5 * spread)


def test_the_printed_accuracy_is_bias_and_noise_together() -> None:
    printed = TipTracker.printed()
    assert printed.timing == Timing(rate=40.0)
    assert printed.coil == (0.0, 0.0, 0.01)
    assert printed.accuracy.rms == pytest.approx(1.4e-3)
    assert printed.accuracy.variance == pytest.approx(1.4e-3**2 / 3.0)
    sensor_errors = [errors(printed.accuracy, seed=seed, count=50) for seed in range(40)]
    rms = np.sqrt(np.mean(np.sum(np.square(sensor_errors), axis=2)))
    assert rms == pytest.approx(1.4e-3, rel=0.01)  # the bias alone is 94 % of its square
    assert np.mean(np.std(sensor_errors, axis=1)) == pytest.approx(0.2e-3, rel=0.05)


def test_a_shape_tracker_sees_all_points_with_its_own_noise_and_one_bias() -> None:
    accuracy = Accuracy(noise=0.5e-3, bias=2e-3)
    sensor = ShapeTracker(accuracy=accuracy).on(Runner(points=2000), 3)
    first = sensor.step(np.zeros(1), 0.01)
    found = first.points - sensor.truth.points
    assert np.linalg.norm(np.mean(found, axis=0)) == pytest.approx(2e-3, rel=0.03)
    assert np.all(np.abs(np.std(found, axis=0) / 0.5e-3 - 1.0) < 5 / np.sqrt(2 * 2000))
    np.testing.assert_array_equal(first.tip, first.points[-1])
    np.testing.assert_array_equal(first.coil, np.zeros(3))
    assert first.covariance.shape == (2000, 3, 3)
    np.testing.assert_allclose(first.covariance[7], accuracy.variance * np.eye(3), rtol=1e-12)


def test_the_seed_decides_what_is_read_and_is_not_the_plant_s_own() -> None:
    accuracy = Accuracy(noise=1e-3, bias=1e-3)
    one, same, other = (errors(accuracy, seed=seed, count=5) for seed in (3, 3, 4))
    assert np.array_equal(one, same)
    assert not np.array_equal(one, other)
    plain = np.random.default_rng(3).normal(size=(5, 3))
    noise = errors(Accuracy(noise=1.0), seed=3, count=5)
    assert not np.any(np.isclose(noise.ravel()[:, None], plain.ravel(), rtol=0, atol=1e-9))


def sensors(robot: Any) -> list[Callable[[Plant, int], Plant]]:
    return [TipTracker.printed().on, ShapeTracker().on, ShapeSensing(robot=robot).on]


@pytest.mark.parametrize("which", range(3))
def test_what_was_measured_is_a_copy(which: int) -> None:
    """Nobody can change the truth by changing a measurement, and no later step changes it."""
    robot = load_robot("opencr_v4")
    plant = MismatchedPlant(robot, seed=1, mismatch=Mismatch.representative())
    sensor = sensors(robot)[which](plant, 1)
    measured = sensor.step(np.zeros(9), 0.1)
    tip, points = sensor.truth.points[-1].copy(), measured.points.copy()
    measured.tip[:] += 1.0
    np.testing.assert_array_equal(sensor.truth.points[-1], tip)
    measured.tip[:] -= 1.0
    sensor.step(robot.rate_limits[:, 1], 0.1)
    np.testing.assert_allclose(measured.points, points, rtol=0, atol=1e-15)


def test_a_tip_tracker_tells_nothing_of_the_body() -> None:
    """The same tip on another body is the same measurement."""
    robot = load_robot("opencr_v4")
    plant = MismatchedPlant(robot, seed=1, mismatch=Mismatch.representative())
    garbage = replace(
        plant.truth,
        points=np.full_like(plant.truth.points, np.nan),
        curvature=np.full_like(plant.truth.curvature, np.nan),
    )
    one = TipTracker.printed().on(plant, 1).step(np.zeros(9), 0.1)
    other = TipTracker.printed().on(Replaced(plant, garbage), 1).step(np.zeros(9), 0.1)
    assert not one.has_shape
    for name in ("tip", "lengths", "points", "covariance", "coil"):
        np.testing.assert_array_equal(getattr(one, name), getattr(other, name))


def test_a_fibre_sees_curvature_and_the_coil_but_no_points() -> None:
    robot = load_robot("opencr_v4")
    plant = MismatchedPlant(robot, seed=1, mismatch=Mismatch.representative())
    garbage = replace(plant.truth, points=np.full_like(plant.truth.points, np.nan))
    sensing = ShapeSensing(robot=robot)
    one = sensing.on(plant, 1).step(np.zeros(9), 0.1)
    other = sensing.on(Replaced(plant, garbage), 1).step(np.zeros(9), 0.1)
    np.testing.assert_array_equal(one.points, other.points)
    assert np.all(np.isfinite(one.points))


@pytest.mark.parametrize("which", range(3))
def test_measuring_works_with_the_truth_sealed_behind_the_sensor(which: int) -> None:
    """What a controller is handed: a step measures, and asking for the truth fails."""
    robot = load_robot("opencr_v4")
    plant = Sealed(sensors(robot)[which](MismatchedPlant(robot, seed=1), 1))
    assert np.all(np.isfinite(plant.step(np.zeros(9), 0.1).tip))
    with pytest.raises(TruthRead):
        _ = plant.truth


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Timing(rate=0.0),
        lambda: Timing(rate=np.nan),
        lambda: Timing(delay=-0.1),
        lambda: Timing(delay=np.inf),
        lambda: Accuracy(noise=-1e-3),
        lambda: Accuracy(bias=np.nan),
        lambda: Accuracy(bias=np.inf),
    ],
)
def test_senseless_values_are_refused(wrong: Callable[[], object]) -> None:
    with pytest.raises(ValueError, match=r"must be"):
        wrong()
