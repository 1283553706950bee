"""Passivity control: no link and no signal takes more out of a channel than was put in."""

from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.teleop.analysis.ports import channel_energy, drive_over
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.delays import Steady, UniformJitter, Varying
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.impaired import ImpairedLink
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import ConstantDelay, LinkModel
from sinuous.teleop.losses import BurstLoss, Duplication, Outages, RandomLoss
from sinuous.teleop.operators import ImpedanceOperator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.ports import LeaderPort
from sinuous.teleop.position_force import PositionForce
from sinuous.teleop.receivers import Hold, Interpolated, Receiver, ZeroFill
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

from .adversary import SCHEMES, Ports, Signals, conspired, ports, robbed
from .bad_links import links
from .rigs import DT, PLANE, WALLED, run, wave_about

# Of sums of energies of up to 1 J in thousands of ticks.
ROUNDING = 1e-12
CONTROL = PassivityControl()
WAVES = [name for name in SCHEMES if name != "position-force"]

RECEIVERS = st.one_of(
    st.just(ZeroFill()),
    st.builds(Hold, longest=st.sampled_from([0.0, 0.02, 0.2, np.inf])),
    st.builds(Interpolated, delay=st.floats(0.0, 0.1), longest=st.sampled_from([0.02, np.inf])),
)
WAVES_OF_ANY_KIND = st.one_of(
    st.builds(StandardWaves, impedance=st.floats(0.5, 50.0)),
    st.builds(
        ModifiedWaves,
        gain=st.floats(0.5, 2.0),
        impedance=st.floats(0.5, 50.0),
        cutoff=st.one_of(st.just(np.inf), st.floats(1.0, 1000.0)),
    ),
)
ALL_SCHEMES = st.one_of(
    WAVES_OF_ANY_KIND, st.builds(PositionForce, local_damping=st.floats(0.0, 20.0))
)
LIMITS = st.one_of(
    st.none(), st.builds(Limits, size=st.floats(0.0, 2.0), slew=st.floats(0.0, 100.0))
)
CAPACITIES = st.sampled_from([0.0, 1e-3, 0.05, np.inf])

OUT = Outages(((0.05, 0.1), (0.15, 0.2)))
BAD: dict[str, ImpairedLink] = {
    "ramp": ImpairedLink(effects=(Varying(((0.05, 0.01), (0.15, 0.1))),)),
    "step": ImpairedLink(effects=(Varying(((0.05, 0.01), (0.05, 0.05))),)),
    "jitter": ImpairedLink(effects=(Steady(0.03), UniformJitter(0.03))),
    "bursts": ImpairedLink(effects=(Steady(0.01), BurstLoss.of(0.3, length=8.0)), seed=3),
    "outages": ImpairedLink(effects=(Steady(0.01), OUT)),
    "copies": ImpairedLink(effects=(Steady(0.01), *3 * (Duplication(share=1.0, after=0.05),), OUT)),
}
"""What makes energy where waves are held, or, of copies, used whenever they come."""


@settings(max_examples=150)
@given(
    scheme=ALL_SCHEMES,
    receiver=RECEIVERS,
    limits=LIMITS,
    capacity=CAPACITIES,
    forward=links(),
    backward=links(),
    seed=st.integers(0, 2**32 - 1),
    axes=st.integers(1, 3),
    colour=st.sampled_from([0.0, 0.9, 0.99]),
    force=st.floats(0.01, 100.0),
)
def test_no_signal_on_no_link_takes_energy_out(
    scheme: Any, receiver: Receiver, limits: Limits | None, capacity: float, forward: LinkModel,
    backward: LinkModel, seed: int, axes: int, colour: float, force: float,
) -> None:  # fmt: skip
    rng = np.random.default_rng(seed)
    signals = rng.normal(size=(300, 2 * axes))
    for k in range(1, len(signals)):
        signals[k] += colour * signals[k - 1]
    v, F_s = 0.3 * signals[:, :axes], force * signals[:, axes:]
    pair = ports(scheme, receiver, PassivityControl(capacity=capacity), limits)
    energy = channel_energy(drive_over(*pair, forward, backward, v, F_s), v, F_s, DT)
    assert np.min(energy) >= -scheme.loan - ROUNDING * max(np.max(np.abs(energy)), 1.0)


