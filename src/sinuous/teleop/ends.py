"""The two ends of a teleoperation, each of which could be a machine of its own."""

from dataclasses import dataclass
from functools import cached_property
from typing import Generic, NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop import kernels
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.force import Motion, VirtualForce
from sinuous.teleop.leader import LeaderDevice, Load
from sinuous.teleop.link import Packet
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.operators import Felt, O, Operator
from sinuous.teleop.waves import PortState, Scheme


class LeaderState(NamedTuple, Generic[O]):
    """What the leader's end remembers.

    Arguments:
        tick: how many have gone by
        x: of the device (A,) [m]
        v: its velocity in the tick before (A,) [m/s]
        operator: what the operator remembers
        port: what the port remembers
    """

    tick: int
    x: Array
    v: Array
    operator: O
    port: PortState


class LeaderSignals(NamedTuple):
    """What there is to see of the leader's end in a tick.

    Arguments:
        x: of the device when the tick begins (A,) [m]
        v: its velocity during the tick (A,) [m/s]
        F_h: the operator's force (A,) [N]
        F_m: the force fed back (A,) [N]
        X, V: x and v on the wave side (A,) [m], [m/s]
        wave: received; zero if nothing came (A,)
        fault: why the end is in its safe state, in words; empty if all is well
    """

    x: Array
    v: Array
    F_h: Array
    F_m: Array
    X: Array
    V: Array
    wave: Array
    fault: str


class FollowerState(NamedTuple):
    """What the follower's end remembers.

    Arguments:
        X_sd, V_sd: desired (A,) [m], and its velocity over the last tick [m/s]
        X_s: where the follower was last seen (A,) [m]; None after a fault
        port: what the port remembers
        tank: energy that may be spent on the correction of drift [J]
    """

    X_sd: Array
    V_sd: Array
    X_s: Array | None
    port: PortState
    tank: float


class FollowerSignals(NamedTuple):
    """What there is to see of the follower's end in a tick.

    Arguments:
        X_sd: desired when the tick begins (A,) [m]
        V_sd: desired velocity during the tick (A,) [m/s]
        X_s: measured when the tick begins (A,) [m]
        F_s: virtual force (A,) [N]
        target_w: where the tip should be when the tick ends (3,) [m]
        wave: received; zero if nothing came (A,)
        fault: why the end is in its safe state, in words; empty if all is well
    """

    X_sd: Array
    V_sd: Array
    X_s: Array
    F_s: Array
    target_w: Array
    wave: Array
    fault: str


@dataclass(frozen=True, kw_only=True, eq=False)
class LeaderEnd(Generic[O]):
    """Operator, device and port.

    A tick without a packet is one with a wave of zero, which adds no energy. With a number that
    cannot be computed with, no force is fed back, nothing is sent but where the device is, and
    the device stands still.

    Arguments:
        scheme: of the waves
        mapping: from the device's workspace to the wave side
        operator: whoever holds the device
        device: what is held
    """

    scheme: Scheme
    mapping: Mapping
    operator: Operator[O]
    device: LeaderDevice

    @cached_property
    def _zero(self) -> Array:
        return np.zeros(self.mapping.scale.size)

    @cached_property
    def _damping(self) -> Array:
        return self.scheme.damping * self.mapping.scale

    def init(self, X: Array) -> LeaderState[O]:
        """At rest where the mapping puts the follower at X (A,) [m] of the wave side."""
        x = X / self.mapping.scale
        port = self.scheme.leader_init(x.size)
        return LeaderState(0, x, self._zero, self.operator.init(x), port)

    def step(
        self, state: LeaderState[O], received: Packet | None
    ) -> tuple[LeaderState[O], LeaderSignals, Packet]:
        """One tick: what is felt, what the device does, and what is sent."""
        tick, x, v, hand, port = state
        scale, dt, device = self.mapping.scale, self.scheme.dt, self.device
        wave = self._zero if received is None else received.wave
        load = Load(self.scheme.force_at_rest(wave), self._damping)
        hand, F_h = self.operator.step(hand, Felt(tick * dt, x, v, load), device, dt)
        place, v = device.step(x, v, F_h, load, dt)
        X, V = scale * x, scale * v
        port, F_m, sent = self.scheme.leader_step(port, V, wave)
        if not kernels.finite(F_m, sent, place):
            return self._rest(state, wave)
        signals = LeaderSignals(x, v, F_h, F_m, X, V, wave, "")
        return LeaderState(tick + 1, place, v, hand, port), signals, Packet(sent, X)

    def _rest(
        self, state: LeaderState[O], wave: Array
    ) -> tuple[LeaderState[O], LeaderSignals, Packet]:
        zero, X = self._zero, self.mapping.scale * state.x
        what = "the operator's force is" if np.all(np.isfinite(wave)) else "what was received is"
        fault = f"holding still: {what} not finite"
        signals = LeaderSignals(state.x, zero, zero, zero, X, zero, wave, fault)
        return state._replace(tick=state.tick + 1, v=zero), signals, Packet(zero, X)


