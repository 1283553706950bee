"""How long packets take."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.teleop.link import ConstantDelay, Packet

from .rigs import DT


def packet(number: int) -> Packet:
    return Packet(wave=np.array([float(number)]), position=np.zeros(1), number=number)


@given(delay=st.floats(0.0, 0.3))
def test_what_is_sent_in_a_tick_is_received_whole_ticks_later(delay: float) -> None:
    model = ConstantDelay(delay=delay, dt=DT)
    link, received = model.open(), list[tuple[Packet, ...]]([()])  # in tick 0 nothing has arrived
    for k in range(model.ticks + 5):
        received.append(link.step(packet(k)))
    assert model.ticks == pytest.approx(delay / DT, abs=0.5 + 1e-9) or model.ticks == 1
    for k, got in enumerate(received):
        assert [p.number for p in got] == ([k - model.ticks] if k >= model.ticks else [])


def test_no_delay_is_one_tick() -> None:
    assert ConstantDelay(delay=0.0).ticks == 1
    assert len(ConstantDelay(delay=0.0).open().step(packet(7))) == 1


def test_two_ways_share_nothing() -> None:
    model = ConstantDelay(delay=2 * DT)
    one, other = model.open(0), model.open(1)
    one.step(packet(1))
    assert other.step(packet(2)) == ()
    assert other.step(packet(3))[0].number == 2


@pytest.mark.parametrize("delay", [-0.1, np.nan, np.inf])
def test_delays_that_make_no_sense(delay: float) -> None:
    with pytest.raises(ValueError, match="delay must be zero or more"):
        ConstantDelay(delay=delay)


def test_ticks_that_make_no_sense() -> None:
    with pytest.raises(ValueError, match="dt must be positive"):
        ConstantDelay(delay=0.1, dt=0.0)