@settings(max_examples=100)
@given(
    scheme=ALL_SCHEMES,
    receiver=RECEIVERS,
    limits=LIMITS,
    capacity=CAPACITIES,
    forward=links(),
    backward=links(),
    seed=st.integers(0, 2**32 - 1),
)
def test_nor_do_robbers(
    scheme: Any, receiver: Receiver, limits: Limits | None, capacity: float, forward: LinkModel,
    backward: LinkModel, seed: int,
) -> None:  # fmt: skip
    pair = ports(scheme, receiver, PassivityControl(capacity=capacity), limits)
    energy = robbed(pair, forward, backward, seed=seed, axes=2)
    assert np.min(energy) >= -scheme.loan - ROUNDING * max(np.max(np.abs(energy)), 1.0)


def least(pair: Ports, link: LinkModel, against: Signals) -> float:
    """The least energy that a channel has had [J]."""
    v, F_s = against.v, against.F_s
    return float(np.min(channel_energy(drive_over(*pair, link, link, v, F_s), v, F_s, DT)))


@pytest.mark.parametrize("link", BAD)
@pytest.mark.parametrize("name", SCHEMES)
def test_what_is_worst_without_control_takes_nothing_with_it(name: str, link: str) -> None:
    """Hand and follower know what the links will do; an effort of 1 J is all that they make."""
    receiver = ZeroFill() if link == "copies" else Hold()
    naive = ports(SCHEMES[name], receiver, None)
    worst = conspired(naive, BAD[link], BAD[link], ticks=200)
    assert worst.energy < -0.1
    assert least(naive, BAD[link], worst) <= 0.999 * worst.energy
    for capacity in (0.0, CONTROL.capacity, np.inf):
        kept = ports(SCHEMES[name], receiver, PassivityControl(capacity=capacity))
        assert least(kept, BAD[link], worst) >= -SCHEMES[name].loan - ROUNDING


@pytest.mark.parametrize("name", SCHEMES)
@pytest.mark.parametrize("link", BAD)
def test_waves_of_zero_for_what_does_not_come_make_none_but_of_copies(name: str, link: str) -> None:
    worst = conspired(ports(SCHEMES[name], ZeroFill(), None), BAD[link], BAD[link], ticks=200)
    makes = link == "copies" or name == "position-force"
    assert (worst.energy < -ROUNDING) == makes


def signals(ticks: int = 2500, axes: int = 2) -> tuple[Any, Any]:
    rng = np.random.default_rng(8)
    return 0.2 * rng.normal(size=(ticks, axes)), rng.normal(size=(ticks, axes))


@pytest.mark.parametrize("name", WAVES)
@pytest.mark.parametrize("delay", [0.0, 0.2])
@pytest.mark.parametrize("receiver", [ZeroFill(), Hold(), Interpolated(delay=0.3)])
def test_a_clean_link_is_not_touched_to_the_last_digit(
    name: str, delay: float, receiver: Receiver
) -> None:
    """However many joules have gone by: every wave finds exactly its own energy."""
    v, F_s = signals()
    link = ConstantDelay(delay=delay)
    free, kept = (
        drive_over(*ports(SCHEMES[name], receiver, control), link, link, v, F_s)
        for control in (None, CONTROL)
    )
    for a, b in zip(free, kept, strict=True):
        np.testing.assert_array_equal(a, b)


@pytest.mark.parametrize("name", WAVES)
def test_interpolated_makes_one_delay_of_many(name: str) -> None:
    """A link that jitters below the receiver's delay is one of constant delay, with control too."""
    v, F_s = signals()
    jitter = ImpairedLink(effects=(Steady(0.1), UniformJitter(0.05)), seed=2)
    steady = ConstantDelay(delay=0.15)
    played = drive_over(
        *ports(SCHEMES[name], Interpolated(delay=0.15), CONTROL), jitter, jitter, v, F_s
    )
    plain = drive_over(*ports(SCHEMES[name], ZeroFill(), None), steady, steady, v, F_s)
    for a, b in zip(played, plain, strict=True):
        np.testing.assert_array_equal(a, b)


