"""What networks do to packets: delays, jitter, order, loss, copies and outages."""

from collections import Counter
from math import inf

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.delays import NormalJitter, Steady, UniformJitter, Varying
from sinuous.teleop.impaired import Effect, ImpairedLink
from sinuous.teleop.link import ConstantDelay, LinkModel, Packet
from sinuous.teleop.losses import BurstLoss, Duplication, Outages, RandomLoss, RandomOutages

from .bad_links import links
from .rigs import DT

NOTHING = np.zeros(1)
MANY = 20_000  # packets, of which shares are known to a percent
SHARE = 0.02  # more than four standard deviations of a share of so many independent packets


def packet(number: int) -> Packet:
    return Packet(wave=NOTHING, position=NOTHING, number=number, time=number * DT)


def deliver(model: LinkModel, ticks: int, way: int = 0) -> list[list[int]]:
    """Numbers of the packets that arrive in each tick; those of tick 0 are none."""
    link = model.open(way)
    return [[], *([p.number for p in link.step(packet(k))] for k in range(ticks))]


def journeys(arrived: list[list[int]]) -> list[tuple[int, int]]:
    """Number of every packet, and ticks that it took, in the order of arrival."""
    return [(number, tick - number) for tick, numbers in enumerate(arrived) for number in numbers]


def delays_of(*effects: Effect, ticks: int = MANY, seed: int = 0) -> Array:
    """Delays [s] of packets that arrive."""
    found = journeys(deliver(ImpairedLink(effects=effects, seed=seed), ticks))
    return DT * np.array([delay for _, delay in found])


@settings(max_examples=50)
@given(model=links(), way=st.integers(0, 1))
def test_whatever_arrives_was_sent_before_and_runs_can_be_repeated(
    model: ImpairedLink, way: int
) -> None:
    arrived = deliver(model, 400, way)
    assert arrived == deliver(model, 400, way)
    for number, delay in journeys(arrived):
        assert 0 <= number < 400
        assert delay >= 1
    if model.in_order:
        numbers = [number for number, _ in journeys(arrived)]
        assert numbers == sorted(numbers)


@settings(max_examples=25)
@given(delay=st.floats(0.0, 0.3))
def test_a_steady_delay_alone_is_a_constant_delay(delay: float) -> None:
    model = ImpairedLink(effects=(Steady(delay),))
    assert deliver(model, 700) == deliver(ConstantDelay(delay=delay), 700)


def test_each_way_and_each_seed_has_its_own_luck() -> None:
    model = ImpairedLink(effects=(RandomLoss(0.5),), seed=1)
    runs = [deliver(model, 100, 0), deliver(model, 100, 1)]
    runs.append(deliver(ImpairedLink(effects=model.effects, seed=2), 100))
    assert runs[0] != runs[1] != runs[2] != runs[0]


def test_an_effect_behind_leaves_the_luck_of_those_before_as_it_is() -> None:
    few = ImpairedLink(effects=(RandomLoss(0.3),), seed=5)
    more = ImpairedLink(effects=(RandomLoss(0.3), UniformJitter(0.002)), seed=5)
    survivors = {number for number, _ in journeys(deliver(few, 500))}
    assert {number for number, _ in journeys(deliver(more, 510)) if number < 490} == {
        number for number in survivors if number < 490
    }


def test_uniform_jitter_is_uniform_around_the_delay() -> None:
    delays = delays_of(Steady(0.2), UniformJitter(0.1))
    assert np.min(delays) >= 0.1 - 0.5 * DT
    assert np.max(delays) <= 0.3 + 0.5 * DT
    edges = np.linspace(0.1, 0.3, 6)
    counts, _ = np.histogram(delays, edges + 0.5e-9)
    np.testing.assert_allclose(counts / len(delays), 0.2, atol=SHARE)


