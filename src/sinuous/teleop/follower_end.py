"""The follower's end of a teleoperation, which could be a machine of its own."""

from dataclasses import dataclass, field
from functools import cached_property
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop import kernels
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.force import VirtualForce
from sinuous.teleop.held import Settling
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import Packet
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.motion import NO_WALLS, Motion, Walls
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.ports import FollowerPort, PortMemory
from sinuous.teleop.ramp import Ramp
from sinuous.teleop.receivers import Inbox, Packets, Receiver, ZeroFill
from sinuous.teleop.scheme import Scheme


class FollowerState(NamedTuple):
    """What the follower's end remembers.

    Arguments:
        X_sd, V_sd: desired (A,) [m], and its velocity over the last tick [m/s]
        X_s: where the follower was last seen (A,) [m]; None after a fault
        port: what the port remembers
        tank: energy that may be spent on the correction of drift [J]
        share: rho, by which the end takes part, see `Ramp`
        running: whether it wants to
        apart: of the leader, where the desired point belongs (A,) [m]; None for where it is itself
        walls: that the force knows of
    """

    X_sd: Array
    V_sd: Array
    X_s: Array | None
    port: PortMemory
    tank: float
    share: float
    running: bool
    apart: Array | None
    walls: Walls = NO_WALLS


class FollowerSignals(NamedTuple):
    """What there is to see of the follower's end in a tick.

    Arguments:
        X_sd: desired when the tick begins (A,) [m]
        V_sd: desired velocity during the tick (A,) [m/s]
        X_s: measured when the tick begins (A,) [m]
        F_s: virtual force (A,) [N]
        target_w: where the tip should be when the tick ends (3,) [m]
        wave: used (A,)
        fault: what went wrong, in words; empty if all is well
    """

    X_sd: Array
    V_sd: Array
    X_s: Array
    F_s: Array
    target_w: Array
    wave: Array
    fault: str


