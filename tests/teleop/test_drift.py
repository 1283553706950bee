"""Bringing the desired point back without making energy."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.teleop.bilateral import Bilateral, BilateralState
from sinuous.teleop.delays import Steady, UniformJitter
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.losses import BurstLoss
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

from .adversary import SCHEMES
from .rigs import C1, C2, DT, PLANE, WALLED, Run, rig, run, to_and_hold, wave_about

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
        return state._replace(to_follower=()) if lost else state

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
        tank, _, v_c = correction.step(tank, lost, force, away, DT)
        dissipated += lost * DT
        spent += float(force @ v_c) * DT
        assert 0.0 <= tank <= capacity
        assert spent <= dissipated * (1.0 + ROUNDING)
        assert np.linalg.norm(v_c) <= correction.speed * (1.0 + ROUNDING)
        assert v_c @ away >= 0.0


@given(
    seed=st.integers(0, 2**32 - 1),
    capacity=st.sampled_from([0.0, 1e-4, 1.0]),
    size=st.floats(1e-6, 1e3),
)
def test_energy_that_was_not_used_pays_for_what_the_tank_cannot(
    seed: int, capacity: float, size: float
) -> None:
    rng, correction = np.random.default_rng(seed), DriftCorrection(capacity=capacity)
    tank, dissipated, bought = 0.0, 0.0, 0.0
    taken = 0.0
    for _ in range(50):
        spare, before = float(rng.exponential(1e-3)), tank
        lost, force = float(rng.exponential()), size * rng.normal(size=3)
        away = rng.normal(size=3)
        tank, spent, v_c = correction.step(tank, lost, force, away, DT, spare=spare)
        price = max(float(force @ v_c) * DT, 0.0)
        assert 0.0 <= spent <= spare * (1.0 + ROUNDING)
        # The tank pays first, and no more than the price.
        from_tank = min(price, before + lost * DT)
        assert spent == pytest.approx(price - from_tank, abs=1e-12 * max(price, 1.0))
        assert tank == pytest.approx(min(before + lost * DT - from_tank, capacity), abs=1e-12)
        dissipated, bought, taken = dissipated + lost * DT, bought + spent, taken + price
        assert taken <= (dissipated + bought) * (1.0 + ROUNDING)
        # What can be paid is not shortened, and nothing is lengthened.
        speed = min(correction.rate * float(np.linalg.norm(away)), correction.speed)
        assert np.linalg.norm(v_c) <= speed * (1.0 + ROUNDING)
        if price < (before + lost * DT + spare) * (1.0 - 1e-9):
            assert np.linalg.norm(v_c) == pytest.approx(speed)


def test_what_costs_nothing_is_not_shortened() -> None:
    correction, away = DriftCorrection(rate=2.0, speed=1.0), np.array([0.1, 0.0])
    for force in (np.zeros(2), np.array([-5.0, 3.0])):
        tank, _, v_c = correction.step(0.0, 0.0, force, away, DT)
        np.testing.assert_allclose(v_c, [0.2, 0.0])
        assert tank == 0.0


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


# --- with passivity control, on links that lose -----------------------------------------------

LOSS = 0.1
BURSTS = ImpairedLink(
    effects=(Steady(0.2), UniformJitter(0.05), BurstLoss.of(LOSS, length=30.0)), seed=7
)
REST = 8.0  # [s]: a correction of 1/s takes that to bring what motion left to a thousandth


def wander(until: float) -> ImpedanceOperator:
    """Moves about within 30 mm, and then rests."""

    def goal(t: float) -> Any:
        at = min(t, until)
        return 0.013 * min(t, 1.0) * np.array([np.sin(1.3 * at), np.sin(0.9 * at)])

    return ImpedanceOperator(goal)


@pytest.mark.parametrize(
    ("name", "duration"),
    [("C2", 60.0), ("position-force", 20.0), ("standard", 20.0), ("C1", 20.0)],
)
def test_after_a_minute_of_loss_the_offset_is_below_a_millimetre_at_rest(
    name: str, duration: float
) -> None:
    """And above a centimetre without, where zero takes the place of what is lost."""
    drifts = list[float]()
    for correction, seconds in ((DriftCorrection(), duration), (None, 20.0)):
        teleop = Bilateral.connect(
            operator=wander(seconds - REST),
            mapping=PLANE,
            force=WALLED,
            scheme=SCHEMES[name],
            link=BURSTS,
            control=PassivityControl(),
            correction=correction,
        )
        r = run(teleop, seconds)
        assert r.ledger.least.channel >= -ROUNDING
        drifts.append(offset(r))
    assert drifts[0] < 1e-3
    assert drifts[1] > 1e-2


def test_standard_waves_are_corrected_with_what_loss_has_left_over() -> None:
    """They dissipate nothing, so that without control only what is free is corrected."""
    drifts = dict[bool, float]()
    for controlled in (False, True):
        teleop = Bilateral.connect(
            operator=wander(6.0),
            mapping=PLANE,
            force=WALLED,
            scheme=StandardWaves(),
            link=BURSTS,
            control=PassivityControl() if controlled else None,
            correction=DriftCorrection(),
        )
        r = run(teleop, 12.0)
        assert r.ledger.least.channel >= -ROUNDING
        assert r.state.follower.tank == 0.0
        port, taken = r.state.follower.port, -r.ledger.energies.follower
        # (2) of the theory, an equality but for what was given back or not kept.
        assert not controlled or taken >= port.sent - port.used - ROUNDING
        drifts[controlled] = offset(r)
    assert drifts[True] < 1e-3
    assert drifts[False] > 3e-3
