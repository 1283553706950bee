"""Robots of segments as physics: shape, whole cables, tensions, springs over long ticks."""

from dataclasses import replace
from pathlib import Path
from typing import Any, cast

import mujoco
import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.plants.physics import plant as plant_module
from sinuous.plants.physics.implicit_springs import ImplicitSprings
from sinuous.plants.physics.plant import PhysicsPlant
from sinuous.plants.physics.rod_model import RodBody
from sinuous.robots.parts import CableConvention, Insertion, Tool
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot_file import PRESETS, load_pcc
from sinuous.robots.rod_mechanics import RodMechanics

ROBOT = load_pcc("hachen2025")
SAME_SHAPE = 5e-5  # [m] two links in a gap, second order: what the tip of 195 mm is off at most
SAME_CABLE = 1e-5  # [m] the same for cables, of which 20 to 100 um are to be seen
STRAIGHT = 1e-12  # [m]
TICK = 0.005  # [s]
WEIGHTLESS = (0.0, 0.0, 0.0)
MODERATE, LARGE = 0.9, 1.75  # bend of each segment [rad]; its limit is 1.86

ROBOTS = {
    "hachen2025": ROBOT,
    "at the motors": replace(ROBOT, convention=CableConvention.MOTOR),
    "fixed lengths": load_pcc("opencr_v4"),
    "stage and tool": replace(
        ROBOT,
        insertion=Insertion(travel=(0.0, 0.1), home=0.03, radius=0.006),
        tool=Tool(offset=(0.004, 0.0, 0.02), radius=0.003),
        T_w_b=np.array([[0.0, 0, 1, 0.2], [0, 1, 0, -0.1], [-1, 0, 0, 0.3], [0, 0, 0, 1]]),
    ),
}


def bent(robot: PccRobot, seed: int, bend: float = 0.7) -> Array:
    """A configuration with bends of that size in random directions."""
    rng = np.random.default_rng(seed)
    c = robot.home.copy()
    for j, name in enumerate(robot.coordinate_names):
        if name.endswith("theta_x"):
            angle = rng.uniform(0.0, 2.0 * np.pi)
            c[j : j + 2] = bend * np.array([np.cos(angle), np.sin(angle)])
        if name.endswith("length"):
            c[j] *= rng.uniform(0.75, 1.25)
    return c


def posed(robot: PccRobot, c: Array) -> tuple[RodBody, Any]:
    body, engine = RodBody(robot=robot), cast(Any, mujoco)
    model = body.spec.compile()
    data = engine.MjData(model)
    body.pose(model, data, c)
    engine.mj_fwdPosition(model, data)
    return body, data


@pytest.mark.parametrize("name", ROBOTS)
@pytest.mark.parametrize("seed", [0, 1])
def test_the_shape_is_the_robots(name: str, seed: int) -> None:
    robot = ROBOTS[name]
    c = bent(robot, seed)
    body, data = posed(robot, c)
    points, T_w_t = body.shape(data)
    np.testing.assert_allclose(points, robot.points(c), rtol=0, atol=SAME_SHAPE)
    np.testing.assert_allclose(T_w_t, robot.tip_pose(c), rtol=0, atol=1e-3)
    np.testing.assert_allclose(T_w_t[:3, 3], points[-1], rtol=0, atol=STRAIGHT)


@pytest.mark.parametrize("name", ROBOTS)
def test_straight_cables_are_as_long_as_the_robot_says(name: str) -> None:
    robot = ROBOTS[name]
    body, data = posed(robot, robot.home)
    told = body.cable_lengths(robot.lengths(robot.home))
    np.testing.assert_allclose(data.ten_length, told, rtol=0, atol=STRAIGHT)


