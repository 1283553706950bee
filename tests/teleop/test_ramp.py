"""Starting, stopping, pausing and going on: no kick, no energy, and nothing to catch up with."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.bilateral import Bilateral, BilateralState, Signals
from sinuous.teleop.delays import Steady, UniformJitter
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.ledger import Ledger
from sinuous.teleop.link import ConstantDelay, LinkModel
from sinuous.teleop.losses import RandomLoss
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.ramp import Ramp
from sinuous.teleop.receivers import Hold

from .adversary import SCHEMES
from .rigs import DT, LAG, PLANE, WALLED, to_and_hold

ROUNDING = 1e-12
RAMP = Ramp(0.4)
DELAY = 0.1
CLEAN = ConstantDelay(delay=DELAY)
BAD = ImpairedLink(effects=(Steady(DELAY), UniformJitter(0.05), RandomLoss(0.2)), seed=9)
PRESS = ImpedanceOperator(to_and_hold(np.array([0.1, -0.03]), duration=0.8))  # on the wall
PAUSE, RESUME, END = 2.0, 3.5, 6.0  # [s]

Act = Callable[[Bilateral[Any], BilateralState[Any]], BilateralState[Any]]


def pause(teleop: Bilateral[Any], state: BilateralState[Any]) -> BilateralState[Any]:
    return teleop.pause(state)


def resume(teleop: Bilateral[Any], state: BilateralState[Any]) -> BilateralState[Any]:
    return teleop.resume(state)


class Course(NamedTuple):
    """Signals of every tick (K, A), the ledger, and by how much each end keeps to its rule (K, 2).

    That is (2) of `passivity`: energy taken in, less what was sent, and what was used [J].
    """

    time: Array
    x: Array
    V: Array
    F_m: Array
    X: Array
    X_sd: Array
    V_sd: Array
    X_s: Array
    F_s: Array
    target: Array
    ledger: Ledger
    rules: Array

    def during(self, begin: float, end: float) -> slice:
        return slice(round(begin / DT), round(end / DT))


def course(
    name: str,
    link: LinkModel,
    acts: dict[float, Act],
    *,
    running: bool = True,
    hand: Any = PRESS,
    correction: DriftCorrection | None = None,
    held: Callable[[float], Array | None] = lambda _: None,
) -> Course:
    """A run with a lagging follower, who may be held somewhere, and things done at some times."""
    teleop: Bilateral[Any] = Bilateral.connect(
        operator=hand,
        mapping=PLANE,
        force=WALLED,
        scheme=SCHEMES[name],
        link=link,
        receiver=Hold(longest=0.2),
        control=PassivityControl(),
        correction=correction,
        ramp=RAMP,
    )
    tip, ledger, seen = PLANE.place(np.zeros(2)), Ledger(DT), list[Signals]()
    rules = list[tuple[float, float]]()
    state = teleop.init(tip, running=running)
    due = {round(time / DT): act for time, act in acts.items()}
    for k in range(round(END / DT)):
        if k in due:
            state = due[k](teleop, state)
        state, signals = teleop.step(state, tip)
        there = held(k * DT)
        tip = tip + DT / LAG * (signals.follower.target_w - tip) if there is None else there
        energies = ledger.observe(signals)
        seen.append(signals)
        m, f = state.leader.port, state.follower.port
        rules.append(
            (
                energies.channel + energies.follower - m.sent + m.used,
                -energies.follower - f.sent + f.used,
            )
        )
    a, b = [s.leader for s in seen], [s.follower for s in seen]
    return Course(
        np.array([s.time for s in seen]),
        *(np.array([getattr(s, name) for s in a]) for name in ("x", "V", "F_m", "X")),
        *(
            np.array([getattr(s, name) for s in b])
            for name in ("X_sd", "V_sd", "X_s", "F_s", "target_w")
        ),
        ledger,
        np.array(rules),
    )


@given(
    share=st.floats(0.0, 1.0), dt=st.floats(1e-4, 0.1), join=st.booleans(), time=st.floats(0.1, 2.0)
)
def test_a_ramp_moves_on_and_ends(share: float, dt: float, join: bool, time: float) -> None:
    ramp, rho = Ramp(time), share
    for _ in range(int(time / dt) + 2):
        after = ramp.step(rho, dt, join=join)
        assert 0.0 <= after <= 1.0
        assert abs(after - rho) <= dt / time * (1.0 + 1e-9)
        rho = after
    assert rho == (1.0 if join else 0.0)


def test_a_ramp_takes_time() -> None:
    with pytest.raises(ValueError, match="duration"):
        Ramp(0.0)


@pytest.mark.parametrize("link", [CLEAN, BAD])
@pytest.mark.parametrize("name", SCHEMES)
def test_pausing_and_going_on_makes_no_energy(name: str, link: LinkModel) -> None:
    """Also with a pause and a resumption within a ramp, and on a bad link."""
    acts = {PAUSE: pause, PAUSE + 0.3: resume, PAUSE + 0.7: pause, RESUME: resume}
    r = course(name, link, acts, correction=DriftCorrection())
    loan = SCHEMES[name].loan
    assert np.min(r.rules + [loan, 0.0]) >= -ROUNDING
    assert r.ledger.least.channel >= -loan - ROUNDING
    assert r.ledger.least.follower >= -1e-6  # of a force a tick old, against a lag


@pytest.mark.parametrize("name", SCHEMES)
def test_while_it_pauses_nothing_is_felt_and_the_desired_point_stands_still(name: str) -> None:
    r = course(name, CLEAN, {PAUSE: pause})
    assert np.linalg.norm(r.F_m[round(PAUSE / DT) - 1]) > 0.2  # it was pressing
    after = r.during(PAUSE + RAMP.duration + DT, END)
    np.testing.assert_array_equal(r.F_m[after], 0.0)
    far = r.during(PAUSE + DELAY + RAMP.duration + 2 * DT, END)
    np.testing.assert_array_equal(r.V_sd[far], 0.0)
    assert np.ptp(r.X_sd[far], axis=0).max() == 0.0
    assert np.ptp(r.X[after], axis=0).max() < 1e-12  # what the hand does now is not the follower's
    assert np.ptp(r.x[after], axis=0).max() > 0.001


@pytest.mark.parametrize("name", SCHEMES)
def test_force_and_speed_change_without_a_kick(name: str) -> None:
    """No change from tick to tick is larger than the ramp makes it, or motion without it."""
    r = course(name, CLEAN, {PAUSE: pause, RESUME: resume})
    plain = course(name, CLEAN, {})
    for signal, reference in ((r.F_m, plain.F_m), (r.V_sd, plain.V_sd), (r.target, plain.target)):
        change = np.max(np.linalg.norm(np.diff(signal[round(PAUSE / DT) - 10 :], axis=0), axis=1))
        usual = np.max(np.linalg.norm(np.diff(reference, axis=0), axis=1))
        ramped = DT / RAMP.duration * np.max(np.linalg.norm(reference, axis=1))
        if signal is r.target:
            ramped = DT * np.max(np.linalg.norm(plain.V_sd, axis=1))
        assert change <= 1.5 * max(usual, ramped)


@pytest.mark.parametrize("name", SCHEMES)
def test_nothing_that_happened_in_the_pause_is_caught_up_with(name: str) -> None:
    """The hand goes elsewhere and the follower is moved; then they go on from there."""

    def hand(t: float) -> Array:
        away = to_and_hold(np.array([-0.03, 0.02]), duration=0.5)(t - PAUSE - 0.6)
        return away + to_and_hold(np.array([0.0, 0.02]), duration=0.5)(t - RESUME - 1.0)

    def held(t: float) -> Array | None:
        return PLANE.place(np.array([0.01, 0.005])) if PAUSE + 0.6 < t < RESUME + DELAY else None

    r = course(
        name,
        CLEAN,
        {PAUSE: pause, RESUME: resume},
        hand=ImpedanceOperator(hand),
        correction=DriftCorrection(),
        held=held,
    )
    k = round(RESUME / DT)
    assert np.linalg.norm(r.x[k] - r.x[round(PAUSE / DT)]) > 0.03
    # The desired point begins where the follower is: there is no error to be felt.
    joined = round((RESUME + DELAY) / DT) + 2
    np.testing.assert_allclose(r.X_sd[joined], r.X_s[joined], atol=1e-4)
    calm = r.during(RESUME + DELAY, RESUME + 1.0)
    assert np.max(np.linalg.norm(r.F_m[calm], axis=1)) < 0.05
    assert np.max(np.linalg.norm(r.X_sd[calm] - r.X_sd[joined], axis=1)) < 1e-3
    # And from then on it follows.
    moved = r.X_sd[-1] - r.X_sd[joined]
    np.testing.assert_allclose(moved, r.X[-1] - r.X[joined], atol=2e-3)
    assert moved[1] > 0.03
    assert r.ledger.least.channel >= -ROUNDING


@pytest.mark.parametrize("name", SCHEMES)
def test_a_start_on_pause_begins_without_a_kick(name: str) -> None:
    """With the hand moving already."""
    swing = ImpedanceOperator(lambda t: 0.02 * np.array([np.sin(3.0 * t), np.cos(3.0 * t)]))
    r = course(name, CLEAN, {1.0: resume}, running=False, hand=swing)
    np.testing.assert_array_equal(r.V_sd[: round((1.0 + DELAY) / DT)], 0.0)
    assert np.max(np.abs(r.V_sd)) > 0.05
    assert np.max(np.linalg.norm(np.diff(r.V_sd, axis=0), axis=1)) < 0.002
    assert r.ledger.least.channel >= -ROUNDING


def test_either_end_can_have_both_pause() -> None:
    def stop(teleop: Bilateral[Any], state: BilateralState[Any]) -> BilateralState[Any]:
        return state._replace(follower=teleop.follower.pause(state.follower))

    def go_on(teleop: Bilateral[Any], state: BilateralState[Any]) -> BilateralState[Any]:
        return state._replace(follower=teleop.follower.resume(state.follower))

    r = course("C2", CLEAN, {PAUSE: stop, RESUME: go_on})
    np.testing.assert_array_equal(r.V_sd[r.during(PAUSE + RAMP.duration + DT, RESUME)], 0.0)
    np.testing.assert_array_equal(
        r.F_m[r.during(PAUSE + DELAY + RAMP.duration + 2 * DT, RESUME)], 0.0
    )
    assert np.max(np.abs(r.F_m[r.during(RESUME + 1.0, END)])) > 0.0


def test_waves_of_before_are_not_used_after() -> None:
    """Standard waves lose nothing: those under way would still be there a second later."""
    swing = ImpedanceOperator(
        lambda t: np.array([0.03 * np.sin(8.0 * t) * (t < PAUSE), 0.0]), stiffness=200.0
    )
    r = course("standard", CLEAN, {PAUSE: pause, RESUME: resume}, hand=swing)
    after = r.during(RESUME + RAMP.duration + 2 * DELAY, END)
    assert np.max(np.abs(r.F_m[r.during(1.0, PAUSE)])) > 0.5
    assert np.max(np.abs(r.F_m[after])) < 0.01
