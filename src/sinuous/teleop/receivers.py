"""What an end makes of the packets that arrive: which wave it would use in a tick.

A packet that cannot be computed with, or does not fit, counts as lost, and the end says so.
"""

from bisect import bisect_left, bisect_right
from dataclasses import dataclass
from math import inf
from typing import NamedTuple, Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import not_negative, zero_or_more
from sinuous.teleop.link import Packet

IGNORED = "ignored a packet that does not fit or is not finite"

Packets = tuple[Packet, ...]


class Inbox(NamedTuple):
    """What an end has heard.

    Arguments:
        wave: that it would use in this tick; zero if there is none (A,)
        position: of the other end, to go with it (A,) [m]; None before the first
        number: the largest of all packets; -1 before the first
        energy: the most that the other end was heard to have sent [J]
        running: whether the other end takes part, by the newest packet
        silent: ticks since the newest packet came
        kept: packets that may be needed later, by number
        fault: what was wrong with a packet, in words; empty if nothing
    """

    wave: Array
    position: Array | None
    number: int
    energy: float
    running: bool
    silent: int
    kept: Packets
    fault: str


class Receiver(Protocol):
    """How an end fills the ticks from the packets that it has."""

    def step(self, inbox: Inbox, packets: Packets, tick: int, dt: float) -> Inbox:
        """What has been heard with the packets (zero, one or more, in any order) of a tick."""
        ...


def empty(axes: int, *, running: bool = True) -> Inbox:
    """Nothing heard yet of an end of which it is known whether it takes part from the start."""
    return Inbox(np.zeros(axes), None, -1, 0.0, running, 0, (), "")


def fits(packet: Packet, axes: int) -> bool:
    """Whether a packet is one that can be computed with."""
    wave, position = packet.wave, packet.position
    return wave.size == axes == position.size and kernels.sound(wave, position, packet.energy)


def most(heard: float, energy: float) -> float:
    """The most energy that the other end was heard to have sent [J], in whatever order."""
    return energy if energy > heard else heard


def hear(inbox: Inbox, packets: Packets) -> tuple[Inbox, Packets]:
    """What is heard whatever is done with the waves, and the packets that fit, by number."""
    good = tuple(packet for packet in packets if fits(packet, inbox.wave.size))
    if len(good) > 1:
        good = tuple(sorted(good, key=_number))
    wave, position, number, energy, running, silent, kept, _ = inbox
    for packet in good:
        energy = most(energy, packet.energy)
    silent, fault = silent + 1, "" if len(good) == len(packets) else IGNORED
    if good and good[-1].number > number:
        _, position, number, _, _, running = good[-1]
        silent = 0
    return Inbox(wave, position, number, energy, running, silent, kept, fault), good


def faded(wave: Array, longest: float, silence: float) -> Array:
    """A wave that has been repeated for some time [s]: whole, then less, then zero."""
    if silence <= longest:
        return wave
    return max(2.0 - silence / longest, 0.0) * wave if longest > 0.0 else 0.0 * wave


class Newest:
    """Receivers that use a packet when it comes, if it is newer than all before."""

    def step(self, inbox: Inbox, packets: Packets, tick: int, dt: float) -> Inbox:
        """What has been heard with the packets of a tick."""
        if len(packets) == 1:  # as on a link of constant delay, where every tick counts
            wave, position, number, _, energy, running = packets[0]
            if (
                number > inbox.number
                and wave.size == inbox.wave.size == position.size
                and kernels.sound(wave, position, energy)
            ):
                energy = most(inbox.energy, energy)
                return Inbox(wave, position, number, energy, running, 0, packets, "")
        return self.otherwise(inbox, packets, dt)

    def otherwise(self, inbox: Inbox, packets: Packets, dt: float) -> Inbox:
        """What has been heard if it is not that simple."""
        raise NotImplementedError


@dataclass(frozen=True)
class ZeroFill(Newest):
    """The newest wave of those that arrive in a tick; zero if none does.

    A lost packet takes its wave's energy away. One that arrives twice is used twice.
    """

    def otherwise(self, inbox: Inbox, packets: Packets, dt: float) -> Inbox:
        """The newest wave of this tick, or zero."""
        heard, good = hear(inbox, packets)
        return heard._replace(wave=good[-1].wave if good else np.zeros(inbox.wave.size))


@dataclass(frozen=True, kw_only=True)
class Hold(Newest):
    """The newest wave of all, until a newer one comes; waves that were overtaken are not used.

    Repeating a wave repeats its energy, whether there is any or not: without passivity control
    this makes energy.

    Arguments:
        longest: that a wave is repeated for [s]; it fades to zero in as long again

    Raises:
        ValueError: if it is negative
    """

    longest: float = inf

    def __post_init__(self) -> None:
        not_negative("longest", self.longest)

    def otherwise(self, inbox: Inbox, packets: Packets, dt: float) -> Inbox:
        """The newest wave of all."""
        heard, good = hear(inbox, packets)
        kept = good[-1:] if heard.silent == 0 else inbox.kept
        if not kept:
            return heard
        wave = faded(kept[0].wave, self.longest, heard.silent * dt)
        return heard._replace(wave=wave, kept=kept)


@dataclass(frozen=True, kw_only=True)
class Interpolated:
    """The wave of a fixed time ago, by straight lines between the packets around it.

    Packets wait until their time has come, so that a link whose delay varies below `delay` and
    that loses few packets in a row becomes one of constant delay. If nothing of that time or
    later has come, the newest is repeated as by `Hold`. Both ends must count the same ticks. The
    energy of a packet counts as heard of when its wave is used, so that it is not spent before.

    Arguments:
        delay: of everything, from the tick of sending, to the nearest whole number of ticks [s]
        longest: that a wave is repeated for [s]; it fades to zero in as long again

    Raises:
        ValueError: if one is negative, or the delay not finite
    """

    delay: float
    longest: float = inf

    def __post_init__(self) -> None:
        zero_or_more("delay", self.delay)
        not_negative("longest", self.longest)

    def step(self, inbox: Inbox, packets: Packets, tick: int, dt: float) -> Inbox:
        """What has been heard with the packets of a tick."""
        heard, good = hear(inbox, packets)
        due = tick - round(self.delay / dt)
        kept = _around(inbox.kept, good, due)
        heard = heard._replace(position=inbox.position, energy=inbox.energy, kept=kept)
        if not kept or kept[0].number > due:
            return heard
        before, after = kept[0], kept[min(1, len(kept) - 1)]
        late = due - before.number
        if after is before or not late:
            wave, position = faded(before.wave, self.longest, late * dt), before.position
            energy = most(heard.energy, before.energy)
        else:
            part = late / (after.number - before.number)
            wave = before.wave + part * (after.wave - before.wave)
            position = before.position + part * (after.position - before.position)
            energy = most(heard.energy, after.energy)
        return heard._replace(wave=wave, position=position, energy=energy)


def _around(kept: Packets, new: Packets, due: int) -> Packets:
    """Packets by number, from the last that is due on."""
    for packet in new:
        at = bisect_left(kept, packet.number, key=_number)
        if at == len(kept) or kept[at].number != packet.number:
            kept = (*kept[:at], packet, *kept[at:])
    return kept[max(bisect_right(kept, due, key=_number) - 1, 0) :]


def _number(packet: Packet) -> int:
    return packet.number