@settings(max_examples=60)
@given(
    scheme=ALL_SCHEMES,
    receiver=RECEIVERS,
    capacity=CAPACITIES,
    forward=links(),
    backward=links(),
    seed=st.integers(0, 2**32 - 1),
)
def test_each_port_keeps_to_both_of_its_rules(
    scheme: Any, receiver: Receiver, capacity: float, forward: LinkModel, backward: LinkModel,
    seed: int,
) -> None:  # fmt: skip
    """(1) and (2) of the theory, and that what was sent only grows, at each end by itself."""
    leader, follower = ports(scheme, receiver, PassivityControl(capacity=capacity))
    rng, nowhere = np.random.default_rng(seed), np.zeros(2)
    ahead, back = forward.open(0), backward.open(1)
    m, s, to_leader, to_follower = leader.init(2), follower.init(2), (), ()
    taken_m = taken_s = sent_m = sent_s = 0.0
    for k in range(250):
        v, F_s = 0.2 * rng.normal(size=2), rng.normal(size=2)
        inbox = leader.listen(m, to_leader)
        wave, left = leader.use(m, inbox)
        if left < np.inf:  # a force that yields, to a source of motion
            given = -DT * float(wave @ v)
            if given > 0.0:
                wave = wave * (max(1.0 - given / (4.0 * left), 0.0) if left > 0.0 else 0.0)
        m, F_m, packet_m = leader.answer(m, inbox, wave, v, nowhere, True)
        s, v_sd, packet_s = follower.answer(s, follower.listen(s, to_follower), F_s, nowhere, True)
        taken_m += DT * float(F_m @ v)
        taken_s -= DT * float(F_s @ v_sd)
        to_follower, to_leader = ahead.step(packet_m), back.step(packet_s)
        size = max(m.sent, s.sent, 1.0)
        for memory, other, taken in ((m, s, taken_m + scheme.loan), (s, m, taken_s)):
            assert memory.used <= memory.inbox.energy + ROUNDING * size
            assert memory.inbox.energy <= other.sent
            assert taken >= memory.sent - memory.used - ROUNDING * size
            assert memory.inbox.energy - memory.used <= capacity + ROUNDING * size
        assert m.sent >= sent_m
        assert s.sent >= sent_s
        sent_m, sent_s = m.sent, s.sent
        assert packet_m.number == packet_s.number == k
        assert (packet_m.energy, packet_s.energy) == (m.sent, s.sent)


def test_a_held_wave_lives_on_what_loss_has_left_and_no_longer() -> None:
    """Half of a motion is lost; then, in an outage, the last wave is held for as long."""
    scheme, ticks = ModifiedWaves.c1(), 400
    link = ImpairedLink(effects=(Outages(((0.05, 0.15), (0.25, 1.0))),))
    v, F_s = np.full((ticks, 1), 0.1), np.zeros((ticks, 1))
    v[400:] = 0.0
    pair = ports(scheme, Hold(), PassivityControl(capacity=np.inf))
    got = drive_over(*pair, link, ConstantDelay(delay=0.0), v, F_s)
    used = got.at_follower[:, 0]
    # From 51 to 150 nothing is left: each wave has been used when it came.
    assert np.all(used[1:51] == used[1])
    np.testing.assert_allclose(used[52:151], 0.0, atol=1e-6)
    # The 100 that were lost pay for 100 more after 250.
    assert np.all(used[152:350] == used[1])
    np.testing.assert_allclose(used[352:], 0.0, atol=1e-6)


def test_what_is_above_the_capacity_goes_back_to_the_leader() -> None:
    scheme, ticks, capacity = PositionForce(), 300, 1e-3
    leader, follower = ports(scheme, Hold(), PassivityControl(capacity=capacity))
    m, s, to_leader, to_follower = leader.init(1), follower.init(1), (), ()
    v, nothing = np.full(1, 0.2), np.zeros(1)
    for _ in range(ticks):
        inbox = leader.listen(m, to_leader)
        wave, _ = leader.use(m, inbox)
        m, _, packet_m = leader.answer(m, inbox, wave, v, nothing, True)
        s, _, packet_s = follower.answer(s, follower.listen(s, to_follower), nothing, nothing, True)
        to_follower, to_leader = (packet_m,), (packet_s,)
    damped = ticks * DT * scheme.local_damping * 0.2**2
    assert m.sent == pytest.approx(damped)
    heard = damped * (ticks - 1) / ticks
    assert s.sent == pytest.approx(heard - capacity)
    assert m.inbox.energy - m.used == pytest.approx(capacity)


