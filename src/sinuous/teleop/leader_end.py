"""The leader's end of a teleoperation, which could be a machine of its own."""

from dataclasses import dataclass, field
from functools import cached_property
from math import inf
from typing import Generic, NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.leader import LeaderDevice, Load
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import Packet
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.operators import Felt, O, Operator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.ports import LeaderPort, PortMemory
from sinuous.teleop.ramp import Ramp
from sinuous.teleop.receivers import Inbox, Packets, Receiver, ZeroFill
from sinuous.teleop.scheme import Scheme


class LeaderState(NamedTuple, Generic[O]):
    """What the leader's end remembers.

    Arguments:
        tick: how many have gone by
        x: of the device (A,) [m]
        v: its velocity in the tick before (A,) [m/s]
        operator: what the operator remembers
        port: what the port remembers
        share: rho, by which the end takes part, see `Ramp`
        running: whether it wants to
        slipped: motion of the device that the port was not shown, on the wave side (A,) [m];
            None for none
    """

    tick: int
    x: Array
    v: Array
    operator: O
    port: PortMemory
    share: float
    running: bool
    slipped: Array | None


class LeaderSignals(NamedTuple):
    """What there is to see of the leader's end in a tick.

    Arguments:
        x: of the device when the tick begins (A,) [m]
        v: its velocity during the tick (A,) [m/s]
        F_h: the operator's force (A,) [N]
        F_m: the force fed back (A,) [N]
        X, V: x, but for motion while the end did not take part, and v on the wave side (A,) [m],
            [m/s]
        wave: used (A,)
        fault: what went wrong, in words; empty if all is well
    """

    x: Array
    v: Array
    F_h: Array
    F_m: Array
    X: Array
    V: Array
    wave: Array
    fault: str


@dataclass(frozen=True, kw_only=True, eq=False)
class LeaderEnd(Generic[O]):
    """Operator, device and port.

    Packets that do not fit or are not finite count as lost. If the operator's force cannot be
    computed with, no force is fed back, nothing is sent but where the device is, and the device
    stands still.

    Arguments:
        scheme: of the waves
        mapping: from the device's workspace to the wave side
        operator: whoever holds the device
        device: what is held
        receiver: which wave to use; by default the one that arrives in a tick, zero if none does
        control: of passivity; None for none
        limits: of the force from afar, on a hand at rest [N], [N/s]; None for none
        ramp: for joining and leaving

    Raises:
        ValueError: if control is asked for with a scheme that makes energy by itself
    """

    scheme: Scheme
    mapping: Mapping
    operator: Operator[O]
    device: LeaderDevice
    receiver: Receiver = field(default_factory=ZeroFill)
    control: PassivityControl | None = None
    limits: Limits | None = None
    ramp: Ramp = field(default_factory=Ramp)

    def __post_init__(self) -> None:
        _ = self.port

    @cached_property
    def port(self) -> LeaderPort:
        """The port itself, which knows nothing of hand and device."""
        return LeaderPort(
            scheme=self.scheme, receiver=self.receiver, control=self.control, limits=self.limits
        )

    @cached_property
    def _zero(self) -> Array:
        return np.zeros(self.mapping.scale.size)

    @cached_property
    def _damping(self) -> Array:
        return self.scheme.damping * self.mapping.scale

    def init(self, X: Array, *, running: bool = True) -> LeaderState[O]:
        """At rest where the mapping puts the follower at X (A,) [m] of the wave side."""
        x = X / self.mapping.scale
        hand, port = self.operator.init(x), self.port.init(x.size, running=running)
        return LeaderState(0, x, self._zero, hand, port, float(running), running, None)

    def pause(self, state: LeaderState[O]) -> LeaderState[O]:
        """Leave the channel, and have the other end do so."""
        return state._replace(running=False)

    def resume(self, state: LeaderState[O]) -> LeaderState[O]:
        """Join it again, if the other end does."""
        return state._replace(running=True)

    def step(
        self, state: LeaderState[O], received: Packets
    ) -> tuple[LeaderState[O], LeaderSignals, Packet]:
        """One tick: what is felt, what the device does, and what is sent."""
        tick, x, v, hand, port, share, running, slipped = state
        scale, dt, device = self.mapping.scale, self.scheme.dt, self.device
        inbox = self.receiver.step(port.inbox, received, port.number, dt)
        wave, left = self.port.use(port, inbox)
        joins = running and inbox.running
        if share < 1.0 or not joins:
            share = self.ramp.step(share, dt, join=joins)
        load = Load(self.scheme.force_at_rest(wave), self._damping)
        if share < 1.0 or left < inf:
            load = Load(share * load.force, share**2 * load.damping, left, scale)
        hand, F_h = self.operator.step(hand, Felt(tick * dt, x, v, load), device, dt)
        if left < inf:
            kept, place, v = device.give_way(x, v, F_h, load, dt)
            wave = kept * wave
        else:
            place, v = device.step(x, v, F_h, load, dt)
        X, V = np.empty(x.size), np.empty(x.size)
        kernels.on_wave_side(scale, x, v, X, V)
        if slipped is not None:
            np.subtract(X, slipped, out=X)
        if share == 1.0:
            port, F_m, packet = self.port.answer(port, inbox, wave, V, X, running)
        else:
            port, F_m, packet = self._partly(state, inbox, wave, share, V, X)
            slipped = (1.0 - share) * dt * V + (0.0 if slipped is None else slipped)
        if not kernels.finite(F_m, packet.wave, place):
            return self._rest(state, inbox)
        signals = LeaderSignals(x, v, F_h, F_m, X, V, wave, inbox.fault)
        after = LeaderState(tick + 1, place, v, hand, port, share, running, slipped)
        return after, signals, packet

    def _partly(
        self, state: LeaderState[O], inbox: Inbox, wave: Array, share: float, V: Array, X: Array
    ) -> tuple[PortMemory, Array, Packet]:
        """Port, force and packet of an end that takes part by a share."""
        running = state.running
        if share == 0.0:
            port, packet = self.port.asleep(state.port, inbox, X, running)
            return port, self._zero, packet
        port, F, packet = self.port.answer(state.port, inbox, wave, share * V, X, running)
        return port, share * F, packet

    def _rest(
        self, state: LeaderState[O], inbox: Inbox
    ) -> tuple[LeaderState[O], LeaderSignals, Packet]:
        zero, x = self._zero, state.x
        X = self.mapping.scale * x - (0.0 if state.slipped is None else state.slipped)
        port, packet = self.port.idle(state.port, inbox, X, state.running)
        fault = "holding still: the operator's force is not finite"
        signals = LeaderSignals(x, zero, zero, zero, X, zero, zero, fault)
        return state._replace(tick=state.tick + 1, v=zero, port=port), signals, packet
