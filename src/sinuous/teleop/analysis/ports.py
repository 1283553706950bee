"""The ports themselves, driven by given signals at both ends."""

from math import inf
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.analysis.hybrid import dissipation, hybrid_matrix
from sinuous.teleop.link import ConstantDelay, LinkModel
from sinuous.teleop.ports import FollowerPort, LeaderPort
from sinuous.teleop.position_force import yielding
from sinuous.teleop.receivers import Packets
from sinuous.teleop.scheme import Scheme


class PortRun(NamedTuple):
    """What the ports answer, tick by tick (K, A).

    Arguments:
        F_m: force on the leader [N]
        v_sd: desired velocity of the follower [m/s]
        at_leader, at_follower: waves used; zero before the first
    """

    F_m: Array
    v_sd: Array
    at_leader: Array
    at_follower: Array


def drive_ports(scheme: Scheme, delay: float, v: Array, F_s: Array) -> PortRun:
    """Feed leader velocities [m/s] and follower forces [N] (K, A) to both ports.

    Arguments:
        scheme: of the waves
        delay: one way, the same both ways [s]
    """
    link = ConstantDelay(delay=delay, dt=scheme.dt)
    return drive_over(LeaderPort(scheme=scheme), FollowerPort(scheme=scheme), link, link, v, F_s)


def drive_over(
    leader: LeaderPort,
    follower: FollowerPort,
    forward: LinkModel,
    backward: LinkModel,
    v: Array,
    F_s: Array,
) -> PortRun:
    """Feed leader velocities [m/s] and follower forces [N] (K, A) to ports over any links."""
    channel = Channel(leader, follower, forward, backward, v.shape[1])
    ticks = [channel.step(*both) for both in zip(v, F_s, strict=True)]
    return PortRun(*(np.array(signal) for signal in zip(*ticks, strict=True)))


class Channel:
    """Both ports and the links between them, from tick to tick.

    Arguments:
        leader, follower: the ports
        forward, backward: what connects them
        axes: A
    """

    def __init__(
        self,
        leader: LeaderPort,
        follower: FollowerPort,
        forward: LinkModel,
        backward: LinkModel,
        axes: int,
    ) -> None:
        self._leader, self._follower = leader, follower
        self._forward, self._backward = forward.open(0), backward.open(1)
        self._at_leader, self._at_follower = leader.init(axes), follower.init(axes)
        self._to_leader: Packets = ()
        self._to_follower: Packets = ()
        self._place = np.zeros(axes)

    def step(self, v: Array, F_s: Array) -> tuple[Array, Array, Array, Array]:
        """What a `PortRun` has for a tick.

        Arguments:
            v: of the leader (A,) [m/s]
            F_s: on the follower (A,) [N]
        """
        leader, follower, nowhere = self._leader, self._follower, self._place
        inbox = leader.listen(self._at_leader, self._to_leader)
        wave, left = leader.use(self._at_leader, inbox)
        if left < inf:
            wave = yielding(wave, v, left, leader.scheme.dt)
        self._at_leader, F_m, ahead = leader.answer(
            self._at_leader, inbox, wave, v, nowhere, running=True
        )
        heard = follower.listen(self._at_follower, self._to_follower)
        self._at_follower, v_sd, back = follower.answer(
            self._at_follower, heard, F_s, nowhere, running=True
        )
        self._to_follower, self._to_leader = self._forward.step(ahead), self._backward.step(back)
        return F_m, v_sd, self._at_leader.wave, self._at_follower.wave


def channel_energy(run: PortRun, v: Array, F_s: Array, dt: float) -> Array:
    """Energy [J] (K,) that ports and links have taken in by the end of each tick of dt [s]."""
    return np.cumsum(np.sum(run.F_m * v - F_s * run.v_sd, axis=1)) * dt


class Sinusoid(NamedTuple):
    """Signals at both ends.

    Arguments:
        omega: [rad/s]
        v: complex amplitude of the leader's velocity [m/s]
        F_s: complex amplitude of the follower's force [N]
        power: that the channel takes in by theory, on average [W]
    """

    omega: float
    v: complex
    F_s: complex
    power: float

    def signals(self, duration: float, dt: float) -> tuple[Array, Array]:
        """v and F_s (K, 1) for a duration [s] in ticks of dt [s]."""
        turn = np.exp(1j * self.omega * dt * np.arange(round(duration / dt)))[:, None]
        return np.real(self.v * turn), np.real(self.F_s * turn)


def worst_sinusoid(
    omega: Array, *, gain: float, impedance: float, cutoff: float, delay: float
) -> Sinusoid:
    """The sinusoid that takes most out of the channel, by (31), its leader moving at 1 m/s.

    Of all frequencies [rad/s] (W,) and unit vectors (v_m, F_s) it is the eigenvector of H + H^H
    with the least eigenvalue. Random signals do not find it.
    """
    H = hybrid_matrix(omega, gain=gain, impedance=impedance, cutoff=cutoff, delay=delay)
    values, vectors = dissipation(H)
    at = int(np.argmin(values[:, 0]))
    v, F_s = vectors[at, :, 0]
    power = 0.25 * float(values[at, 0] / abs(v) ** 2)
    return Sinusoid(omega=float(omega[at]), v=1.0, F_s=complex(F_s / v), power=power)
