"""The motion that takes most energy out of a connection."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.analysis.ports import channel_energy, drive_ports, worst_sinusoid
from sinuous.teleop.delays import Steady, UniformJitter
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.losses import Outages
from sinuous.teleop.scheme import Scheme
from sinuous.teleop.waves import ActiveChannelWarning, ModifiedWaves, StandardWaves
from sinuous.teleop.worst_case import (
    Basis,
    GivenForce,
    HandLimits,
    LaggingFollower,
    Schedule,
    energy_form,
    respond,
    worst_motions,
    worst_pairs,
)

DT, TICKS, KNOT = 1e-3, 3000, 0.1
DELAY = 0.05
B = 10.0  # [N s/m]
EXACT = 1e-9  # relative rounding of sums over thousands of ticks
NOTHING = 1e-8  # an eigenvalue of zero, of matrices of order one
BASIS = Basis.bumps(TICKS, DT, KNOT)
CLEAN = ConstantDelay(delay=DELAY, dt=DT)
JITTERED = ImpairedLink(effects=(Steady(DELAY), UniformJitter(0.5 * DELAY)), seed=1, in_order=True)
SCHEMES = (StandardWaves(), ModifiedWaves.c1(), ModifiedWaves.c2())
HAND = HandLimits(speed=0.25, reach=0.05)


def schedule(link: ConstantDelay | ImpairedLink) -> Schedule:
    return Schedule.of(link, link, TICKS)


def energy(scheme: Scheme, plan: Schedule, v: Array, F_s: Array) -> float:
    """Of one motion and one force (K,)."""
    answer = respond(scheme, plan, v[:, None], GivenForce(F_s[:, None]))
    return float(energy_form(answer, DT)[0, 0])


def active(gain: float) -> ModifiedWaves:
    with pytest.warns(ActiveChannelWarning):
        return ModifiedWaves(gain=gain, allow_active=True)


def test_bumps_are_motions_from_rest_to_rest() -> None:
    x, v = BASIS
    assert np.all(x[[0, -1]] == 0.0)
    np.testing.assert_allclose(np.cumsum(v, axis=0) * DT, x[1:], rtol=0, atol=EXACT)
    np.testing.assert_allclose(x[500:2500].sum(axis=1), 1.0, rtol=EXACT)  # splines: a partition
    acceleration = np.diff(v, axis=0) / DT
    jerk = np.diff(acceleration, axis=0) / DT
    assert np.abs(jerk).max() == pytest.approx(3.0 / KNOT**3, rel=1e-6)  # no jump of acceleration
    with pytest.raises(ValueError, match="no room"):
        Basis.bumps(100, DT, KNOT)


def test_a_constant_delay_is_a_schedule() -> None:
    plan = schedule(CLEAN)
    sent = np.arange(TICKS) - CLEAN.ticks
    assert np.array_equal(plan.forward, np.maximum(sent, -1))
    assert np.array_equal(plan.backward, plan.forward)


def test_nothing_newer_comes_in_an_outage() -> None:
    link = ImpairedLink(effects=(Steady(DELAY), Outages(((1.0, 2.0),))))
    plan = schedule(link)
    assert set(plan.forward[1060:2040]) == {999}
    assert plan.forward[2060] == 2060 - CLEAN.ticks


@pytest.mark.parametrize("scheme", SCHEMES)
def test_ports_answer_as_they_do_on_their_own(scheme: Scheme) -> None:
    rng = np.random.default_rng(0)
    v, F_s = rng.normal(size=(2, 500, 3))
    alone = drive_ports(scheme, DELAY, v, F_s)
    plan = Schedule.of(CLEAN, CLEAN, 500)
    answer = respond(scheme, plan, v, GivenForce(F_s))
    np.testing.assert_allclose(answer.F_m, alone.F_m, rtol=EXACT)
    np.testing.assert_allclose(answer.v_sd, alone.v_sd, rtol=EXACT)
    one = [energy(scheme, plan, v[:, i], F_s[:, i]) for i in range(3)]
    assert sum(one) == pytest.approx(channel_energy(alone, v, F_s, DT)[-1], rel=EXACT)


@pytest.mark.parametrize("link", [CLEAN, JITTERED])
@pytest.mark.parametrize("scheme", SCHEMES)
def test_the_eigenvalue_is_the_energy_of_its_pair(
    scheme: Scheme, link: ConstantDelay | ImpairedLink
) -> None:
    plan = schedule(link)
    found = worst_pairs(scheme, plan, BASIS, B)
    hand, far = np.split(found.amounts[0], 2)
    v, F_s = BASIS.v @ hand, B * BASIS.v @ far
    effort = 0.5 * DT * (B * v @ v + F_s @ F_s / B)
    assert effort == pytest.approx(1.0, rel=EXACT)
    assert energy(scheme, plan, v, F_s) == pytest.approx(found.rates[0], rel=1e-6, abs=NOTHING)


@settings(max_examples=15)
@given(seed=st.integers(0, 2**32 - 1))
def test_no_other_pair_takes_more(seed: int) -> None:
    plan, scheme = schedule(JITTERED), StandardWaves()
    least = worst_pairs(scheme, plan, BASIS, B).rates[0]
    hand, far = np.random.default_rng(seed).normal(size=(2, BASIS.v.shape[1]))
    v, F_s = BASIS.v @ hand, B * BASIS.v @ far
    effort = 0.5 * DT * (B * v @ v + F_s @ F_s / B)
    assert energy(scheme, plan, v, F_s) >= least * effort - NOTHING


def test_a_constant_delay_gives_energy_only_below_one_half() -> None:
    """Both sides of notes A11."""
    plan = schedule(CLEAN)
    for scheme in (*SCHEMES, ModifiedWaves(gain=0.5, cutoff=np.inf)):
        assert worst_pairs(scheme, plan, BASIS, B).rates[0] > -NOTHING
    assert worst_pairs(active(0.3), plan, BASIS, B).rates[0] < -0.1


def test_no_sinusoid_is_worse() -> None:
    """The sinusoid that is worst for ever, switched on and off, is a pair among others."""
    scheme = active(0.3)
    omega = np.linspace(0.5, 60.0, 500)
    tone = worst_sinusoid(omega, gain=0.3, impedance=B, cutoff=20.0, delay=DELAY)
    v, F_s = (signal[:, 0] for signal in tone.signals(TICKS * DT, DT))
    effort = 0.5 * DT * (B * v @ v + F_s @ F_s / B)
    of_tone = energy(scheme, schedule(CLEAN), v, F_s) / effort
    fine = Basis.bumps(TICKS, DT, 0.02)  # which the tone's frequency is no matter for
    assert worst_pairs(scheme, schedule(CLEAN), fine, B).rates[0] < of_tone < 0.0


def test_held_waves_make_energy_and_the_search_finds_where() -> None:
    """While nothing comes, the last wave is worth its energy again and again."""
    link = ImpairedLink(effects=(Steady(DELAY), Outages(((1.0, 2.0),))))
    far = LaggingFollower(BASIS.v.shape[1], DT, share=1 / 30, pull=75.0, wall=0.0)
    found = worst_motions(StandardWaves(), schedule(link), BASIS, far, HAND)
    v = BASIS.v @ found.amounts[0]
    assert found.rates[0] < 0.0
    at = abs(np.argmax(np.abs(v)) - 999)  # the last wave before it, as large as can be
    assert at < 2 * KNOT / DT


def test_the_follower_is_a_spring_in_the_end_and_a_damper_at_first() -> None:
    far = LaggingFollower(1, DT, share=0.1, pull=75.0, wall=50.0)
    far.move(np.array([1.0]))
    assert far.force(0) == pytest.approx(75.0 * 0.9e-3 + 50.0 * 0.1e-3)
    for _ in range(1000):
        far.move(np.zeros(1))
    assert far.force(0) == pytest.approx(50.0 * 1e-3)


def test_a_motion_is_enlarged_to_the_first_limit() -> None:
    x, v = np.array([0.0, 0.01]), np.array([0.1])
    assert HAND.scale(x, v) == pytest.approx(2.5)
    assert HAND.scale(10.0 * x, v) == pytest.approx(0.5)
