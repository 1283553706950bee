"""Ports with all that makes them hold on a bad link, one for each end.

From packets to a wave: a receiver says which wave it would use, limits bound it, and passivity
control takes as much of it as there is energy for. What is sent has a number, a time and the
energy sent so far.
"""

from dataclasses import dataclass, field
from math import inf
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import Packet
from sinuous.teleop.passivity import PassivityControl, sent_after, spare, used_after
from sinuous.teleop.receivers import Inbox, Packets, Receiver, ZeroFill, empty
from sinuous.teleop.scheme import Scheme


class PortMemory(NamedTuple):
    """What a port remembers between ticks.

    Arguments:
        number: of the next packet: ticks that have gone by
        scheme: what the scheme remembers
        inbox: what was heard
        wave: that was used last (A,)
        sent, used: energy so far [J]; zero without passivity control. Used starts below zero by the
            loan that a scheme gives
    """

    number: int
    scheme: Array
    inbox: Inbox
    wave: Array
    sent: float
    used: float


@dataclass(frozen=True, kw_only=True)
class Port:
    """What both ports have in common.

    Arguments:
        scheme: how velocity and force become waves
        receiver: which wave to use
        control: of passivity; None to use whatever the receiver says
        limits: of what comes from afar

    Raises:
        ValueError: if control is asked for with a scheme that makes energy by itself
    """

    scheme: Scheme
    receiver: Receiver = field(default_factory=ZeroFill)
    control: PassivityControl | None = None
    limits: Limits | None = None

    def __post_init__(self) -> None:
        if self.control is not None and not self.scheme.is_passive:
            raise ValueError("passivity control needs ports that make no energy by themselves")

    def listen(self, memory: PortMemory, packets: Packets) -> Inbox:
        """What has been heard with the packets of a tick."""
        return self.receiver.step(memory.inbox, packets, memory.number, self.scheme.dt)

    def spare(self, memory: PortMemory) -> float:
        """Energy that the other end has sent and nobody used [J]."""
        return spare(memory.inbox.energy, memory.used)

    def spend(self, memory: PortMemory, energy: float) -> PortMemory:
        """Use some of it for something else than waves [J]."""
        return memory._replace(used=memory.used + energy)

    def idle(
        self, memory: PortMemory, inbox: Inbox, position: Array, running: bool
    ) -> tuple[PortMemory, Packet]:
        """A tick in which nothing goes in or out: no wave is used, and one of zero is sent."""
        number, scheme, _, wave, sent, used = memory
        zero = np.zeros(wave.size)
        packet = Packet(zero, position, number, number * self.scheme.dt, sent, running)
        return PortMemory(number + 1, scheme, inbox, zero, sent, used), packet

    def asleep(
        self, memory: PortMemory, inbox: Inbox, position: Array, running: bool
    ) -> tuple[PortMemory, Packet]:
        """The same while the end pauses: what is left of before is not used after."""
        memory, packet = self.idle(memory, inbox, position, running)
        used = max(memory.used, inbox.energy - self._loan)
        return memory._replace(scheme=self._init(position.size), used=used), packet

    @property
    def _loan(self) -> float:
        return 0.0

    def _init(self, axes: int) -> Array:
        raise NotImplementedError

    def init(self, axes: int, *, running: bool = True) -> PortMemory:
        """The port with nothing in it, and whether the other end takes part from the start."""
        inbox = empty(axes, running=running)
        return PortMemory(0, self._init(axes), inbox, np.zeros(axes), 0.0, -self._loan)


@dataclass(frozen=True, kw_only=True)
class LeaderPort(Port):
    """Takes a velocity and gives a force."""

    @property
    def _loan(self) -> float:
        return 0.0 if self.control is None else self.scheme.loan

    def _init(self, axes: int) -> Array:
        return self.scheme.leader_init(axes)

    def use(self, memory: PortMemory, inbox: Inbox) -> tuple[Array, float]:
        """The wave to use, and the energy [J] beyond which its force yields."""
        scheme, wave, left = self.scheme, inbox.wave, inf
        if self.limits is not None:
            wave = self.limits.wave(wave, memory.wave, scheme.force_gain, scheme.dt)
        if self.control is not None:
            wave = scheme.leader_use(wave, inbox.energy, memory.used)
            left = spare(inbox.energy, memory.used) if scheme.yields else inf
        return wave, left

    def answer(
        self,
        memory: PortMemory,
        inbox: Inbox,
        wave: Array,
        v: Array,
        position: Array,
        running: bool,
    ) -> tuple[PortMemory, Array, Packet]:
        """The force [N], and what to send.

        Arguments:
            wave: as used; what is left of it if its force has yielded (A,)
            v: of the leader during the tick (A,) [m/s]
            position: of the leader when it begins (A,) [m]
            running: whether this end takes part
        """
        number, port, _, _, total, used = memory
        port, force, sent = self.scheme.leader_step(port, v, wave)
        if self.control is not None:
            flow = self.scheme.leader_flow(v, force, wave, sent)
            surplus = self.control.surplus(inbox.energy, used, flow)
            total, used = sent_after(total, flow, 0.0), used_after(used, flow, surplus)
        packet = Packet(sent, position, number, number * self.scheme.dt, total, running)
        return PortMemory(number + 1, port, inbox, wave, total, used), force, packet


@dataclass(frozen=True, kw_only=True)
class FollowerPort(Port):
    """Takes a force and gives a desired velocity."""

    def _init(self, axes: int) -> Array:
        return self.scheme.follower_init(axes)

    def answer(
        self, memory: PortMemory, inbox: Inbox, force: Array, position: Array, running: bool
    ) -> tuple[PortMemory, Array, Packet]:
        """The desired velocity [m/s], and what to send.

        Arguments:
            force: that opposes the follower (A,) [N]
            position: desired when the tick begins (A,) [m]
            running: whether this end takes part
        """
        scheme = self.scheme
        number, port, _, before, total, used = memory
        wave = inbox.wave
        if self.limits is not None:
            wave = self.limits.wave(wave, before, scheme.speed_gain, scheme.dt)
        if self.control is not None:
            wave = scheme.follower_use(force, wave, inbox.energy, used)
        port, desired, sent = scheme.follower_step(port, force, wave)
        if self.control is not None:
            flow = scheme.follower_flow(force, desired, wave, sent)
            surplus = self.control.surplus(inbox.energy, used, flow)
            total, used = sent_after(total, flow, surplus), used_after(used, flow, surplus)
        packet = Packet(sent, position, number, number * scheme.dt, total, running)
        return PortMemory(number + 1, port, inbox, wave, total, used), desired, packet