@pytest.mark.parametrize("name", ROBOTS)
def test_bent_cables_are_shorter_by_arcs_less_chords(name: str) -> None:
    """Between holes d off the backbone, a gap g bent by t has the arc g - d t, and the chord
    g sin(t/2) / (t/2) - 2 d sin(t/2): that cables run straight is all that is left over."""
    robot = ROBOTS[name]
    c = bent(robot, 3)
    body, data = posed(robot, c)
    left = data.ten_length - body.cable_lengths(robot.lengths(c))
    names, expected = list(robot.coordinate_names), np.zeros(len(left))
    for j, segment in enumerate(robot.segments, 1):
        first = names.index(f"segment {j} theta_x")
        theta = c[first : first + 2] / segment.disks
        extensible = f"segment {j} length" in names
        length = c[first + 2] if extensible else segment.home_length
        g, t = length / segment.disks, float(np.hypot(*theta))
        for k, (last, hole) in enumerate(body.reading.holes):
            d = float(theta @ hole) / t
            chord = g * np.sinc(t / 2.0 / np.pi) - 2.0 * d * np.sin(t / 2.0)
            expected[k] += segment.disks * (chord - (g - d * t)) if last >= j - 1 else 0.0
    np.testing.assert_allclose(left, expected, rtol=0, atol=SAME_CABLE)
    assert np.max(np.abs(expected)) > 2.0 * SAME_CABLE


def test_both_conventions_mean_the_same_cables() -> None:
    own, motor = ROBOTS["hachen2025"], ROBOTS["at the motors"]
    c = bent(own, 4)
    lengths = [RodBody(robot=robot).cable_lengths(robot.lengths(c)) for robot in (own, motor)]
    np.testing.assert_allclose(*lengths, rtol=0, atol=STRAIGHT)


def test_a_longer_segment_bends_more_easily() -> None:
    c = ROBOT.home.copy()
    c[2] *= 1.2
    body, engine = RodBody(robot=ROBOT), cast(Any, mujoco)
    model = body.spec.compile()
    before = model.jnt_stiffness.copy()
    body.place(model, engine.MjData(model), ROBOT.lengths(c))
    after = model.jnt_stiffness
    first = 5 * ROBOT.segments[0].disks  # hinges of a segment: two bends a link, a twist a gap
    np.testing.assert_allclose(after[:first], before[:first] / 1.2, rtol=1e-12)
    np.testing.assert_allclose(after[first:], before[first:], rtol=1e-12)


# --- in motion -------------------------------------------------------------------------------


def plant(c: Array | None = None, **options: Any) -> PhysicsPlant:
    return PhysicsPlant(ROBOT, start=c, tick=TICK, **options)


def test_straight_and_without_weight_all_cables_have_their_pretension() -> None:
    cables = ROBOT.mechanics.cables
    still = plant(gravity=WEIGHTLESS)
    np.testing.assert_allclose(still.tensions, cables.stiffness * cables.pretension, rtol=1e-6)
    np.testing.assert_allclose(
        still.truth.points, ROBOT.points(ROBOT.home), rtol=0, atol=SAME_SHAPE
    )


@pytest.mark.parametrize("seed", range(3))
def test_no_cable_is_slack_in_moderate_bends(seed: int) -> None:
    assert not np.any(plant(bent(ROBOT, seed, MODERATE)).slack)


@pytest.mark.parametrize("seed", range(3))
def test_cables_are_slack_in_large_bends(seed: int) -> None:
    assert np.any(plant(bent(ROBOT, seed, LARGE)).slack)


def test_weight_and_tip_load_pull_it_their_way() -> None:
    level = ROBOT.at([[0.0, 0, 1, 0], [0, 1, 0, 0], [-1, 0, 0, 0], [0, 0, 0, 1]])
    hanging = PhysicsPlant(level, tick=TICK).truth.points[-1]
    loaded = PhysicsPlant(level, tick=TICK, tip_force=(0.0, 0.0, -0.2)).truth.points[-1]
    payload = PhysicsPlant(level, tick=TICK, payload=0.2 / 9.81).truth.points[-1]
    assert loaded[2] < hanging[2] < -1e-4
    np.testing.assert_allclose(payload, loaded, rtol=0, atol=SAME_SHAPE)


def moving(steps: int, dt: float) -> Array:
    """Rates (steps, P) [m/s] that swing all segments and lengthen and shorten them."""
    t = dt * np.arange(steps)[:, None]
    swing = 0.012 * np.cos(2.0 * np.pi * t - np.arange(3) * 2.0 * np.pi / 3.0)
    stretch = 0.004 * np.cos(np.pi * t)
    return np.hstack([np.hstack([share * swing + stretch, stretch]) for share in (1.0, -0.6, 0.4)])


