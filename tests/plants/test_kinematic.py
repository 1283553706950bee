"""The disturbed integrator (5)-(7): exact without disturbance, with it as printed."""

from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array, ArrayLike
from sinuous.plants.kinematic import Disturbance, KinematicPlant
from sinuous.robots.chain_kernels import STRAIGHT, Chain
from sinuous.robots.robot_file import load_robot

DT = 1 / 30  # [s]
ROUNDING = 1e-14  # [m] a hundred additions of steps of 0.1 mm to lengths below 1 m
MANY = 4000  # points and actuators of the transparent robot, for statistics
# Of the statistics of DRAWS times MANY samples: 5 standard errors of a standard deviation.
DRAWS = 10
SPREAD = 5 / np.sqrt(2 * DRAWS * MANY)


class Transparent:
    """Stands in for a robot and hides nothing: each actuator moves one point along x."""

    def __init__(self, count: int) -> None:
        self.home = np.zeros(count)
        self.radii = np.ones(count + 1)
        self.chain = Chain(
            turns=np.array([STRAIGHT]),
            theta_column=np.array([-1]),
            gamma_column=np.array([-1]),
            fixed_length=np.ones(1),
            direction=np.array([[0.0, 0.0, 1.0]]),
            section=np.zeros(count + 1, dtype=np.int64),
            fraction=np.linspace(0.0, 1.0, count + 1),
        )

    def lengths(self, c: ArrayLike) -> Array:
        return np.asarray(c, dtype=float)

    def configuration(self, lengths: ArrayLike) -> Array:
        return np.asarray(lengths, dtype=float)

    def points(self, c: ArrayLike) -> Array:
        points = np.zeros((len(self.radii), 3))
        points[1:, 0] = c
        return points

    def shape(self, c: ArrayLike) -> tuple[Array, Array]:
        points, T_w_t = self.points(c), np.eye(4)
        T_w_t[:3, 3] = points[-1]
        return points, T_w_t


class Overheard:
    """A robot that remembers which lengths it was asked to explain."""

    def __init__(self, robot: Any) -> None:
        self._robot = robot
        self.asked = list[Array]()

    def configuration(self, lengths: Array) -> Array:
        self.asked.append(lengths)
        return self._robot.configuration(lengths)

    def __getattr__(self, name: str) -> Any:
        return getattr(self._robot, name)


def seen(steps: int, *, dt: float = DT, seed: int = 0, count: int = 50, **fields: float) -> Array:
    """What a robot that is told to stand still seems to do: points (steps, S, 3)."""
    robot: Any = Transparent(count)
    plant = KinematicPlant(robot, seed=seed, disturbance=Disturbance(**fields))
    return np.array([plant.step(np.zeros(count), dt).points for _ in range(steps)])


def test_without_disturbance_it_integrates_exactly() -> None:
    robot, rng = load_robot("hachen2025"), np.random.default_rng(1)
    c = robot.home + 0.05 * rng.normal(size=9) * np.tile([1.0, 1.0, 0.01], 3)
    plant = KinematicPlant(robot, seed=0, start=c)
    for _ in range(100):
        dt, step = rng.uniform(0.001, 0.1), 1e-3 * rng.normal(size=9) * np.tile([1.0, 1.0, 0.01], 3)
        c = c + step
        measured = plant.step(robot.lengths_jacobian(c) @ step / dt, dt)
        np.testing.assert_allclose(measured.lengths, robot.lengths(c), rtol=0, atol=ROUNDING)
        np.testing.assert_allclose(measured.points, robot.points(c), rtol=0, atol=100 * ROUNDING)
        assert np.array_equal(measured.tip, measured.points[-1])


def test_it_starts_at_home() -> None:
    robot = load_robot("opencr_v4")
    measured = KinematicPlant(robot, seed=0).step(np.zeros(9), DT)
    np.testing.assert_allclose(measured.points, robot.points(robot.home), rtol=0, atol=ROUNDING)


def test_disturbances_have_the_stated_spread() -> None:
    """Of each kind alone; six steps of one draw apart."""
    lengths = seen(6 * DRAWS, count=MANY, length_std=0.2e-3)[::6, 1:, 0]
    points = seen(6 * DRAWS, count=MANY, point_std=1e-3)[::6, 1:]
    for values, std in ((lengths, 0.2e-3), (points, 1e-3)):
        assert abs(np.std(values) / std - 1.0) < SPREAD
        assert abs(np.mean(values)) < 5 * std / np.sqrt(values.size)
    assert np.all(seen(6, length_std=0.2e-3)[:, :, 1:] == 0.0)  # w_x moves along the robot only


def test_disturbances_are_clipped_and_not_drawn_again() -> None:
    """As (5), (6) clip: what lies beyond sits at the limit, erfc(1 / sqrt 2) = 31.7 % of it."""
    share, error = 0.3173, 5 * np.sqrt(0.3173 * 0.6827 / (DRAWS * MANY))
    lengths = seen(6 * DRAWS, count=MANY, length_std=1e-3, length_max=1e-3)[::6, 1:, 0]
    points = seen(6 * DRAWS, count=MANY, point_std=1e-3, point_max=1e-3)[::6, 1:]
    for values in (lengths, points):
        assert np.max(np.abs(values)) == 1e-3
        assert abs(np.mean(np.abs(values) == 1e-3) - share) < error


