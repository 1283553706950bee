"""A plant that differs from its model: every cause alone, and all together."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.plants.kinematic import KinematicPlant
from sinuous.plants.mismatched import Mismatch, MismatchedPlant
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import load_robot

from .poses import poses

DT = 1 / 30  # [s]
ROUNDING = 1e-12  # [m] a few hundred products of rotations
PRESETS = ("hachen2025", "opencr_v4", "opencr_v6")


def bent(robot: PccRobot, seed: int = 0) -> Array:
    return next(poses(robot, np.random.default_rng(seed), 1))


def shape(robot: PccRobot, c: Array, **fields: Any) -> Array:
    """Points of a plant that stands at c."""
    return MismatchedPlant(robot, seed=0, mismatch=Mismatch(**fields), start=c).truth.points


def go(plant: MismatchedPlant, lengths: Array) -> None:
    plant.step((lengths - plant.truth.lengths) / DT, DT)


def bends(robot: PccRobot, c: Array) -> list[Array]:
    """The bend vectors of the segments, as views of c."""
    return [c[column : column + 2] for column in np.unique(robot.bend_limits.column)]


@pytest.mark.parametrize("name", PRESETS)
def test_without_mismatch_it_is_the_model(name: str) -> None:
    robot, rng = load_robot(name), np.random.default_rng(1)
    start = bent(robot)
    plant = MismatchedPlant(robot, seed=0, start=start)
    exact = KinematicPlant(robot, seed=0, start=start)
    for _ in range(20):
        rates = rng.uniform(*robot.rate_limits.T)
        one, other = plant.step(rates, DT), exact.step(rates, DT)
        np.testing.assert_allclose(one.points, other.points, rtol=0, atol=ROUNDING)
        np.testing.assert_array_equal(one.lengths, other.lengths)
        np.testing.assert_allclose(plant.truth.T_w_t, exact.truth.T_w_t, rtol=0, atol=ROUNDING)
        np.testing.assert_allclose(plant.truth.curvature, exact.truth.curvature, atol=1e-9)


def test_cables_farther_out_bend_less() -> None:
    robot = load_robot("hachen2025")
    c = bent(robot)
    less = c.copy()
    for theta in bends(robot, less):
        theta /= 1.1
    found = shape(robot, c, pitch_factor=1.1)
    np.testing.assert_allclose(found, robot.points(less), rtol=0, atol=ROUNDING)


def test_turned_cables_turn_the_bend() -> None:
    """Of one segment: the whole body turns about the axis of the base."""
    robot = load_robot("hachen2025")
    robot = replace(robot, segments=robot.segments[:1])
    c = bent(robot)
    turn = Rotation.from_rotvec([0.0, 0.0, 0.2]).as_matrix()
    found = shape(robot, c, cable_angle=0.2)
    np.testing.assert_allclose(found, robot.points(c) @ turn.T, rtol=0, atol=ROUNDING)


def test_a_bend_is_handed_on_to_the_next_segment() -> None:
    robot = load_robot("opencr_v4")
    c = bent(robot)
    coupled = c.copy()
    for before, theta in zip(bends(robot, c), bends(robot, coupled)[1:], strict=False):
        theta -= 0.1 * before
    found = shape(robot, c, coupling=-0.1)
    np.testing.assert_allclose(found, robot.points(coupled), rtol=0, atol=ROUNDING)


def test_uneven_segments_bend_as_much_in_all() -> None:
    """In one plane the tip points where the model says, but lies elsewhere."""
    robot = load_robot("hachen2025")
    c = robot.home.copy()
    c[::3] = 0.8, -0.5, 1.0
    plant = MismatchedPlant(robot, seed=0, mismatch=Mismatch(unevenness=0.2), start=c)
    model = robot.tip_pose(c)
    np.testing.assert_allclose(plant.truth.T_w_t[:3, :3], model[:3, :3], rtol=0, atol=ROUNDING)
    assert np.linalg.norm(plant.truth.T_w_t[:3, 3] - model[:3, 3]) > 1e-3
    first = plant.truth.curvature[:30, 0] / (0.8 / 0.065)  # of the model
    np.testing.assert_allclose(first, np.linspace(1.2 - 0.2 / 30, 0.8 + 0.2 / 30, 30), rtol=1e-9)


@pytest.mark.parametrize("name", PRESETS)
@pytest.mark.parametrize("angle", [0.0, 1.0])
def test_a_level_beam_sags_as_stated(name: str, angle: float) -> None:
    """By 2 mm of 122 to 222: small enough for the linear beam, whatever the roll."""
    level = Rotation.from_euler("ZY", [angle, np.pi / 2]).as_matrix()
    T_w_b = np.eye(4)
    T_w_b[:3, :3] = level @ Rotation.from_euler("Z", angle).as_matrix()
    robot = load_robot(name).at(T_w_b)
    change = shape(robot, robot.home, sag=0.002)[-1] - robot.tip(robot.home)
    assert change[2] == pytest.approx(-0.002, rel=2e-3)
    assert np.linalg.norm(change[:2]) < 0.02 * 0.002  # a shortening of 0.6 sag^2 / L


def test_what_stands_upright_does_not_sag_and_what_leans_falls() -> None:
    robot = load_robot("opencr_v4")
    upright = shape(robot, robot.home, sag=0.01)
    np.testing.assert_allclose(upright, robot.points(robot.home), rtol=0, atol=ROUNDING)
    c = robot.home.copy()
    c[0] = 1.0  # leans towards x
    fallen = shape(robot, c, sag=0.01)[-1] - robot.tip(c)
    assert fallen[2] < 0.0 < fallen[0]
    lifted = shape(robot, c, sag=0.01, gravity=(0.0, 0.0, 2.0))[-1] - robot.tip(c)
    assert lifted[2] > 0.0 > lifted[0]


def test_a_tilted_base_turns_all() -> None:
    robot = load_robot("hachen2025")
    c = bent(robot)
    turn = Rotation.from_rotvec([0.0, 0.03, 0.0]).as_matrix()  # towards x
    found = shape(robot, c, base_tilt=(0.03, 0.0))
    np.testing.assert_allclose(found, robot.points(c) @ turn.T, rtol=0, atol=ROUNDING)


def test_play_swallows_what_is_pulled_after_a_turn() -> None:
    """Half of it at the start, all of it after a turn; backbones have none."""
    robot = load_robot("hachen2025")
    plant = MismatchedPlant(robot, seed=0, mismatch=Mismatch(play=1e-3))
    pull = np.array([-1.0, 0.5, 0.5, 0.0] * 3)  # keeps (19)
    home, points = plant.truth.lengths, list[Array]()
    for travel in (0.4e-3, 2.5e-3, 1.9e-3, 1.0e-3):  # of the first cable; the others go half
        go(plant, home + travel * pull)
        points.append(plant.truth.points)
        np.testing.assert_allclose(plant.truth.lengths, home + travel * pull, rtol=0, atol=ROUNDING)
    followed = np.array([-2.0, 0.75, 0.75, 0.0] * 3) * 1e-3
    np.testing.assert_allclose(points[0], robot.points(robot.home), rtol=0, atol=ROUNDING)
    expected = robot.points(robot.configuration(home + followed))
    np.testing.assert_allclose(points[1], expected, rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(points[2], points[1], rtol=0, atol=ROUNDING)  # 0.6 mm back
    assert np.linalg.norm(points[3][-1] - points[2][-1]) > 1e-3  # 1.5 mm back
    extended = plant.truth.lengths + np.array([0.0, 0.0, 0.0, 0.3e-3] * 3)
    go(plant, extended)
    assert plant.truth.points[-1] != pytest.approx(points[3][-1], abs=1e-4)


def test_slack_cables_do_nothing_until_they_are_taut_again() -> None:
    robot = load_robot("hachen2025")
    plant = MismatchedPlant(robot, seed=0, mismatch=Mismatch(slack_bend=0.6))
    tips = list[Array]()
    for bend in (0.5, 0.6, 0.9, 1.2, 0.5):
        c = robot.home.copy()
        c[::3] = bend
        go(plant, robot.lengths(c))
        tips.append(plant.truth.points[-1])
    for k in (2, 3):
        np.testing.assert_allclose(tips[k], tips[1], rtol=0, atol=ROUNDING)
    np.testing.assert_allclose(tips[4], tips[0], rtol=0, atol=ROUNDING)
    assert np.linalg.norm(tips[1] - tips[0]) > 5e-3


@pytest.mark.parametrize("name", PRESETS)
def test_its_curvature_is_that_of_its_points(name: str) -> None:
    """Three points of a circle: curvature by the circle through them."""
    robot = load_robot(name)
    mismatch = replace(Mismatch.representative(), unevenness=0.0, sag=0.0)
    truth = MismatchedPlant(robot, seed=4, mismatch=mismatch, start=bent(robot)).truth
    assert truth.curvature.shape == (len(truth.points) - 1, 2)
    a, b, c = truth.points[:-2], truth.points[1:-1], truth.points[2:]
    sides = [np.linalg.norm(v, axis=1) for v in (b - a, c - b, c - a)]
    circle = 2.0 * np.linalg.norm(np.cross(b - a, c - b), axis=1) / np.prod(sides, axis=0)
    within = np.diff(robot.chain.section[1:]) == 0
    found = np.linalg.norm(truth.curvature, axis=1)[1:]
    np.testing.assert_allclose(found[within], circle[within], rtol=1e-6, atol=1e-6)


def test_it_is_smooth_and_depends_on_its_lengths_alone() -> None:
    """Without play; a step of a micrometre moves no point by more than its lever allows."""
    robot = load_robot("hachen2025")
    mismatch = replace(Mismatch.representative(), play=0.0)
    plant = MismatchedPlant(robot, seed=2, mismatch=mismatch)
    goals = [robot.lengths(c) for c in poses(robot, np.random.default_rng(5), 3)]
    go(plant, goals[0])
    first = plant.truth.points
    go(plant, goals[1])
    go(plant, goals[0])
    np.testing.assert_allclose(plant.truth.points, first, rtol=0, atol=ROUNDING)
    go(plant, goals[0] + 1e-6)
    assert np.max(np.abs(plant.truth.points - first)) < 1e-4
    assert np.max(np.abs(np.diff(plant.truth.points - first, axis=0))) < 5e-6


@pytest.mark.parametrize("name", PRESETS)
def test_the_representative_one_is_millimetres_off(name: str) -> None:
    """Median over poses and individuals between 3 and 6 mm, and no tip off by 25 mm."""
    robot, off = load_robot(name), list[float]()
    for seed in range(10):
        plant = MismatchedPlant(robot, seed=seed, mismatch=Mismatch.representative())
        for c in poses(robot, np.random.default_rng(seed), 8):
            go(plant, robot.lengths(c))
            off.append(float(np.linalg.norm(plant.truth.points[-1] - robot.tip(c))))
    assert 3e-3 < np.median(off) < 6e-3
    assert np.max(off) < 25e-3


def test_the_seed_decides_the_individual_and_nothing_else() -> None:
    robot = load_robot("opencr_v4")
    c = bent(robot)

    def tip(seed: int, mismatch: Mismatch) -> Array:
        return MismatchedPlant(robot, seed=seed, mismatch=mismatch, start=c).truth.points[-1]

    scattered = Mismatch.representative()
    same = replace(scattered, scatter=0.0)
    assert np.array_equal(tip(3, scattered), tip(3, scattered))
    assert not np.array_equal(tip(3, scattered), tip(4, scattered))
    assert np.array_equal(tip(3, same), tip(4, same))


def test_scatter_is_the_stated_share() -> None:
    """Of the cable angle of one segment over 2,000 individuals, by 5 standard errors."""
    robot = load_robot("hachen2025").sampled(0.05)
    robot = replace(robot, segments=robot.segments[:1])
    c = robot.home.copy()
    c[0] = 1.0
    mismatch = Mismatch(cable_angle=0.1, scatter=0.5)
    tips = [
        MismatchedPlant(robot, seed=seed, mismatch=mismatch, start=c).truth.points[-1]
        for seed in range(2000)
    ]
    angles = np.arctan2([tip[1] for tip in tips], [tip[0] for tip in tips])
    assert abs(np.mean(angles) - 0.1) < 5 * 0.05 / np.sqrt(2000)
    assert abs(np.std(angles) / 0.05 - 1.0) < 5 / np.sqrt(2 * 2000)


@pytest.mark.parametrize(
    "wrong",
    [
        lambda: Mismatch(pitch_factor=0.0),
        lambda: Mismatch(sag=-1e-3),
        lambda: Mismatch(play=-1e-3),
        lambda: Mismatch(scatter=-0.1),
        lambda: Mismatch(slack_bend=0.0),
        lambda: Mismatch(slack_bend=np.nan),
        lambda: Mismatch(cable_angle=np.nan),
        lambda: Mismatch(base_tilt=(np.inf, 0.0)),
        lambda: Mismatch(gravity=(0.0, 0.0, 0.0)),
    ],
)
def test_senseless_values_are_refused(wrong: Callable[[], Mismatch]) -> None:
    with pytest.raises(ValueError, match=r"must"):
        wrong()


def test_a_shaft_that_is_all_the_way_back_has_no_length_and_no_curvature() -> None:
    path = Path(__file__).parents[2] / "examples" / "robots" / "endoscope.toml"
    robot = load_robot(path)
    assert robot.home[0] == 0.0  # the insertion stage
    for plant in (KinematicPlant(robot, seed=0), MismatchedPlant(robot, seed=0)):
        measured = plant.step(np.zeros(len(robot.actuator_names)), 1 / 30)
        assert np.all(np.isfinite(plant.truth.curvature))
        np.testing.assert_allclose(measured.points, robot.points(robot.home), atol=1e-12)