@dataclass(frozen=True, kw_only=True, eq=False)
class FollowerEnd:
    """Port, desired point and virtual force; the follower itself is a controller's.

    A tick without a packet is one with a wave of zero, which adds no energy. With a number that
    cannot be computed with, the desired point stands still, there is no force, and nothing is
    sent but where that point is.

    Arguments:
        scheme: of the waves
        mapping: from the wave side to the world
        force: what the operator shall feel
        correction: of the desired point's drift; None as printed

    Raises:
        ValueError: if force and mapping differ in their axes
    """

    scheme: Scheme
    mapping: Mapping
    force: VirtualForce
    correction: DriftCorrection | None = None

    def __post_init__(self) -> None:
        zero = self._zero
        if self.force.force(Motion(zero, zero, zero, zero)).shape != zero.shape:
            raise ValueError(f"the force must have {zero.size} axes, as the mapping has")

    @cached_property
    def _zero(self) -> Array:
        return np.zeros(self.mapping.scale.size)

    def init(self, tip_w: ArrayLike) -> FollowerState:
        """At rest, with the desired point where the follower's tip is (3,) [m].

        Raises:
            ValueError: if the tip is not three finite numbers
        """
        tip = np.array(tip_w, dtype=np.float64)
        if tip.shape != (3,) or not np.all(np.isfinite(tip)):
            raise ValueError(f"the tip must be three finite numbers, not {tip_w}")
        X = self.mapping.project(tip)
        return FollowerState(X, self._zero, X, self.scheme.follower_init(X.size), 0.0)

    def step(
        self, state: FollowerState, tip_w: ArrayLike, received: Packet | None
    ) -> tuple[FollowerState, FollowerSignals, Packet]:
        """One tick, given the follower's measured tip (3,) [m]: force, target and what is sent."""
        X_sd, V_before, X_before, port, tank = state
        dt, zero = self.scheme.dt, self._zero
        X_s, V_s, X_next = self.mapping.project(tip_w), np.empty(zero.size), np.empty(zero.size)
        kernels.difference(X_s, X_s if X_before is None else X_before, dt, V_s)
        wave = zero if received is None else received.wave
        F_s = self.force.force(Motion(X_sd, V_before, X_s, V_s))
        port, V_sd, sent = self.scheme.follower_step(port, F_s, wave)
        if self.correction is not None and received is not None:
            lost, offset = self.scheme.follower_loss(F_s, wave), received.position - X_sd
            tank, v_c = self.correction.step(tank, lost, F_s, offset, dt)
            V_sd = V_sd + v_c
        kernels.advance(X_sd, V_sd, dt, X_next)
        if not kernels.finite(X_s, sent, X_next):
            return self._rest(state, X_s, received)
        target = self.mapping.place(X_next)
        signals = FollowerSignals(X_sd, V_sd, X_s, F_s, target, wave, "")
        return FollowerState(X_next, V_sd, X_s, port, tank), signals, Packet(sent, X_sd)

    def _rest(
        self, state: FollowerState, X_s: Array, received: Packet | None
    ) -> tuple[FollowerState, FollowerSignals, Packet]:
        zero, X_sd = self._zero, state.X_sd
        packet = Packet(zero, zero) if received is None else received
        wave = packet.wave
        if not np.all(np.isfinite(X_s)):
            what = "the measured tip is"
        elif not np.all(np.isfinite(packet)):
            what = "what was received is"
        else:
            what = "the virtual force is"
        target, fault = self.mapping.place(X_sd), f"holding still: {what} not finite"
        signals = FollowerSignals(X_sd, zero, X_s, zero, target, wave, fault)
        return state._replace(V_sd=zero, X_s=None), signals, Packet(zero, X_sd)