def test_printed_values() -> None:
    printed = Disturbance.printed()
    assert (printed.length_std, printed.length_max) == (0.2e-3, 2e-3)
    assert (printed.point_std, printed.point_max) == (1e-3, 5e-3)
    assert printed.rate == 5.0


@pytest.mark.parametrize(("dt", "held"), [(1 / 30, 6), (1 / 1000, 200), (0.1, 2), (0.2, 1)])
def test_disturbances_are_held_for_a_fifth_of_a_second(dt: float, held: int) -> None:
    points = seen(12 * held, dt=dt, length_std=1e-3, point_std=1e-3)
    changed = np.any(points[1:] != points[:-1], axis=(1, 2))
    assert list(np.flatnonzero(changed) + 1) == list(range(held, 12 * held, held))


def test_steps_that_do_not_divide_the_period_keep_the_rate_on_average() -> None:
    points = seen(1000, dt=0.07, point_std=1e-3)
    changed = np.count_nonzero(np.any(points[1:] != points[:-1], axis=(1, 2)))
    assert abs(changed - 1000 * 0.07 * 5.0) <= 1


def test_seed_decides_the_run() -> None:
    disturbance = {"length_std": 1e-3, "point_std": 1e-3}
    assert np.array_equal(seen(30, seed=3, **disturbance), seen(30, seed=3, **disturbance))
    assert not np.array_equal(seen(30, seed=3, **disturbance), seen(30, seed=4, **disturbance))


def test_length_disturbance_leaves_the_sum_rule_and_the_nearest_lengths_make_the_shape() -> None:
    """Notes B14: w_x violates (19); the shape is that of the projected lengths.

    Projected means: the backbone as disturbed, the bend by least squares over the cables.
    """
    robot = load_robot("hachen2025")
    overheard: Any = Overheard(robot)
    plant = KinematicPlant(overheard, seed=2, disturbance=Disturbance(length_std=0.2e-3))
    measured = plant.step(np.zeros(12), DT)
    q = overheard.asked[-1].reshape(3, 4)
    violation = np.abs(3.0 * q[:, 3] - np.sum(q[:, :3], axis=1))
    assert np.all(violation > 1e-5)  # [m] disturbed by 0.2 mm
    c = list[float]()
    for segment, (*cables, gamma) in zip(robot.segments, q, strict=True):
        bend, *_ = np.linalg.lstsq(-segment.holes, np.array(cables) - gamma)
        c += [*bend, gamma]
    np.testing.assert_allclose(measured.points, robot.points(c), rtol=0, atol=ROUNDING)
    kept = robot.lengths(c).reshape(3, 4)
    assert np.max(np.abs(3.0 * kept[:, 3] - np.sum(kept[:, :3], axis=1))) < ROUNDING
    assert np.array_equal(measured.lengths, robot.lengths(robot.home))  # as commanded


def test_disturbance_of_the_output_does_not_add_up() -> None:
    """(7) disturbs what is seen, not the state: after many draws the mean is still home."""
    points = seen(6 * 500, count=20, length_std=0.2e-3)[::6, 1:, 0]
    assert np.max(np.abs(points[-1])) < 6 * 0.2e-3  # a random walk would reach 4.5 mm
    assert np.max(np.abs(np.mean(points, axis=0))) < 5 * 0.2e-3 / np.sqrt(500)


def test_the_base_is_fixed() -> None:
    robot = load_robot("hachen2025")
    plant = KinematicPlant(robot, seed=5, disturbance=Disturbance.printed())
    for _ in range(30):
        measured = plant.step(robot.rate_limits[:, 1], DT)
        assert np.array_equal(measured.points[0], robot.T_w_b[:3, 3])
        assert np.all(measured.points[1:] != robot.T_w_b[:3, 3])


def test_what_was_measured_does_not_change_afterwards() -> None:
    robot = load_robot("hachen2025")
    plant = KinematicPlant(robot, seed=0, disturbance=Disturbance.printed())
    first = plant.step(robot.rate_limits[:, 1], DT)
    lengths, points = first.lengths.copy(), first.points.copy()
    plant.step(robot.rate_limits[:, 1], DT)
    assert np.array_equal(first.lengths, lengths)
    assert np.array_equal(first.points, points)


@pytest.mark.parametrize("field", ["length_std", "point_std", "length_max", "point_max", "rate"])
@pytest.mark.parametrize("value", [-1e-3, np.nan])
def test_senseless_values_are_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=r"zero or more"):
        Disturbance(**{field: value})


@pytest.mark.parametrize(("field", "value"), [("rate", 0.0), ("length_std", np.inf),
                                              ("point_std", np.inf), ("rate", np.inf)])  # fmt: skip
def test_values_without_meaning_are_refused(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=r"zero or more"):
        Disturbance(**{field: value})