@dataclass(frozen=True, kw_only=True, eq=False)
class FollowerEnd:
    """Port, desired point and virtual force; the follower itself is a controller's.

    Packets that do not fit or are not finite count as lost. If the measured tip or the virtual
    force cannot be computed with, the desired point stands still, there is no force, and nothing
    is sent but where that point is.

    Arguments:
        scheme: of the waves
        mapping: from the wave side to the world
        force: what the operator shall feel
        correction: of the desired point's drift; None as printed
        receiver: which wave to use; by default the one that arrives in a tick, zero if none does
        control: of passivity; None for none
        limits: of the desired velocity without a force [m/s], [m/s^2]; None for none
        ramp: for joining and leaving
        settling: of what the controller knows of walls

    Raises:
        ValueError: if force and mapping differ in their axes, or control is asked for with a
            scheme that makes energy by itself
    """

    scheme: Scheme
    mapping: Mapping
    force: VirtualForce
    correction: DriftCorrection | None = None
    receiver: Receiver = field(default_factory=ZeroFill)
    control: PassivityControl | None = None
    limits: Limits | None = None
    ramp: Ramp = field(default_factory=Ramp)
    settling: Settling = field(default_factory=Settling)

    def __post_init__(self) -> None:
        zero, _ = self._zero, self.port
        if self.force.force(Motion(zero, zero, zero, zero)).shape != zero.shape:
            raise ValueError(f"the force must have {zero.size} axes, as the mapping has")

    @cached_property
    def port(self) -> FollowerPort:
        """The port itself, which knows nothing of the follower."""
        return FollowerPort(
            scheme=self.scheme, receiver=self.receiver, control=self.control, limits=self.limits
        )

    @cached_property
    def _zero(self) -> Array:
        return np.zeros(self.mapping.scale.size)

    def init(self, tip_w: ArrayLike, *, running: bool = True) -> FollowerState:
        """At rest, with the desired point where the follower's tip is (3,) [m].

        Raises:
            ValueError: if the tip is not three finite numbers
        """
        tip = np.array(tip_w, dtype=np.float64)
        if tip.shape != (3,) or not np.all(np.isfinite(tip)):
            raise ValueError(f"the tip must be three finite numbers, not {tip_w}")
        X, port = self.mapping.project(tip), self.port.init(self._zero.size, running=running)
        return FollowerState(X, self._zero, X, port, 0.0, float(running), True, None)

    def pause(self, state: FollowerState) -> FollowerState:
        """Leave the channel, and have the other end do so."""
        return state._replace(running=False)

    def resume(self, state: FollowerState) -> FollowerState:
        """Join it again, if the other end does."""
        return state._replace(running=True)

    def step(
        self, state: FollowerState, tip_w: ArrayLike, received: Packets, walls: Walls = NO_WALLS
    ) -> tuple[FollowerState, FollowerSignals, Packet]:
        """One tick, given the follower's measured tip (3,) [m]: force, target and what is sent.

        Arguments:
            walls: that its controller knows of
        """
        X_sd, V_before, X_before, port, tank, share, running, apart, seen = state
        dt, zero = self.scheme.dt, self._zero
        (X_s, V_s), X_next = self.mapping.watch(tip_w, X_before, dt), np.empty(zero.size)
        inbox = self.receiver.step(port.inbox, received, port.number, dt)
        joins = running and inbox.running
        if share < 1.0 or not joins:
            if share == 0.0 and joins:
                X_sd, V_before, apart = X_s, zero, _apart(inbox, X_s)
            share = self.ramp.step(share, dt, join=joins)
        place = self.mapping.place
        seen = self.settling.step(seen, walls, place(X_sd), place(X_s), dt)
        F_s = self.force.force(Motion(X_sd, V_before, X_s, V_s, *seen))
        if share == 1.0:
            port, V_sd, packet = self.port.answer(port, inbox, F_s, X_sd, running)
            if self.correction is not None and inbox.position is not None:
                goal = inbox.position if apart is None else inbox.position - apart
                port, tank, v_c = self._correct(self.correction, port, tank, F_s, goal - X_sd)
                V_sd = V_sd + v_c
        else:
            port, V_sd, packet = self._partly(state, inbox, share, F_s, X_sd)
        if not kernels.advance_if_finite(X_sd, V_sd, dt, X_s, packet.wave, X_next):
            return self._rest(state, X_s, inbox)
        target = self.mapping.place(X_next)
        signals = FollowerSignals(X_sd, V_sd, X_s, F_s, target, port.wave, inbox.fault)
        after = FollowerState(X_next, V_sd, X_s, port, tank, share, running, apart, seen)
        return after, signals, packet

    def _correct(
        self,
        correction: DriftCorrection,
        port: PortMemory,
        tank: float,
        F_s: Array,
        offset: Array,
    ) -> tuple[PortMemory, float, Array]:
        """Port and tank after a tick, and v_c (A,) [m/s] towards an offset (A,) [m]."""
        lost = self.scheme.follower_loss(F_s, port.wave)
        spare = 0.0 if self.control is None else self.port.spare(port)
        tank, spent, v_c = correction.step(tank, lost, F_s, offset, self.scheme.dt, spare=spare)
        return self.port.spend(port, spent) if spent > 0.0 else port, tank, v_c

    def _partly(
        self, state: FollowerState, inbox: Inbox, share: float, F_s: Array, X_sd: Array
    ) -> tuple[PortMemory, Array, Packet]:
        """Port, desired velocity and packet of an end that takes part by a share."""
        if share == 0.0:
            port, packet = self.port.asleep(state.port, inbox, X_sd, state.running)
            return port, self._zero, packet
        port, V, packet = self.port.answer(state.port, inbox, share * F_s, X_sd, state.running)
        return port, share * V, packet

    def _rest(
        self, state: FollowerState, X_s: Array, inbox: Inbox
    ) -> tuple[FollowerState, FollowerSignals, Packet]:
        zero, X_sd = self._zero, state.X_sd
        what = "virtual force" if np.all(np.isfinite(X_s)) else "measured tip"
        port, packet = self.port.idle(state.port, inbox, X_sd, state.running)
        target, fault = self.mapping.place(X_sd), f"holding still: the {what} is not finite"
        signals = FollowerSignals(X_sd, zero, X_s, zero, target, zero, fault)
        return state._replace(V_sd=zero, X_s=None, port=port), signals, packet


def _apart(inbox: Inbox, X_sd: Array) -> Array | None:
    """How far the leader is from a desired point that is where it should be (A,) [m]."""
    return None if inbox.position is None else inbox.position - X_sd
