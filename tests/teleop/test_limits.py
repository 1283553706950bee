"""Bounds of force and speed that leave the channel passive."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.delays import Steady, UniformJitter
from sinuous.teleop.force import CappedForce, ErrorForce, Motion
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.losses import RandomLoss
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.receivers import Hold

from .adversary import SCHEMES
from .rigs import DT, PLANE, WALLED, B, Run, run, to_and_hold

ROUNDING = 1e-12
SETTLED = 2e-3  # [N], some seconds after the last motion
CAP = Limits(size=0.3, slew=4.0)  # [N], [N/s]
PACE = Limits(size=0.05, slew=0.2)  # [m/s], [m/s^2]
VECTOR = st.lists(st.floats(-10.0, 10.0), min_size=3, max_size=3).map(np.array)


@given(
    wanted=VECTOR,
    start=VECTOR,
    size=st.floats(0.0, 5.0),
    slew=st.floats(0.0, 1e4),
    gain=st.floats(0.1, 10.0),
)
def test_a_signal_stays_within_and_goes_where_it_is_wanted(
    wanted: Array, start: Array, size: float, slew: float, gain: float
) -> None:
    limits = Limits(size=size, slew=slew)
    before = Limits(size=size).wave(start, start, gain, DT)
    got = limits.wave(wanted, before, gain, DT)
    assert gain * np.linalg.norm(got) <= size + 1e-9
    assert gain * np.linalg.norm(got - before) <= slew * DT + 1e-9
    within = wanted * min(1.0, size / max(gain * float(np.linalg.norm(wanted)), 1e-300))
    far, left = float(np.linalg.norm(within - before)), float(np.linalg.norm(within - got))
    assert left == pytest.approx(max(far - slew * DT / gain, 0.0), abs=1e-9)


def test_without_limits_nothing_changes() -> None:
    wave = np.array([1.0, -20.0])
    np.testing.assert_allclose(Limits().wave(wave, np.zeros(2), 2.0, DT), wave, rtol=1e-15)


@pytest.mark.parametrize("name", SCHEMES)
def test_gains_are_what_the_ports_make_of_a_wave(name: str) -> None:
    scheme, wave = SCHEMES[name], np.array([0.3, -0.7])
    force = scheme.force_at_rest(wave)
    _, felt, _ = scheme.leader_step(scheme.leader_init(2), np.zeros(2), wave)
    _, speed, _ = scheme.follower_step(scheme.follower_init(2), np.zeros(2), wave)
    np.testing.assert_allclose(felt, force)
    np.testing.assert_allclose(np.abs(force), scheme.force_gain * np.abs(wave))
    np.testing.assert_allclose(np.abs(speed), scheme.speed_gain * np.abs(wave))


BAD = ImpairedLink(effects=(Steady(0.1), UniformJitter(0.05), RandomLoss(0.2)), seed=6)
HAND = ImpedanceOperator(to_and_hold(np.array([0.12, -0.1]), duration=1.0))


def teleoperated(name: str, link: Any, **parts: Any) -> Run:
    teleop = Bilateral.connect(
        operator=HAND,
        mapping=PLANE,
        force=WALLED,
        scheme=SCHEMES[name],
        link=link,
        receiver=Hold(longest=0.2),
        control=PassivityControl(),
        **parts,
    )
    return run(teleop, 5.0)


@pytest.mark.parametrize("link", [ConstantDelay(delay=0.2), BAD])
@pytest.mark.parametrize("name", SCHEMES)
def test_no_packet_can_kick_the_hand(name: str, link: Any) -> None:
    free, r = teleoperated(name, link), teleoperated(name, link, felt=CAP)
    damping = SCHEMES[name].damping
    afar = np.linalg.norm(r.F_m - damping * r.V, axis=1)
    assert np.max(np.linalg.norm(free.F_m - damping * free.V, axis=1)) > 1.5 * CAP.size
    assert np.max(afar) <= CAP.size + ROUNDING
    rises = np.diff(afar)
    # Where there is no energy the force falls faster; a force that yields comes back at once.
    if name != "position-force":
        assert np.max(rises) <= CAP.slew * DT + ROUNDING
    assert r.ledger.least.channel >= -ROUNDING


def test_a_hand_that_cannot_hold_more_is_pushed_back_until_nobody_pushes_harder() -> None:
    """At rest both ends agree on the largest force, and the channel has lost nothing to it."""
    r = teleoperated("C2", ConstantDelay(delay=0.2), felt=Limits(size=0.3))
    felt, pressed = np.linalg.norm(r.F_m[-1]), np.linalg.norm(r.F_s[-1])
    assert felt == pytest.approx(0.3, abs=SETTLED)
    assert pressed == pytest.approx(0.3, abs=SETTLED)
    free = teleoperated("C2", ConstantDelay(delay=0.2))
    assert np.linalg.norm(free.F_s[-1]) > 0.5


@pytest.mark.parametrize("name", SCHEMES)
def test_nor_the_follower(name: str) -> None:
    r = teleoperated(name, BAD, speed=PACE)
    admittance = 0.0 if name == "position-force" else 1.0 / B
    wanted = np.linalg.norm(r.V_sd + admittance * r.F_s, axis=1)
    assert np.max(wanted) <= PACE.size + ROUNDING
    assert np.max(wanted) > 0.5 * PACE.size
    assert r.ledger.least.channel >= -ROUNDING


def test_a_capped_force_keeps_its_direction() -> None:
    force = CappedForce(part=ErrorForce(gain=30.0), largest=2.0)
    still = np.zeros(2)
    for X in ([0.03, 0.01], [0.0001, -0.0002], [-0.5, 0.2]):
        motion = Motion(np.array(X), still, still, still)
        whole, got = ErrorForce(gain=30.0).force(motion), force.force(motion)
        assert np.linalg.norm(got) == pytest.approx(min(np.linalg.norm(whole), 2.0))
        assert whole[0] * got[1] - whole[1] * got[0] == pytest.approx(0.0, abs=ROUNDING)
        assert got @ whole > 0.0


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Limits(size=-1.0), "size"),
        (lambda: Limits(slew=np.nan), "slew"),
        (lambda: CappedForce(part=ErrorForce(), largest=0.0), "largest"),
    ],
)
def test_numbers_that_make_no_sense(make: object, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        make()  # type: ignore[operator]
