"""The physics plant: it rests where statics says, moves as its motors do, and fails loudly."""

from dataclasses import replace

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.plants.physics.engine import NO_CONTACT, PhysicsFault
from sinuous.plants.physics.plant import PhysicsPlant
from sinuous.robots.jointed import JointedRobot
from sinuous.robots.mechanics import CableMechanics, JointedMechanics
from sinuous.robots.parts import Insertion
from sinuous.robots.robot_file import load_jointed

ROBOT = load_jointed("qin2020")
WEIGHTLESS = (0.0, 0.0, 0.0)
DT = 0.01
# What is left over of a balance of moments of 1 N m or more, after a second at rest [N m].
BALANCED = 1e-4
STILL = 1e-7  # [m] what a robot at rest moves in a second


def plant(robot: JointedRobot = ROBOT, **options: object) -> PhysicsPlant:
    return PhysicsPlant(robot, **options)  # pyright: ignore[reportArgumentType]


def with_cables(**fields: float) -> JointedRobot:
    return replace(ROBOT, mechanics=JointedMechanics(cables=CableMechanics(**fields)))


def angles_of(p: PhysicsPlant) -> Array:
    """Configuration (n,) whose shape the plant has, by Newton's method on all its points."""
    c = ROBOT.home
    for _ in range(8):
        J = ROBOT.points_jacobian(c).reshape(-1, len(c))
        c = c + np.linalg.lstsq(J, (p.truth.points - ROBOT.points(c)).ravel())[0]
    np.testing.assert_allclose(ROBOT.points(c), p.truth.points, rtol=0, atol=1e-12)
    return c


def potential(c: Array, gravity: Array, payload: float) -> float:
    """Energy [J] of the modules' weights and of a payload at the tip."""
    poses = ROBOT.module_poses(c)
    centres = poses[:, :3, 3] - 0.5 * ROBOT.tube_length * poses[:, :3, 1]
    mass = ROBOT.mechanics.module_mass
    return float(-mass * np.sum(centres @ gravity) - payload * ROBOT.tip(c) @ gravity)


def slope(c: Array, gravity: Array, payload: float) -> Array:
    """Its derivative (n,)."""
    h = 1e-6
    return np.array(
        [
            (potential(c + h * e, gravity, payload) - potential(c - h * e, gravity, payload))
            / (2 * h)
            for e in np.eye(len(c))
        ]
    )


SIDEWAYS = (0.0, 0.0, -9.81)
CASES = {
    "level": {"gravity": SIDEWAYS},
    "upright": {"gravity": (0.0, -9.81, 0.0)},
    "payload": {"gravity": SIDEWAYS, "payload": 0.1},
    "tip force": {"gravity": WEIGHTLESS, "tip_force": (0.4, -0.3, 0.5)},
}


@pytest.mark.parametrize("bent", [0.0, 0.2])
@pytest.mark.parametrize("case", CASES)
def test_at_rest_no_virtual_work_is_done(case: str, bent: float) -> None:
    """J_l(q)' T + dV/dq = J_tip' f: tensions of the engine, everything else of our kinematics."""
    options = CASES[case]
    start = bent * np.random.default_rng(3).uniform(-1, 1, 10)
    p = plant(start=start, **options)
    q = angles_of(p)
    weight = slope(q, np.array(options["gravity"]), options.get("payload", 0.0))
    push = ROBOT.points_jacobian(q)[-1].T @ np.array(options.get("tip_force", WEIGHTLESS))
    left = ROBOT.lengths_jacobian(q).T @ p.tensions + weight - push
    np.testing.assert_allclose(left, 0.0, rtol=0, atol=BALANCED)
    if case != "upright" or bent:
        assert np.max(np.abs(weight - push)) > 100 * BALANCED


def test_a_cable_pulls_as_far_as_it_is_stretched() -> None:
    """T = k (l - l_motor + pretension)."""
    p = plant(start=0.15 * np.ones(10))
    cable = ROBOT.mechanics.cables
    stretch = ROBOT.lengths(angles_of(p)) - p.truth.lengths + cable.pretension
    np.testing.assert_allclose(p.tensions, cable.stiffness * stretch, rtol=0, atol=1e-3)


