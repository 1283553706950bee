"""Bringing the desired point back without making energy."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.teleop.bilateral import BilateralState
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.link import Packet
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

from .rigs import C1, C2, DT, Run, rig, run, to_and_hold, wave_about

ROUNDING = 1e-12  # [J]
CLAMPED = np.array([0.03, -0.02])  # [m]
THERE = 1e-3  # [m]: an offset of 30 mm decays at 3/s, and waits for energy now and then
HOLD = to_and_hold(np.array([0.05, 0.05]), duration=1.2)
QUICK = DriftCorrection(rate=3.0, speed=0.06)


def clamp(k: int, state: BilateralState[Any]) -> BilateralState[Any]:
    """Move the desired point away once, as clamping it does."""
    if k != 1500:
        return state
    follower = state.follower
    return state._replace(follower=follower._replace(X_sd=follower.X_sd + CLAMPED))


def lossy(seconds: float) -> Any:
    """Lose 3 of 10 packets to the follower for some time."""
    rng = np.random.default_rng(4)

    def disturb(k: int, state: BilateralState[Any]) -> BilateralState[Any]:
        lost = k * DT < seconds and rng.random() < 0.3
        return state._replace(to_follower=None) if lost else state

    return disturb


def offset(r: Run) -> float:
    """Between desired point and leader at the end [m]."""
    return float(np.linalg.norm(r.X_sd[-1] - r.X[-1]))


@pytest.mark.parametrize("scheme", [C1, C2, ModifiedWaves(gain=0.5, cutoff=np.inf)])
def test_what_clamping_took_away_comes_back(scheme: ModifiedWaves) -> None:
    operator = ImpedanceOperator(HOLD)
    without = run(rig(operator, scheme=scheme), 6.0, disturb=clamp)
    assert offset(without) == pytest.approx(float(np.linalg.norm(CLAMPED)), rel=0.05)
    r = run(rig(operator, scheme=scheme, correction=QUICK), 6.0, disturb=clamp)
    assert offset(r) < THERE
    assert r.ledger.least.channel >= -ROUNDING


def test_what_loss_took_away_comes_back() -> None:
    def goal(t: float) -> Any:
        return wave_about()(min(t, 4.0))

    operator = ImpedanceOperator(goal)
    assert offset(run(rig(operator), 9.0, disturb=lossy(4.0))) > 0.01
    r = run(rig(operator, correction=QUICK), 9.0, disturb=lossy(4.0))
    assert offset(r) < THERE
    assert r.ledger.least.channel >= -ROUNDING


def test_without_a_tank_what_a_tick_dissipates_is_not_enough() -> None:
    """At rest nothing is dissipated, and the follower's lag makes every way cost something."""
    untanked, hand = DriftCorrection(capacity=0.0), ImpedanceOperator(HOLD)
    r = run(rig(hand, correction=untanked), 9.0, disturb=clamp)
    assert offset(r) > 3.0 * THERE
    assert r.ledger.least.channel >= -ROUNDING
    assert offset(run(rig(hand, correction=DriftCorrection()), 9.0, disturb=clamp)) < THERE


def test_pressing_on_a_wall_the_correction_spends_what_it_has_and_no_more() -> None:
    """The offset at rest (notes A12) is of the force: taking it away costs energy."""
    operator = ImpedanceOperator(to_and_hold(np.array([0.09, 0.0])))
    plain, r = run(rig(operator), 6.0), run(rig(operator, correction=QUICK), 6.0)
    assert r.ledger.least.channel >= -ROUNDING
    assert r.F_s[-1, 0] >= plain.F_s[-1, 0]
    spent = np.sum(r.F_s * (r.V_sd - plain.V_sd)) * DT
    assert np.isfinite(spent)
    assert np.max(np.abs(r.X_sd)) < 0.2


@given(
    seed=st.integers(0, 2**32 - 1),
    capacity=st.sampled_from([0.0, 1e-4, 1.0]),
    size=st.floats(1e-6, 1e3),
)
def test_no_more_is_spent_than_was_dissipated(seed: int, capacity: float, size: float) -> None:
    rng, correction = np.random.default_rng(seed), DriftCorrection(capacity=capacity)
    tank, dissipated, spent = 0.0, 0.0, 0.0
    for _ in range(50):
        lost, force = float(rng.exponential()), size * rng.normal(size=3)
        away = rng.normal(size=3)
        tank, v_c = correction.step(tank, lost, force, away, DT)
        dissipated += lost * DT
        spent += float(force @ v_c) * DT
        assert 0.0 <= tank <= capacity
        assert spent <= dissipated * (1.0 + ROUNDING)
        assert np.linalg.norm(v_c) <= correction.speed * (1.0 + ROUNDING)
        assert v_c @ away >= 0.0


def test_what_costs_nothing_is_not_shortened() -> None:
    correction, away = DriftCorrection(rate=2.0, speed=1.0), np.array([0.1, 0.0])
    for force in (np.zeros(2), np.array([-5.0, 3.0])):
        tank, v_c = correction.step(0.0, 0.0, force, away, DT)
        np.testing.assert_allclose(v_c, [0.2, 0.0])
        assert tank == 0.0


def test_a_position_that_is_not_finite_makes_the_follower_hold_still() -> None:
    end = rig(ImpedanceOperator(HOLD), correction=DriftCorrection()).follower
    state, home = end.init([0.0, 0.6, 0.0]), [0.0, 0.6, 0.0]
    bad = Packet(wave=np.ones(2), position=np.array([np.nan, 0.0]))
    after, signals, _ = end.step(state, home, bad)
    assert signals.fault == "holding still: what was received is not finite"
    np.testing.assert_array_equal(after.X_sd, state.X_sd)
    assert after.tank == state.tank


def test_standard_waves_dissipate_nothing_and_so_give_nothing() -> None:
    """Only what is free is corrected; the channel stays passive."""
    scheme = StandardWaves()
    r = run(rig(ImpedanceOperator(HOLD), scheme=scheme, correction=QUICK), 4.0, disturb=clamp)
    assert r.state.follower.tank == 0.0
    assert r.ledger.least.channel >= -ROUNDING


@pytest.mark.parametrize(
    ("field", "value"), [("rate", 0.0), ("speed", np.nan), ("capacity", -1.0)]
)  # fmt: skip
def test_numbers_that_make_no_sense(field: str, value: float) -> None:
    with pytest.raises(ValueError, match=field):
        DriftCorrection(**{field: value})
