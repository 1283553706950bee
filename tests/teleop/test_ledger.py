"""Energies of channel, operator and follower: whose, and how they add up."""

import numpy as np
import pytest

from sinuous.teleop.analysis.passivity import power_terms
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.ledger import Ledger
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.waves import ModifiedWaves, Scheme, StandardWaves

from .rigs import C1, C2, DT, PLANE, rig, run, to_and_hold, wave_about

ROUNDING = 1e-12  # [J], of sums of thousands of parts of a joule
CONTACT = ImpedanceOperator(to_and_hold(np.array([0.09, -0.09])))
WANDER = ImpedanceOperator(wave_about(0.1))  # beyond the boundary and back


@pytest.mark.parametrize("scheme", [C1, C2, StandardWaves()])
@pytest.mark.parametrize("operator", [CONTACT, WANDER])
@pytest.mark.parametrize("delay", [0.0, 0.2, 0.7])
def test_the_channel_never_gives_more_than_it_took(
    scheme: Scheme, operator: ImpedanceOperator, delay: float
) -> None:
    r = run(rig(operator, scheme=scheme, delay=delay), 6.0)
    assert r.ledger.least.channel >= -ROUNDING
    assert r.ledger.energies.channel > 1e-6


def test_the_channel_s_energy_is_the_sum_of_the_identity_s_terms() -> None:
    teleop, energy = rig(WANDER), 0.0
    state, tip, ledger = teleop.init(PLANE.place(np.zeros(2))), PLANE.place(np.zeros(2)), Ledger(DT)
    for _ in range(3000):
        state, signals = teleop.step(state, tip)
        tip = tip + 0.02 * (signals.follower.target_w - tip)
        ledger.observe(signals)
        leader, follower = signals.leader, signals.follower
        terms = power_terms(
            C2,
            v=leader.V,
            at_leader=leader.wave,
            force=follower.F_s,
            at_follower=follower.wave,
        )
        energy += DT * float(np.sum(terms.total))
    assert ledger.energies.channel == pytest.approx(energy, abs=ROUNDING)


def test_all_energy_is_somewhere() -> None:
    """Hand, device, channel and follower: nothing is made or lost between the parts.

    On the wave side the device's mass is M / scale, for its speed is scale v and forces are not
    scaled. Euler's step loses M |dv|^2 / 2.
    """
    r, mass = run(rig(CONTACT), 8.0), LeaderDevice().mass / 2.25
    V = np.concatenate([np.zeros((1, 2)), r.V])
    kinetic = 0.5 * mass * np.sum(V[-1] ** 2)
    integration = 0.5 * mass * np.sum(np.diff(V, axis=0) ** 2)
    e = r.ledger.energies
    total = e.operator + kinetic + integration + e.channel + e.follower
    assert total == pytest.approx(0.0, abs=ROUNDING)
    moved = np.diff(r.X, axis=0)
    assert -e.operator == pytest.approx(np.sum(r.F_h[:-1] * moved), abs=1e-9)


def test_the_follower_with_its_wall_takes_in_what_springs_and_lag_hold() -> None:
    r = run(rig(CONTACT), 10.0)
    assert r.ledger.least.follower >= -ROUNDING
    assert r.ledger.energies.follower > 0.01


def test_an_active_channel_is_seen() -> None:
    """K far below 1/2, driven as in its worst case, by a hand that pushes at 6.74 rad/s."""
    with pytest.warns(UserWarning, match="below 1/2"):
        scheme = ModifiedWaves(gain=0.05, allow_active=True)
    goal = ImpedanceOperator(lambda t: 0.08 * np.array([np.sin(6.74 * t), 0.0]))
    assert run(rig(goal, scheme=scheme), 10.0).ledger.least.channel < -1e-3
    assert run(rig(goal, scheme=C2), 10.0).ledger.least.channel >= -ROUNDING


def test_history_and_least() -> None:
    r = run(rig(WANDER), 2.0)
    history = r.ledger.history
    assert history.shape == (2000, 3)
    np.testing.assert_allclose(r.ledger.times, DT * np.arange(1, 2001), atol=1e-9)
    np.testing.assert_array_equal(history[-1], r.ledger.energies)
    np.testing.assert_array_equal(np.minimum(np.min(history, axis=0), 0.0), r.ledger.least)
    empty = Ledger(DT)
    assert empty.least == (0.0, 0.0, 0.0)
    assert empty.history.shape == (0, 3)