def test_damping_takes_springs_as_implicitly_as_discrete_does(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    rates, take, tips = moving(40, TICK), ImplicitSprings.take, list[Array]()
    for walls in (False, True):
        monkeypatch.setattr(
            ImplicitSprings,
            "take",
            lambda self, model, walls=walls, **_: take(self, model, walls=walls),
        )
        mover = plant()
        tips.append(np.array([mover.step(each, TICK).tip for each in rates]))
    np.testing.assert_allclose(*tips, rtol=0, atol=1e-6)
    assert np.ptp(tips[0], axis=0).max() > 0.003


def test_long_ticks_stay_stable_and_come_to_rest() -> None:
    mover = PhysicsPlant(ROBOT, tick=0.01, tip_force=(0.2, 0.0, 0.0))
    for rates in moving(60, 0.01):
        mover.step(rates, 0.01)
    for _ in range(40):
        mover.step(np.zeros(12), 0.01)
    tips = [mover.step(np.zeros(12), 0.01).tip for _ in range(5)]
    assert np.ptp(tips, axis=0).max() < 1e-6
    assert np.all(np.linalg.norm(np.diff(mover.truth.points, axis=0), axis=1) < 0.004)


def test_more_links_change_little() -> None:
    """What two links in a gap are off under weight and a tip load, against four."""
    c, tips = bent(ROBOT, 5, 0.6), list[Array]()
    for links in (2, 4):
        robot = replace(ROBOT, mechanics=RodMechanics(links_per_gap=links))
        still = PhysicsPlant(robot, start=c, tick=0.01, tip_force=(0.0, 0.2, 0.0))
        tips.append(still.truth.points[-1])
    assert np.linalg.norm(tips[0] - tips[1]) < 2e-4


def test_mechanics_refuses_what_is_none() -> None:
    for change in ({"disk_mass": -1.0}, {"damping": np.inf}, {"links_per_gap": 0}):
        with pytest.raises(ValueError, match=next(iter(change))):
            RodMechanics(**cast(Any, change))


@pytest.mark.parametrize(
    ("line", "change", "field"),
    [
        ("poisson = 0.33", "poisson = 0.7", "physics.poisson"),
        ("youngs_modulus_gpa = 60", "youngs_modulus_gpa = 0", "physics.youngs_modulus_gpa"),
        ("disk_mass_g = 0.3", "disk_mass_g = -1", "physics.disk_mass_g"),
        ("disk_mass_g = 0.3", "links_per_gap = 0", "physics.links_per_gap"),
    ],
)
def test_a_robot_file_says_what_it_is_made_of(
    tmp_path: Path, line: str, change: str, field: str
) -> None:
    text = (PRESETS / "hachen2025.toml").read_text(encoding="utf-8")
    stated = load_pcc("hachen2025").mechanics
    assert stated.backbone.youngs_modulus == 60e9
    assert stated.backbone.density == pytest.approx(6450.0)
    path = tmp_path / "robot.toml"
    path.write_text(text.replace(line, change), encoding="utf-8")
    with pytest.raises(InputError, match=field):
        load_pcc(path)


@pytest.mark.parametrize(("flip", "same"), [(plant_module.FLIP, True), (np.inf, False)])
def test_cables_that_flip_from_tick_to_tick_are_calmed(
    flip: float, same: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    """After a kick, bent and with ticks of 5 ms; left alone two states take turns for ever."""
    monkeypatch.setattr(plant_module, "FLIP", flip)
    robot = load_pcc("hachen2025")
    bent = [0.07, 0.173, 0.0642, -0.214, -0.525, 0.0642, -0.1475, -0.362, 0.0642]
    p = PhysicsPlant(robot, tip_force=(0.2, 0.0, 0.0), tick=0.005, start=bent)
    still = np.zeros(12)
    p.step(still, 1.5)
    rest = p.tensions
    data = p._engine.data
    data.qvel[:] += 10.0 * np.random.default_rng(0).normal(size=len(data.qvel))
    p.step(still, 0.1)
    for _ in range(28):
        p.step(still, 0.05)
    one = p.tensions
    p.step(still, 0.005)
    flipping = float(np.max(np.abs(p.tensions - one)))
    assert (flipping < 0.1) == same
    assert (float(np.max(np.abs(one - rest))) < 0.5) == same