def test_weightless_and_straight_it_is_the_model() -> None:
    p = plant(gravity=WEIGHTLESS)
    np.testing.assert_allclose(p.truth.points, ROBOT.points(ROBOT.home), rtol=0, atol=1e-9)
    cable = ROBOT.mechanics.cables
    np.testing.assert_allclose(p.tensions, cable.stiffness * cable.pretension, rtol=1e-6)
    assert p.contacts == p.worst_contacts == NO_CONTACT


def test_a_payload_is_a_force_at_the_tip() -> None:
    hung = plant(payload=0.1)
    pulled = plant(tip_force=(0.0, 0.0, -0.981))
    np.testing.assert_allclose(hung.truth.points, pulled.truth.points, rtol=0, atol=STILL)


def test_it_holds_without_slack_and_the_default_pretension_is_why() -> None:
    p = plant()
    before = p.truth.points
    for _ in range(20):
        p.step(np.zeros(15), 0.05)
    assert not p.slack.any()
    np.testing.assert_allclose(p.truth.points, before, rtol=0, atol=STILL)
    sag = np.linalg.norm(before[-1] - ROBOT.tip(ROBOT.home))
    assert 0.5e-3 < sag < 2.5e-3
    loose = plant(with_cables(pretension=0.0))
    assert np.count_nonzero(loose.slack) >= 3
    assert np.linalg.norm(loose.truth.points[-1] - ROBOT.tip(ROBOT.home)) > 1.5 * sag


@pytest.mark.parametrize("tick", [0.001, 0.005, 0.01])
def test_long_ticks_are_stable_and_come_to_the_same_rest(tick: float) -> None:
    p, fine = plant(tick=tick), plant()
    for each in (p, fine):
        follow(each, 0.2 * np.random.default_rng(5).uniform(-1, 1, 10), speed=0.1)
        for _ in range(50):
            each.step(np.zeros(15), DT)
    np.testing.assert_allclose(p.truth.points, fine.truth.points, rtol=0, atol=1e-6)
    assert not p.slack.any()


def follow(p: PhysicsPlant, target: Array, *, speed: float) -> tuple[float, float]:
    """Lead all joints from home to a configuration, gently, the tip at most so fast [m/s].

    Returns the least tension [N] and the largest distance of the tip from the model's [m].
    """
    fractions = np.linspace(0, 1, 40)
    path = np.array([ROBOT.tip(f * target) for f in fractions])
    way = float(np.sum(np.linalg.norm(np.diff(path, axis=0), axis=1)))
    steps = int(np.ceil(1.875 * way / speed / DT))  # what a quintic's peak is above its mean
    least, off, last = np.inf, 0.0, p.truth.lengths
    for k in range(1, steps + 1):
        s = k / steps
        c = s**3 * (10 - 15 * s + 6 * s**2) * target
        wanted = ROBOT.lengths(c)
        p.step((wanted - last) / DT, DT)
        last = wanted
        least = min(least, float(np.min(p.tensions)))
        off = max(off, float(np.linalg.norm(p.truth.points[-1] - ROBOT.tip(c))))
    return least, off


@pytest.mark.parametrize("seed", [0, 1, 2])
def test_it_moves_without_slack(seed: int) -> None:
    """At 0.1 m/s, what a hand does, to joints of up to 0.2 rad: within what its weight does."""
    target = 0.2 * np.random.default_rng(seed).uniform(-1, 1, 10)
    least, off = follow(plant(), target, speed=0.1)
    assert least > 2.0
    assert off < 2.5e-3


def test_motors_lead_cables_without_lag() -> None:
    """Damping acts on how fast a cable stretches; else 0.06 m/s would pull 12 N too little."""
    p, last = plant(gravity=WEIGHTLESS), ROBOT.lengths(ROBOT.home)
    for k in range(1, 21):
        wanted = ROBOT.lengths(0.01 * k * np.eye(10)[8])
        rates, last = (wanted - last) / 0.0055, wanted
        p.step(rates, 0.0055)
    assert np.max(np.abs(rates)) > 0.055
    bent = plant(gravity=WEIGHTLESS, start=0.2 * np.eye(10)[8])
    np.testing.assert_allclose(p.tensions, bent.tensions, rtol=0, atol=3.0)