def test_normal_jitter_is_normal_and_truncated() -> None:
    delays = delays_of(Steady(0.2), NormalJitter(0.02, cut=2.0))
    assert np.max(np.abs(delays - 0.2)) <= 0.04 + 0.5 * DT
    # Of a normal distribution within two deviations: 0.8796 of its own.
    assert np.std(delays) == pytest.approx(0.8796 * 0.02, rel=0.02)
    assert np.mean(delays) == pytest.approx(0.2, abs=5e-4)
    within = np.mean(np.abs(delays - 0.2) <= 0.02 + 0.25 * DT)
    assert within == pytest.approx(0.6827 / 0.9545, abs=SHARE)


def test_no_jitter_makes_a_packet_arrive_before_it_was_sent() -> None:
    delays = delays_of(Steady(0.001), NormalJitter(0.05))
    assert np.min(delays) == pytest.approx(DT)


def test_jitter_reorders_and_a_link_in_order_makes_packets_wait() -> None:
    effects = (Steady(0.05), UniformJitter(0.03))
    loose, strict = (
        journeys(deliver(ImpairedLink(effects=effects, in_order=in_order), 1000))
        for in_order in (False, True)
    )
    numbers = [number for number, _ in loose]
    assert numbers != sorted(numbers)
    assert [number for number, _ in strict] == list(range(len(strict)))
    first = dict(loose)
    latest = 0
    for number, delay in strict:  # each waits for the latest of those before it, and no longer
        latest = max(latest, number + first[number]) if number in first else latest
        assert number + delay == latest


def test_a_delay_ramps_and_steps() -> None:
    varying = Varying(((0.1, 0.02), (0.2, 0.06), (0.3, 0.06), (0.3, 0.01)))
    assert [varying.at(t) for t in (0.0, 0.1, 0.15, 0.25, 0.3, 9.0)] == pytest.approx(
        [0.02, 0.02, 0.04, 0.06, 0.01, 0.01]
    )
    taken = dict(journeys(deliver(ImpairedLink(effects=(varying,)), 500)))
    assert (taken[50], taken[150], taken[299], taken[300]) == (20, 40, 60, 10)
    # Where the delay falls by 50 ticks, what is sent later arrives before.
    assert 300 + taken[300] < 299 + taken[299]


def lost(effect: Effect, ticks: int = MANY, seed: int = 0) -> list[bool]:
    arrived = {number for number, _ in journeys(deliver(_only(effect, seed), ticks))}
    return [number not in arrived for number in range(ticks)]


def _only(effect: Effect, seed: int = 0) -> ImpairedLink:
    return ImpairedLink(effects=(effect,), seed=seed)


def runs_of(flags: list[bool]) -> list[int]:
    """Lengths of uninterrupted runs of what is true."""
    words = "".join("x" if flag else " " for flag in flags).split()
    return [len(word) for word in words]


def test_random_losses_are_independent() -> None:
    flags = np.array(lost(RandomLoss(0.3)))
    assert np.mean(flags) == pytest.approx(0.3, abs=SHARE)
    assert np.mean(flags[1:] & flags[:-1]) == pytest.approx(0.09, abs=SHARE)
    assert np.mean(runs_of(flags.tolist())) == pytest.approx(1.0 / 0.7, abs=0.05)


@pytest.mark.parametrize(("loss", "length"), [(0.1, 5.0), (0.3, 10.0), (0.1, 1.0 / 0.9)])
def test_bursts_have_the_share_and_the_length_that_were_asked_for(
    loss: float, length: float
) -> None:
    effect = BurstLoss.of(loss, length=length)
    assert effect.loss == pytest.approx(loss)
    # A burst of ten is one event: shares of so many packets are known to a few percent only.
    flags = [flag for seed in range(4) for flag in lost(effect, seed=seed)]
    assert np.mean(flags) == pytest.approx(loss, rel=0.1)
    assert np.mean(runs_of(flags)) == pytest.approx(length, rel=0.1)


def test_bursts_of_any_kind_follow_their_theory() -> None:
    effect = BurstLoss(worsening=0.05, recovery=0.2, lost_when_good=0.02, lost_when_bad=0.6)
    assert effect.badness == pytest.approx(0.2)
    assert effect.loss == pytest.approx(0.8 * 0.02 + 0.2 * 0.6)
    assert np.mean(lost(effect)) == pytest.approx(effect.loss, abs=SHARE)


