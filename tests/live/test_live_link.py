"""A link that becomes another one."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st

from sinuous.live.live_link import LiveLink
from sinuous.teleop.link import ConstantDelay, Packet

DT = 1e-3


def packet(number: int) -> Packet:
    return Packet(np.zeros(1), np.zeros(1), number=number)


@given(st.lists(st.tuples(st.integers(1, 30), st.integers(0, 40)), min_size=1, max_size=6))
def test_every_packet_arrives_once_after_the_delay_of_when_it_was_sent(
    kinds: list[tuple[int, int]],
) -> None:
    link, number, delays = LiveLink(ConstantDelay(delay=5 * DT), 0), 0, dict[int, int]()
    delay, arrived = 5, dict[int, int]()

    def tick() -> None:
        nonlocal number
        delays[number] = delay
        for one in link.step(packet(number)):
            assert one.number not in arrived
            arrived[one.number] = number + 1
        number += 1

    for ticks, lasts in kinds:
        link.become(ConstantDelay(delay=ticks * DT), delay * DT)
        delay = ticks
        for _ in range(lasts):
            tick()
    sent = number
    for _ in range(35):
        tick()
    assert {k: arrived[k] - k for k in range(sent)} == {k: delays[k] for k in range(sent)}
