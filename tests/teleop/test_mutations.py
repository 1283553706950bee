"""Every single term of observer, controller and compensation is needed: without it a test fails.

`mutants` removes terms and flips their signs, one by one; what is tried on each of them are tests
of this folder, with signals that are known beforehand.
"""

import sys
from collections.abc import Callable
from functools import cache, partial
from typing import Any

import numpy as np
import pytest

from sinuous.teleop import drift, energy_kernels, kernels, passivity, receivers
from sinuous.teleop.analysis.passivity import power_terms
from sinuous.teleop.analysis.ports import drive_over
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.passivity import PassivityControl, WaveEnergy
from sinuous.teleop.ports import Port
from sinuous.teleop.position_force import PositionForce
from sinuous.teleop.receivers import Hold, Receiver, ZeroFill

from . import test_drift, test_passivity, test_position_force
from .adversary import SCHEMES, Signals, conspired, ports, robbed
from .mutants import Mutant, mutants
from .rigs import C2

ROUNDING = 1e-12
ROOM = "sinuous.teleop", "tests.teleop"  # whoever has imported a function by its name

PARTS: dict[str, tuple[tuple[Any, str], ...]] = {
    "observer": (
        (receivers, "most"),
        (passivity, "spare"),
        (passivity, "work_in"),
        (passivity, "work_out"),
        (passivity, "sent_after"),
        (passivity, "used_after"),
        (energy_kernels, "wave_energy"),
    ),
    "controller": (
        (energy_kernels, "limit_wave"),
        (energy_kernels, "limit_motion"),
        (energy_kernels, "left"),
        (energy_kernels, "kept"),
        (PassivityControl, "surplus"),
        (Port, "spend"),
        (Port, "init"),
        (Port, "asleep"),
    ),
    "compensation": (
        (DriftCorrection, "step"),
        (drift, "filled"),
        (drift, "cost"),
        (kernels, "modified_loss"),
    ),
}
FLOWS: tuple[tuple[type, str], ...] = (
    (WaveEnergy, "leader_flow"),
    (WaveEnergy, "follower_flow"),
    (PositionForce, "leader_flow"),
    (PositionForce, "follower_flow"),
)
"""They have no sums: what is removed of them is what is sent, or what is used."""


def without(owner: type, attribute: str, field: str) -> Mutant:
    """A flow that forgets one of its two."""
    original = getattr(owner, attribute)

    def forgetful(*args: Any) -> passivity.Flow:
        return original(*args)._replace(**{field: 0.0})

    return Mutant(f"{owner.__name__}.{attribute}: no {field}", owner, attribute, forgetful)


ALL = [
    *(
        pytest.param(mutant, id=f"{part} {mutant.name}")
        for part, functions in PARTS.items()
        for function in functions
        for mutant in mutants(*function)
    ),
    *(
        pytest.param(mutant, id=f"observer {mutant.name}")
        for flow in FLOWS
        for mutant in (without(*flow, field) for field in ("sent", "used"))
    ),
]


# --- what is tried on each of them ------------------------------------------------------------


def limits_of_energy() -> None:
    """Nothing, some and enough, also where rounding has used more than there was."""
    assert passivity.spare(2.0, 0.5) == 1.5
    assert passivity.spare(1.0, 2.0) == 0.0
    assert receivers.most(2.0, 1.0) == receivers.most(1.0, 2.0) == 2.0
    wave = np.array([3.0, -4.0])
    for heard, used, scale in (
        (2.0, 1.0, 0.2),
        (60.0, 0.0, 1.0),
        (27.0, 2.0, 1.0),
        (1.0, 1.5, 0.0),
    ):
        got = passivity.limited_wave(1.0, wave, heard, used)
        np.testing.assert_allclose(got, scale * wave, atol=ROUNDING)
    assert passivity.wave_energy(2.0, wave) == 50.0


def losses() -> None:
    """What the follower's port dissipates is the identity's term."""
    F, wave = np.array([1.0, -0.5]), np.array([0.4, 3.0])
    terms = power_terms(C2, v=wave, at_leader=wave, force=F, at_follower=wave)
    assert C2.follower_loss(F, wave) == pytest.approx(float(np.sum(terms.follower)))


def clean(name: str) -> None:
    """Waves are not touched on a clean link."""
    v, F_s = test_passivity.signals(300)
    link = ConstantDelay(delay=0.02)
    free, kept = (
        drive_over(*ports(SCHEMES[name], ZeroFill(), control), link, link, v, F_s)
        for control in (None, PassivityControl())
    )
    for a, b in zip(free, kept, strict=True):
        np.testing.assert_array_equal(a, b)


@cache
def _worst(name: str, link: str, receiver: Receiver) -> Signals:
    bad = test_passivity.BAD[link]
    return conspired(ports(SCHEMES[name], receiver, None), bad, bad, ticks=200)


