"""The ports themselves, driven by given signals at both ends."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.analysis.hybrid import dissipation, hybrid_matrix
from sinuous.teleop.link import ConstantDelay, Packet
from sinuous.teleop.waves import Scheme


class PortRun(NamedTuple):
    """What the ports answer, tick by tick (K, A).

    Arguments:
        F_m: force on the leader [N]
        v_sd: desired velocity of the follower [m/s]
        at_leader, at_follower: waves received; zero before the first
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
    ticks, axes = v.shape
    out, zero = PortRun(*(np.zeros((ticks, axes)) for _ in PortRun._fields)), np.zeros(axes)
    model = ConstantDelay(delay=delay, dt=scheme.dt)
    forward, backward = model.open(), model.open()
    leader, follower = scheme.leader_init(axes), scheme.follower_init(axes)
    for k in range(ticks):
        leader, out.F_m[k], ahead = scheme.leader_step(leader, v[k], out.at_leader[k])
        follower, out.v_sd[k], back = scheme.follower_step(follower, F_s[k], out.at_follower[k])
        to_follower, to_leader = (
            forward.step(Packet(ahead, zero)),
            backward.step(Packet(back, zero)),
        )
        if to_follower is not None and to_leader is not None and k + 1 < ticks:
            out.at_follower[k + 1], out.at_leader[k + 1] = to_follower.wave, to_leader.wave
    return out


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
