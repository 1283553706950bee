"""Which wave an end would use, for what comes in a tick."""

import numpy as np
import pytest
from hypothesis import given, settings

from sinuous.arrays import Array
from sinuous.teleop.link import Packet
from sinuous.teleop.receivers import Hold, Inbox, Interpolated, Packets, Receiver, ZeroFill, empty

from .bad_links import links
from .rigs import DT

TWO_TICKS = 2.2 * DT  # a rounding of a tick's time away from where anything changes


def packet(number: int, *, energy: float | None = None) -> Packet:
    """With a wave and a position that tell its number."""
    return Packet(
        wave=np.array([float(number + 1)]),
        position=np.array([10.0 * number]),
        number=number,
        time=number * DT,
        energy=float(number) if energy is None else energy,
    )


def waves(receiver: Receiver, arrivals: list[list[int]]) -> list[float]:
    """The wave of every tick, for the numbers of the packets that arrive in it."""
    inbox, found = empty(1), list[float]()
    for tick, numbers in enumerate(arrivals):
        inbox = receiver.step(inbox, tuple(packet(n) for n in numbers), tick, DT)
        found.append(float(inbox.wave[0]))
    return found


ODD: list[list[int]] = [[], [0], [1], [], [2, 3], [4, 4], [], [], [], [7], [5, 6], [8]]


def test_zero_takes_the_place_of_what_does_not_come() -> None:
    assert waves(ZeroFill(), ODD) == [0, 1, 2, 0, 4, 5, 0, 0, 0, 8, 7, 9]


def test_hold_repeats_the_newest_of_all() -> None:
    assert waves(Hold(), ODD) == [0, 1, 2, 2, 4, 5, 5, 5, 5, 8, 8, 9]


def test_what_is_held_fades_in_as_long_again() -> None:
    got = waves(Hold(longest=TWO_TICKS), [[0], *7 * [[]], [5]])
    expected = [1.0, 1.0, 1.0, *(2.0 - k / 2.2 for k in (3, 4)), 0.0, 0.0, 0.0, 6.0]
    assert got == pytest.approx(expected)
    assert waves(Hold(longest=0.0), [[0], [], [], [1]]) == [1, 0, 0, 2]


def test_interpolated_waits_and_draws_straight_lines() -> None:
    receiver = Interpolated(delay=3 * DT)
    arrivals: list[list[int]] = [[], [0], [1], [], [4], [], [3], [8], [], [], [], [], []]
    # Tick k is due for what was sent in tick k - 3; 2 is missing, 3 comes just in time.
    expected = [0, 0, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 9]
    assert waves(receiver, arrivals) == pytest.approx(expected)


def test_interpolated_holds_what_is_last_and_lets_it_fade() -> None:
    arrivals: list[list[int]] = [[0], [1], *8 * [[]]]
    assert waves(Interpolated(delay=DT), arrivals) == [0, 1, 2, 2, 2, 2, 2, 2, 2, 2]
    got = waves(Interpolated(delay=DT, longest=TWO_TICKS), arrivals)
    fading = [2.0 * (2.0 - k / 2.2) for k in (3, 4)]
    assert got == pytest.approx([0.0, 1.0, 2.0, 2.0, 2.0, *fading, 0.0, 0.0, 0.0])


def test_energy_of_what_waits_is_not_heard_of_yet() -> None:
    inbox, receiver = empty(1), Interpolated(delay=3 * DT)
    heard = list[float]()
    for tick in range(8):
        inbox = receiver.step(inbox, (packet(tick + 1),), tick, DT)
        heard.append(inbox.energy)
    assert heard == [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 3.0, 4.0]
    assert float(inbox.wave[0]) == 5.0


@pytest.mark.parametrize("receiver", [ZeroFill(), Hold(), Interpolated(delay=2 * DT)])
@settings(max_examples=40)
@given(model=links())
def test_what_is_heard_depends_on_what_came_and_not_on_its_order(
    receiver: Receiver, model: object
) -> None:
    """Backwards in every tick, and with all copies twice."""
    link, axes = model.open(), 1  # type: ignore[attr-defined]
    one, other, newest, most = empty(axes), empty(axes), -1, 0.0
    for k in range(200):
        arrived: Packets = link.step(packet(k, energy=float(k)))
        one = receiver.step(one, arrived, k, DT)
        other = receiver.step(other, (*reversed(arrived), *arrived), k, DT)
        _same(one, other)
        newest = max([newest, *(p.number for p in arrived)])
        most = max([most, *(p.energy for p in arrived)])
        assert one.number == newest
        assert one.energy <= most
        if not isinstance(receiver, Interpolated):
            assert one.energy == most
            assert one.position is None or one.position[0] == 10.0 * newest


def _same(one: Inbox, other: Inbox, *, but: tuple[str, ...] = ("kept",)) -> None:
    """Which packets are kept is a receiver's own business."""
    for name, a, b in zip(Inbox._fields, one, other, strict=True):
        if name not in but:
            np.testing.assert_array_equal(a, b, err_msg=name)  # type: ignore[arg-type]


def spoiled(**change: object) -> Packet:
    return packet(3)._replace(**change)  # type: ignore[arg-type]


NAN: Array = np.array([np.nan])


@pytest.mark.parametrize("receiver", [ZeroFill(), Hold(), Interpolated(delay=2 * DT)])
@pytest.mark.parametrize(
    "bad",
    [
        spoiled(wave=NAN),
        spoiled(position=NAN),
        spoiled(energy=np.inf),
        spoiled(energy=-1.0),
        spoiled(wave=np.zeros(2)),
        spoiled(position=np.zeros(0)),
    ],
)
def test_what_cannot_be_computed_with_is_lost_and_said_to_be(
    receiver: Receiver, bad: Packet
) -> None:
    start = receiver.step(empty(1), (packet(0),), 0, DT)
    without, with_it = (receiver.step(start, ps, 1, DT) for ps in ((), (bad,)))
    assert without.fault == ""
    assert with_it.fault != ""
    _same(without, with_it, but=("kept", "fault"))
    both = receiver.step(start, (bad, packet(1)), 1, DT)
    assert both.number == 1
    assert both.fault != ""
    assert receiver.step(with_it, (packet(2),), 2, DT).fault == ""


def test_running_and_position_are_the_newest_s() -> None:
    late, newer = packet(1)._replace(running=True), packet(2)._replace(running=False)
    inbox = Hold().step(empty(1), (newer,), 0, DT)
    inbox = Hold().step(inbox, (late,), 1, DT)
    assert not inbox.running
    assert inbox.position == 20.0


@pytest.mark.parametrize(
    ("make", "says"),
    [
        (lambda: Hold(longest=-1.0), "longest"),
        (lambda: Hold(longest=np.nan), "longest"),
        (lambda: Interpolated(delay=np.inf), "delay"),
        (lambda: Interpolated(delay=0.1, longest=-0.1), "longest"),
    ],
)
def test_numbers_that_make_no_sense(make: object, says: str) -> None:
    with pytest.raises(ValueError, match=says):
        make()  # type: ignore[operator]
