"""Passivity control: a port gives out no more energy than the other end says to have put in.

Each port adds up two energies: what it has *sent*, which never falls, and what it has *used* of
the other's. Every packet carries all that its sender has sent so far. A port hears of it in
whatever order, and keeps to

    used <= the largest sum that it has heard of.                                             (1)

What `sent` and `used` are is the scheme's to say, such that the port takes at least the
difference in at its mechanical side (force times displacement over the tick):

    sum of F_m . v_m dt >= sent_m - used_m,    sum of -F_s . v_sd dt >= sent_s - used_s.      (2)

*The channel is then passive on any link.* What was heard of had been sent before, and sums of
energy sent only grow, so that (1) means used_s <= sent_m and used_m <= sent_s at any time. Adding
(2), the energy that the channel has taken in is

    E >= (sent_m - used_s) + (sent_s - used_m) >= 0.

Nothing is said about the link: a packet that is lost, doubled, overtaken or as late as may be only
lowers or delays what is heard of. Nor about what a port does with the packets: it may hold, blend
or limit waves as it likes, while (1) holds. A port reads its own samples and its packets only.

*Waves.* A wave whose square makes up the power terms of notes A11, |g_r|^2 / 2b and alike, has the
energy K^2 |wave|^2 dt / 2b in a tick; of standard waves it is |wave|^2 dt / 2. `sent` is the sum
of waves sent, `used` the sum of waves used. (2) is the identity of A11 without the terms of loss,
which are zero or more for K >= 1/2 and a low-pass with lambda dt <= 1; of standard waves it is
their definition. A wave too large for (1) is scaled down to the energy left. On a link of constant
delay each sum heard of is what the waves up to that packet need, to the last digit: no wave is
touched, and the control costs nothing.

*Velocity and force* have the classical sums: `sent` of the power that goes in, `used` of that which
comes out; see `position_force`.

*What comes on top keeps to (2).* `Limits` bound the wave before it is used, and what is used is
what counts. `Ramp` lets an end join by a transformer, with the same power on both sides. A port
that pauses or rests uses nothing and sends nothing. `DriftCorrection` pays for what it takes with
what the port has dissipated, which (2) leaves out, or counts it as used.

*A loan.* A leader's port may start with its `used` below zero by a fixed sum, once and for all: E
then never falls below minus this sum, as that of a store that was full at the start.

But for a loan the ledger sees zero rather than -F_max v_max dt, one tick of the largest power,
because neither port waits for what a tick has taken: the follower's knows force and velocity before
the tick, and the leader's answers with a law of force and velocity that holds to (1) whatever the
velocity of the tick will be.

Sources: Niemeyer and Slotine, Telemanipulation with time delays, Int. J. Robotics Research 23
(2004); Ryu, Artigas and Preusche, A passive bilateral control scheme for a teleoperator with
time-varying communication delay, Mechatronics 20 (2010).
"""

from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import energy_kernels, kernels
from sinuous.teleop.checks import not_negative


class Flow(NamedTuple):
    """Energy of a tick, both zero or more [J].

    Arguments:
        sent: into the channel
        used: of what the other end has sent
    """

    sent: float
    used: float


def spare(heard: float, used: float) -> float:
    """Energy that the other end has sent and nobody used [J]."""
    return heard - used if heard > used else 0.0


def sent_after(sent: float, flow: Flow, returned: float) -> float:
    """What a port has sent after a tick, with what it returned [J]."""
    return sent + flow.sent + returned


def used_after(used: float, flow: Flow, surplus: float) -> float:
    """What a port has used after a tick, with what it did not keep [J]."""
    return used + flow.used + surplus


def wave_energy(factor: float, wave: Array) -> float:
    """Of a wave that is sent or used for a tick [J]."""
    return energy_kernels.wave_energy(factor, wave)


def limited_wave(factor: float, wave: Array, heard: float, used: float) -> Array:
    """A wave as it is, or scaled down to the energy left."""
    out = np.empty(wave.size)
    energy_kernels.limit_wave(factor, wave, heard, used, out)
    return out


def work_in(force: Array, v: Array, dt: float) -> float:
    """Energy that goes in, of a velocity v [m/s] against a force [N]; zero if it comes out [J]."""
    return max(kernels.work(force, v) * dt, 0.0)


def work_out(force: Array, v: Array, dt: float) -> float:
    """Energy that comes out; zero if it goes in [J]."""
    return max(-kernels.work(force, v) * dt, 0.0)


@dataclass(frozen=True, kw_only=True)
class PassivityControl:
    """Keeps both ports to (1), and energy that is left over within bounds.

    What loss has left over may pay for holding a wave or for the correction of drift, but not any
    amount at once and not at any later time. What is above the capacity the leader gives up, and
    the follower returns: its `used` and its `sent` grow by the same, which leaves (2) as it is.

    Arguments:
        capacity: energy left over that is kept at either end, at most [J]

    Raises:
        ValueError: if it is negative
    """

    capacity: float = 0.005

    def __post_init__(self) -> None:
        not_negative("capacity", self.capacity)

    def surplus(self, heard: float, used: float, flow: Flow) -> float:
        """Energy left over after a tick that is not kept [J]."""
        return max(heard - used - flow.used - self.capacity, 0.0)


class WaveEnergy:
    """What schemes of waves say of energy: each wave has its own, whatever the port does.

    Their force does not yield: what a port uses of a wave is known before the hand moves.
    """

    yields = False
    loan = 0.0

    @cached_property
    def wave_factor(self) -> float:
        """Energy of a wave by its square, in a tick [J]."""
        raise NotImplementedError

    def leader_use(self, received: Array, heard: float, used: float) -> Array:
        """The wave that the leader's port may use (A,)."""
        return limited_wave(self.wave_factor, received, heard, used)

    def leader_flow(self, v: Array, force: Array, received: Array, sent: Array) -> Flow:
        """Energy of a tick of the leader's port."""
        return Flow(wave_energy(self.wave_factor, sent), wave_energy(self.wave_factor, received))

    def follower_use(self, force: Array, received: Array, heard: float, used: float) -> Array:
        """The wave that the follower's port may use (A,)."""
        return limited_wave(self.wave_factor, received, heard, used)

    def follower_flow(self, force: Array, desired: Array, received: Array, sent: Array) -> Flow:
        """Energy of a tick of the follower's port."""
        return Flow(wave_energy(self.wave_factor, sent), wave_energy(self.wave_factor, received))