def test_encoders_tell_what_motors_did_and_motors_have_a_top_speed() -> None:
    p = plant()
    rates = np.linspace(-0.5, 0.5, 15)
    measured = p.step(rates, 1 / 30)
    moved = measured.lengths - ROBOT.lengths(ROBOT.home)
    np.testing.assert_allclose(moved, np.clip(rates, -0.2, 0.2) / 30, rtol=0, atol=1e-15)
    np.testing.assert_array_equal(measured.tip, p.truth.points[-1])
    np.testing.assert_array_equal(measured.tensions, p.tensions)
    np.testing.assert_array_equal(measured.lengths, p.truth.lengths)


def test_play_is_what_a_motor_winds_before_anything_moves() -> None:
    play = 1e-3
    p = plant(with_cables(play=play), gravity=WEIGHTLESS)
    direction = ROBOT.lengths_jacobian(ROBOT.home) @ np.eye(10)[8]
    there = direction / np.max(np.abs(direction)) * play / 2
    before = p.truth.points
    p.step(0.99 * there / 0.1, 0.1)
    np.testing.assert_allclose(p.truth.points, before, rtol=0, atol=STILL)
    for _ in range(10):
        p.step(there / 0.1, 0.1)
    bent = p.truth.points
    assert np.linalg.norm(bent[-1] - before[-1]) > play
    p.step(-1.9 * there / 0.1, 0.1)  # back, within the play
    for _ in range(5):
        p.step(np.zeros(15), 0.1)
    slowest = np.max(np.abs(p.truth.points - bent))
    p.step(-2.0 * there / 0.1, 0.1)
    assert np.max(np.abs(p.truth.points - bent)) > 10 * slowest


def test_the_insertion_stage_carries_the_robot() -> None:
    stage = Insertion(travel=(0.0, 0.2), home=0.02, radius=0.01)
    robot = replace(ROBOT, insertion=stage, speed=replace(ROBOT.speed, insertion=0.05))
    p = plant(robot)
    before = p.truth.points
    for _ in range(20):
        p.step(np.concatenate([[0.05], np.zeros(15)]), DT)
    robot_starts = np.flatnonzero(robot.chain.section > 0)[0]
    moved = p.truth.points[robot_starts:] - before[robot_starts:]
    np.testing.assert_allclose(moved, np.tile([0, 0.01, 0], (len(moved), 1)), rtol=0, atol=2e-5)
    assert p.truth.lengths[0] == pytest.approx(0.03)


def test_the_same_twice_is_the_same_to_the_last_bit() -> None:
    rates = np.random.default_rng(0).uniform(-0.05, 0.05, (20, 15))
    first, second = plant(), plant()
    for row in rates:
        np.testing.assert_array_equal(first.step(row, DT).points, second.step(row, DT).points)
    np.testing.assert_array_equal(first.tensions, second.tensions)


@pytest.mark.parametrize("dt", [1 / 30, 0.005, 0.001])
def test_a_step_takes_as_long_as_it_says(dt: float) -> None:
    p = plant()
    before = p._engine.data.time  # pyright: ignore[reportPrivateUsage]
    p.step(np.zeros(15), dt)
    assert p._engine.data.time - before == pytest.approx(dt)  # pyright: ignore[reportPrivateUsage]


def test_a_rate_that_is_no_number_ends_the_run_for_good() -> None:
    p = plant()
    rates = np.zeros(15)
    rates[3] = np.nan
    with pytest.raises(PhysicsFault, match="the physics failed"):
        p.step(rates, DT)
    with pytest.raises(PhysicsFault):
        p.step(np.zeros(15), DT)
    assert isinstance(p.fault, PhysicsFault)


def test_numbers_that_make_no_sense_are_refused() -> None:
    with pytest.raises(ValueError, match="a tick is positive"):
        plant(tick=0.0)
    with pytest.raises(ValueError, match="a payload zero or more"):
        plant(payload=-1.0)
    with pytest.raises(ValueError, match="gravity and tip force"):
        plant(tip_force=(np.nan, 0.0, 0.0))