def test_duplicates_arrive_twice_the_second_a_little_later() -> None:
    arrived = journeys(deliver(_only(Duplication(share=0.25, after=0.01)), MANY))
    copies = Counter(number for number, _ in arrived if number < MANY - 20)
    assert set(copies.values()) == {1, 2}
    assert np.mean([n == 2 for n in copies.values()]) == pytest.approx(0.25, abs=SHARE)
    assert max(delay for _, delay in arrived) == 10
    both = [delay for number, delay in arrived if copies[number] == 2 and delay > 1]
    assert np.mean(both) == pytest.approx(5.5, abs=0.5)


def test_copies_may_have_delays_of_their_own() -> None:
    doubled = ImpairedLink(effects=(Duplication(share=1.0, after=0.0), UniformJitter(0.02)))
    taken: dict[int, set[int]] = {}
    for number, delay in journeys(deliver(doubled, 500)):
        taken.setdefault(number, set()).add(delay)
    assert any(len(delays) == 2 for delays in taken.values())


def test_nothing_sent_in_an_outage_arrives_and_what_was_under_way_does() -> None:
    model = ImpairedLink(effects=(Steady(0.02), Outages(((0.1, 0.3), (0.5, 0.51)))))
    arrived = {number for number, _ in journeys(deliver(model, 700))}
    out = {*range(100, 300), *range(500, 510)}
    assert arrived == set(range(681)) - out


def test_random_outages_have_their_length_and_their_rate() -> None:
    effect = RandomOutages(rate=2.0, length=0.05)
    runs = [lost(effect, seed=seed) for seed in range(8)]
    whole = [length for flags in runs for length in runs_of(flags + [True])[:-1]]
    assert min(whole) >= 49
    assert np.median(whole) == 50  # two may follow each other at once
    assert np.mean(runs) == pytest.approx(0.05 / (0.05 + 0.5), rel=0.15)
    assert not any(lost(RandomOutages(rate=0.0, length=1.0), ticks=500))


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: ImpairedLink(effects=()), "effects"),
        (lambda: ImpairedLink(effects=(Steady(0.0),), seed=-1), "seed"),
        (lambda: ImpairedLink(effects=(Steady(0.0),), dt=0.0), "dt"),
        (lambda: Steady(-0.1), "delay"),
        (lambda: Varying(()), "points"),
        (lambda: Varying(((1.0, 0.1), (0.5, 0.1))), "order of time"),
        (lambda: Varying(((0.0, -0.1),)), "delays"),
        (lambda: Varying(((np.nan, 0.1),)), "times"),
        (lambda: UniformJitter(np.inf), "spread"),
        (lambda: NormalJitter(-1.0), "deviation"),
        (lambda: NormalJitter(1.0, cut=0.0), "cut"),
        (lambda: RandomLoss(1.1), "loss"),
        (lambda: BurstLoss(worsening=-0.1, recovery=0.5), "worsening"),
        (lambda: BurstLoss(worsening=0.1, recovery=0.0), "recovery"),
        (lambda: BurstLoss(worsening=0.1, recovery=0.5, lost_when_bad=np.nan), "lost_when_bad"),
        (lambda: BurstLoss.of(0.5, length=0.5), "length"),
        (lambda: BurstLoss.of(1.0, length=3.0), "longer"),
        (lambda: BurstLoss.of(0.9, length=2.0), "longer"),
        (lambda: Duplication(share=2.0), "share"),
        (lambda: Duplication(share=0.1, after=-1.0), "after"),
        (lambda: Outages(((2.0, 1.0),)), "end after"),
        (lambda: RandomOutages(rate=-1.0, length=1.0), "rate"),
        (lambda: RandomOutages(rate=1.0, length=inf), "length"),
    ],
)
def test_numbers_that_make_no_sense(make: object, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        make()  # type: ignore[operator]