def worst(name: str, link: str, receiver: Receiver) -> None:
    """What is worst without control takes nothing out with it."""
    pair = ports(SCHEMES[name], receiver, PassivityControl())
    found = test_passivity.least(pair, test_passivity.BAD[link], _worst(name, link, receiver))
    assert found >= -ROUNDING


def robbers(name: str, link: ImpairedLink) -> None:
    pair = ports(SCHEMES[name], Hold(), PassivityControl())
    assert np.min(robbed(pair, link, link, seed=1, axes=2)) >= -ROUNDING


def drawn(test: Any, seed: int, *, small: float = 1e-3, **others: Any) -> None:
    """A property test with vectors and amounts of energy drawn here."""
    inner, rng = test.hypothesis.inner_test, np.random.default_rng(seed)
    names = inner.__code__.co_varnames[: inner.__code__.co_argcount]
    for spare in (0.0, small, 10.0 * small):
        made = {name: 3.0 * rng.normal(size=2) for name in names}
        inner(**made | {"spare": spare} | others)


def correction(test: Any) -> None:
    for seed, capacity in ((0, 1.0), (1, 1e-4), (2, 0.0)):
        for size in (1e-3, 1.0, 1e3):
            test.hypothesis.inner_test(seed=seed, capacity=capacity, size=size)


def rules(name: str, capacity: float) -> None:
    """Both rules at each end, and what is kept at most."""
    bad = test_passivity.BAD["bursts"]
    test_passivity.test_each_port_keeps_to_both_of_its_rules.hypothesis.inner_test(  # type: ignore[attr-defined]
        scheme=SCHEMES[name],
        receiver=Hold(),
        capacity=capacity,
        forward=bad,
        backward=bad,
        seed=3,
    )


LAWS = (
    test_position_force.test_the_follower_s_velocity_is_the_nearest_that_takes_no_more,
    test_position_force.test_the_leader_s_force_keeps_to_what_is_left_with_any_velocity,
)
OTHER = {"scale": np.array([1.0, 2.0]), "damping": 20.0}
DEVICE = partial(
    drawn, test_position_force.test_the_device_moves_by_the_law_within_its_own_tick, **OTHER
)

CHECKS: tuple[Callable[[], None], ...] = (
    limits_of_energy,
    losses,
    *(partial(drawn, law, seed) for law in LAWS for seed in range(5)),
    *(partial(DEVICE, seed, small=small) for seed in range(5) for small in (1e-3, 1e-2)),
    test_position_force.test_with_nothing_left_a_hand_can_press_and_is_not_pushed_back,
    test_position_force.test_a_force_that_pushes_the_hand_back_is_felt_when_its_energy_has_come,
    partial(correction, test_drift.test_no_more_is_spent_than_was_dissipated),
    partial(correction, test_drift.test_energy_that_was_not_used_pays_for_what_the_tank_cannot),
    test_drift.test_what_costs_nothing_is_not_shortened,
    *(partial(clean, name) for name in ("C2", "standard")),
    test_passivity.test_a_held_wave_lives_on_what_loss_has_left_and_no_longer,
    test_passivity.test_what_is_above_the_capacity_goes_back_to_the_leader,
    *(partial(rules, name, capacity) for name in SCHEMES for capacity in (1e-3, np.inf)),
    *(partial(worst, name, "outages", Hold()) for name in SCHEMES),
    *(partial(worst, name, "copies", ZeroFill()) for name in SCHEMES),
    *(partial(robbers, name, test_passivity.BAD["bursts"]) for name in SCHEMES),
    test_drift.test_standard_waves_are_corrected_with_what_loss_has_left_over,
    partial(
        test_position_force.test_control_costs_little_where_the_channel_is_passive_by_itself,
        "relaxed",
        0.0,
    ),
    partial(test_position_force.test_a_loan_is_given_once, 1e-3),
    test_passivity.test_a_pause_neither_takes_a_loan_nor_gives_it_again,
)


def failed() -> bool:
    """Whether one of them fails."""
    for check in CHECKS:
        try:
            check()
        except Exception:
            return True
    return False


def test_they_all_pass_as_it_is() -> None:
    for check in CHECKS:
        check()


@pytest.mark.parametrize("mutant", ALL)
def test_without_a_term_one_of_them_fails(mutant: Mutant, monkeypatch: pytest.MonkeyPatch) -> None:
    original = getattr(mutant.owner, mutant.attribute)
    monkeypatch.setattr(mutant.owner, mutant.attribute, mutant.function)
    for name, module in list(sys.modules.items()):
        if name.startswith(ROOM) and getattr(module, mutant.attribute, None) is original:
            monkeypatch.setattr(module, mutant.attribute, mutant.function)
    assert failed(), mutant.name