def test_a_pause_neither_takes_a_loan_nor_gives_it_again() -> None:
    """And what is left of before is not used after."""
    loan, nowhere = 1e-3, np.zeros(1)
    port, _ = ports(PositionForce(loan=loan), Hold(), CONTROL)
    fresh = port.init(1)
    for used, heard, left in ((-loan, 0.0, loan), (0.0, 0.0, 0.0), (0.0, 1.0, loan)):
        inbox = fresh.inbox._replace(energy=heard)
        memory, _ = port.asleep(fresh._replace(used=used), inbox, nowhere, False)
        assert port.spare(memory) == pytest.approx(left)


# --- both ends, with hands, walls, drift and limits -------------------------------------------

HANDS = {
    "relaxed": ImpedanceOperator(wave_about(), stiffness=20.0, damping=2.0),
    "stiff": ImpedanceOperator(wave_about(), stiffness=600.0, damping=20.0),
}
LATE: dict[str, ImpairedLink] = {
    "jitter and bursts": ImpairedLink(
        effects=(Steady(0.2), UniformJitter(0.1), BurstLoss.of(0.3, length=20.0)), seed=4
    ),
    "outage of 2 s": ImpairedLink(
        effects=(Steady(0.05), RandomLoss(0.1), Outages(((1.5, 3.5),))), seed=5
    ),
    "steps of the delay": ImpairedLink(
        effects=(Varying(((1.5, 0.05), (1.5, 0.4), (3.0, 0.4), (3.0, 0.05))), UniformJitter(0.02))
    ),
}


def connected(name: str, link: LinkModel, hand: str, **parts: Any) -> Bilateral[Any]:
    return Bilateral.connect(
        operator=HANDS[hand], mapping=PLANE, force=WALLED, scheme=SCHEMES[name], link=link, **parts
    )


@pytest.mark.parametrize(
    ("link", "hand"),
    [
        ("jitter and bursts", "relaxed"),
        ("outage of 2 s", "stiff"),
        ("steps of the delay", "relaxed"),
    ],
)
@pytest.mark.parametrize("name", SCHEMES)
def test_with_hands_walls_and_correction_the_ledger_stays_above_its_floor(
    name: str, link: str, hand: str
) -> None:
    r = run(
        connected(
            name, LATE[link], hand,
            receiver=Hold(longest=0.2), control=CONTROL, correction=DriftCorrection(),
            felt=Limits(size=1.0, slew=20.0), speed=Limits(size=0.5, slew=10.0),
        ),
        5.0,
    )  # fmt: skip
    assert r.ledger.least.channel >= -SCHEMES[name].loan - ROUNDING
    assert r.ledger.energies.channel > 1e-3
    assert np.max(np.abs(r.X_sd)) < 0.25
    assert np.max(np.abs(r.X_sd - r.X)) > 1e-3  # something has happened


@pytest.mark.parametrize("name", WAVES)
def test_transparency_costs_nothing_on_a_clean_link(name: str) -> None:
    free, kept = (
        run(connected(name, ConstantDelay(delay=0.2), "stiff", control=control), 3.0)
        for control in (None, CONTROL)
    )
    np.testing.assert_array_equal(free.F_m, kept.F_m)
    np.testing.assert_array_equal(free.X_sd, kept.X_sd)


def test_control_is_refused_where_it_proves_nothing() -> None:
    with pytest.warns(UserWarning, match="below 1/2"):
        active = ModifiedWaves(gain=0.4, allow_active=True)
    with pytest.raises(ValueError, match="no energy by themselves"):
        LeaderPort(scheme=active, control=CONTROL)
    both = connected("C2", ConstantDelay(delay=0.1), "stiff", control=CONTROL)
    alone = connected("C2", ConstantDelay(delay=0.1), "stiff")
    with pytest.raises(ValueError, match="takes both ends"):
        Bilateral(
            leader=both.leader,
            follower=alone.follower,
            forward=both.forward,
            backward=both.backward,
        )


@pytest.mark.parametrize("capacity", [-1.0, np.nan])
def test_numbers_that_make_no_sense(capacity: float) -> None:
    with pytest.raises(ValueError, match="capacity"):
        PassivityControl(capacity=capacity)
