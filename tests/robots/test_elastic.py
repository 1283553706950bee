"""Bends of elastic cables: closed forms, limits, and an optimiser that knows no kernel."""

from dataclasses import replace

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import minimize

from sinuous.arrays import Array
from sinuous.robots.elastic import LEAST_STRETCH, ElasticModel
from sinuous.robots.robot_file import load_robot

PITCH = 4.5e-3
LENGTHS = np.array([60e-3, 62.5e-3, 64e-3])
ANGLES = np.deg2rad([0, 120, 240, 30, 150, 270, 60, 180, 300])
SEGMENT = np.repeat([0, 1, 2], 3)
# k r^2 L / EI is about 4, as on the real robot
STIFFNESS = 3.2e6
# Newton's last step is below 1e-7 rad.
SOLVED = 1e-6
# Friction is smoothed over a milliradian: within this share of it closed forms hold.
SMOOTHED = 0.02
BEFORE = np.zeros(9)


def model(**changes: object) -> ElasticModel:
    """Three segments of equal cables, no pretension, no friction."""
    plain = ElasticModel(
        lengths=LENGTHS,
        segment=SEGMENT,
        holes=PITCH * np.stack([np.cos(ANGLES), np.sin(ANGLES)], axis=1),
        twist=np.zeros(3),
        stiffness=np.full(9, STIFFNESS),
        slack=np.zeros(9),
        rest=np.zeros((3, 2)),
        friction=np.zeros(3),
    )
    return replace(plain, **changes)


def pull_of(cable: int, by: float) -> Array:
    """One cable pulled, all others let go."""
    out = np.full(9, -10e-3)
    out[cable] = by
    return out


def energy(m: ElasticModel, pull: Array, u: Array) -> float:
    """The elastic energy over EI, written down once more."""
    total = 0.0
    for j, length in enumerate(m.lengths):
        total += float(np.sum((u[2 * j : 2 * j + 2] - m.rest[j]) ** 2)) / (2.0 * length)
    for a, last in enumerate(m.segment):
        bent = 0.0
        for j in range(last + 1):
            c, s = np.cos(m.twist[j]), np.sin(m.twist[j])
            x, y = m.holes[a]
            bent += (c * x - s * y) * u[2 * j] + (s * x + c * y) * u[2 * j + 1]
        stretch = max(pull[a] - m.slack[a] - bent, 0.0)
        total += 0.5 * m.stiffness[a] * stretch**2
    return total


@pytest.mark.parametrize("cable", range(9))
def test_one_cable_bends_all_it_passes_by_one_curvature(cable: int) -> None:
    pull, passed = 3e-3, LENGTHS[: SEGMENT[cable] + 1]
    curvature = STIFFNESS * PITCH * pull / (1.0 + STIFFNESS * PITCH**2 * np.sum(passed))
    expected = np.zeros((3, 2))
    expected[: len(passed)] = (curvature * passed)[:, None] * [
        np.cos(ANGLES[cable]), np.sin(ANGLES[cable]),
    ]  # fmt: skip
    found = model().at_rest(pull_of(cable, pull))
    np.testing.assert_allclose(found, expected.ravel(), atol=SOLVED)


@given(st.integers(0, 10**6))
def test_it_rests_where_the_energy_is_least(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m = model(slack=rng.normal(0, 0.5e-3, 9), rest=rng.normal(0, 0.1, (3, 2)),
              twist=rng.normal(0, 0.2, 3))  # fmt: skip
    pull = rng.normal(0, 4e-3, 9)
    found = m.at_rest(pull)
    least = minimize(lambda u: energy(m, pull, u), np.zeros(6), method="BFGS", tol=1e-12)
    assert energy(m, pull, found) <= least.fun * (1.0 + 1e-9) + 1e-12


def test_stiff_cables_are_constant_curvature_kinematics() -> None:
    robot = load_robot("opencr_v4")
    c = np.random.default_rng(0).normal(0, 0.5, (20, 6))
    pulls = robot.lengths(np.zeros(6)) - robot.lengths(c)
    off = [
        np.max(np.abs(model(stiffness=np.full(9, k), slack=np.full(9, -1e-3)).trace(pulls) - c))
        for k in (1e9, 1e10)
    ]
    assert off[0] < 0.02
    assert off[1] == pytest.approx(0.1 * off[0], rel=0.05)  # the error goes with 1 / k


def test_a_slack_cable_does_nothing() -> None:
    m = model()
    pulls = np.stack([pull_of(0, 2e-3), pull_of(0, 2e-3) - 5e-3 * (np.arange(9) > 0)])
    bends = m.trace(pulls)
    np.testing.assert_allclose(bends[0], bends[1], atol=SOLVED)
    np.testing.assert_array_equal(m.is_slack(pulls, bends)[0], np.arange(9) > 0)


@given(st.integers(0, 10**6))
def test_motors_can_be_told_how_to_bend_it(seed: int) -> None:
    rng = np.random.default_rng(seed)
    m = model(slack=rng.normal(0, 0.5e-3, 9), rest=rng.normal(0, 0.1, (3, 2)),
              twist=rng.normal(0, 0.2, 3))  # fmt: skip
    bends = rng.normal(0, 0.6, 6)
    pulls = m.pulls(bends)
    np.testing.assert_allclose(m.at_rest(pulls), bends, atol=SOLVED)
    stretched = m.stretch(pulls, bends)
    assert np.min(stretched) > LEAST_STRETCH * (1.0 - 1e-9)
    # and by no more than that: one cable of each segment
    np.testing.assert_allclose(np.min(stretched.reshape(3, 3), axis=1), LEAST_STRETCH)


def test_pretension_alone_bends_nothing() -> None:
    np.testing.assert_allclose(model(slack=np.full(9, -1e-3)).at_rest(BEFORE), 0.0, atol=SOLVED)


def test_friction_leaves_a_loop_as_wide_as_it_is() -> None:
    friction = 1.0
    m = model(friction=np.array([friction, 0.0, 0.0]))
    way = np.concatenate([np.linspace(0, 4e-3, 60), np.linspace(4e-3, 1e-3, 60)])
    u = m.trace(np.array([pull_of(0, by) for by in way]))[:, 0]
    up, down = np.interp(2e-3, way[:60], u[:60]), np.interp(2e-3, way[:59:-1], u[:59:-1])
    stiffness = 1.0 / LENGTHS[0] + STIFFNESS * PITCH**2
    assert down - up == pytest.approx(2.0 * friction / stiffness, rel=SMOOTHED)


def test_within_its_play_a_motor_moves_nothing() -> None:
    m = model(play=0.4e-3)
    way = np.array([0.0, 2e-3, 1.9e-3, 1.7e-3, 1.59e-3, 1.4e-3])
    u = m.trace(np.array([pull_of(0, by) for by in way]))[:, 0]
    np.testing.assert_allclose(u[1:4], u[1], atol=SOLVED)  # 0.3 mm back is within 0.4 mm
    without = model().at_rest(pull_of(0, 1.4e-3 + 0.2e-3))
    assert u[5] == pytest.approx(without[0], abs=SOLVED)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("slack", np.zeros(8)),
        ("stiffness", np.zeros(9)),
        ("friction", np.array([0.0, -1.0, 0.0])),
        ("play", -1e-4),
        ("rest", np.zeros((2, 2))),
    ],
)
def test_nonsense_is_refused(field: str, value: object) -> None:
    with pytest.raises(ValueError, match=r"need|must be"):
        model(**{field: value})
