"""The motion that takes most energy out of a connection: an eigenvector, not luck.

Without passivity control a port uses the last wave it has. For a given realisation of both links,
ports, links and a linear follower are a linear map then, though one that changes from tick to
tick, and the energy that the channel takes in is a quadratic form of what is done to it,

    E = sum over ticks of dt (F_m . v - F_s . v_sd) = c' H c   for v = sum_i c_i phi_i(t),

with the least value, for a given effort c' G c, at the least eigenvalue of H c = lambda G c.

Axes do not act on each other in the ports: every function phi_i is given an axis of its own, and
one run of the ports themselves yields all columns of H. Nothing is modelled twice.
"""

from typing import NamedTuple, Protocol, Self

import numpy as np
import scipy.linalg

from sinuous.arrays import Array, IntArray
from sinuous.teleop.link import Link, LinkModel, Packet
from sinuous.teleop.waves import Scheme

WIDTH = 4  # of a bump, a cubic B-spline, in knots


class Schedule(NamedTuple):
    """What both links made of what was sent: a realisation.

    Arguments:
        forward: tick in which the wave was sent that the follower's port uses (K,); -1: zero
        backward: likewise of the leader's port (K,)
    """

    forward: IntArray
    backward: IntArray

    @classmethod
    def of(cls, forward: LinkModel, backward: LinkModel, ticks: int) -> Self:
        """What links make of packets, for ports that use the newest of all."""
        return cls(_newest(forward.open(0), ticks), _newest(backward.open(1), ticks))


def _newest(link: Link, ticks: int) -> IntArray:
    numbers, newest, nothing = np.empty(ticks, dtype=np.int64), -1, np.zeros(1)
    for k in range(ticks):
        numbers[k] = newest
        arrived = link.step(Packet(nothing, nothing, number=k))
        newest = max(newest, *(packet.number for packet in arrived), -1)
    return numbers


class Answer(NamedTuple):
    """Both ends of the channel, tick by tick (K, A).

    Arguments:
        v: of the leader [m/s]
        F_m: that it feels [N]
        F_s: that opposes the follower [N]
        v_sd: that the follower should have [m/s]
    """

    v: Array
    F_m: Array
    F_s: Array
    v_sd: Array


class FarSide(Protocol):
    """What the follower's port works against."""

    def force(self, tick: int) -> Array:
        """F_s (A,) [N] in a tick."""
        ...

    def move(self, v_sd: Array) -> None:
        """Move with the desired velocity (A,) [m/s] for a tick."""
        ...


class GivenForce:
    """A force that does not care how the follower moves.

    Arguments:
        F_s: (K, A) [N]
    """

    def __init__(self, F_s: Array) -> None:
        self._F_s = F_s

    def force(self, tick: int) -> Array:
        """F_s (A,) [N] in a tick."""
        return self._F_s[tick]

    def move(self, v_sd: Array) -> None:
        """Nothing comes of it."""


class LaggingFollower:
    """A follower with a first-order lag, held by springs: what virtual forces are when small.

        F_s = k_e (X_sd - X_s) + k_b X_s,  X_s moves by share (X_sd - X_s) in a tick

    Arguments:
        axes: how many
        dt: time of a tick [s]
        share: of the way to the desired point that the follower goes in a tick
        pull: k_e, of the tracking error [N/m]
        wall: k_b, of the follower's own place [N/m]
    """

    def __init__(self, axes: int, dt: float, *, share: float, pull: float, wall: float) -> None:
        self._dt, self._share, self._pull, self._wall = dt, share, pull, wall
        self._X_sd, self._X_s = np.zeros(axes), np.zeros(axes)

    def force(self, tick: int) -> Array:
        """F_s (A,) [N] in a tick."""
        return self._pull * (self._X_sd - self._X_s) + self._wall * self._X_s

    def move(self, v_sd: Array) -> None:
        """Move with the desired velocity (A,) [m/s] for a tick."""
        self._X_sd = self._X_sd + self._dt * v_sd
        self._X_s = self._X_s + self._share * (self._X_sd - self._X_s)


def respond(scheme: Scheme, schedule: Schedule, v: Array, far: FarSide) -> Answer:
    """Both ports, each using the waves that the schedule says, without passivity control.

    Arguments:
        v: of the leader (K, A) [m/s]
    """
    ticks, axes = v.shape
    answer = Answer(v, *(np.empty((ticks, axes)) for _ in range(3)))
    # The last row is of no tick, and zero: what a tick of -1 says.
    ahead, back = np.zeros((2, ticks + 1, axes))
    leader, follower = scheme.leader_init(axes), scheme.follower_init(axes)
    for k in range(ticks):
        forward, backward = schedule.forward[k], schedule.backward[k]
        leader, answer.F_m[k], ahead[k] = scheme.leader_step(leader, v[k], back[backward])
        answer.F_s[k] = far.force(k)
        follower, answer.v_sd[k], back[k] = scheme.follower_step(
            follower, answer.F_s[k], ahead[forward]
        )
        far.move(answer.v_sd[k])
    return answer


def energy_form(answer: Answer, dt: float) -> Array:
    """H (A, A) [J] of the channel's energy, symmetric, for amounts of what each axis does."""
    half = dt * (answer.v.T @ answer.F_m - answer.F_s.T @ answer.v_sd)
    return 0.5 * (half + half.T)


class Basis(NamedTuple):
    """Motions that others are made of.

    Arguments:
        x: places at the beginning of every tick, and at the end of the last (K + 1, n) [m]
        v: velocities (K, n) [m/s]
    """

    x: Array
    v: Array

    @classmethod
    def bumps(cls, ticks: int, dt: float, knot: float) -> Self:
        """Smooth bumps (cubic B-splines) one after the other, at rest at both ends.

        Arguments:
            ticks: K
            dt: time of a tick [s]
            knot: from one bump to the next, a quarter of the length of one [s]

        Raises:
            ValueError: if there is no room for a bump
        """
        time = dt * np.arange(ticks + 1)
        count = int(time[-1] / knot + 1e-9) - WIDTH + 1
        if count < 1:
            raise ValueError(f"{time[-1]} s have no room for a bump of {WIDTH} x {knot} s")
        off = np.abs(time[:, None] / knot - 0.5 * WIDTH - np.arange(count))
        inside = 2.0 / 3.0 - off**2 + 0.5 * off**3
        x = np.where(off < 1.0, inside, np.maximum(2.0 - off, 0.0) ** 3 / 6.0)
        return cls(x, np.diff(x, axis=0) / dt)


class HandLimits(NamedTuple):
    """Of a hand.

    Arguments:
        speed: [m/s]
        reach: to either side [m]
    """

    speed: float
    reach: float

    def scale(self, x: Array, v: Array) -> float:
        """How many times a motion fits in."""
        return float(min(self.speed / np.max(np.abs(v)), self.reach / np.max(np.abs(x))))


class Extraction(NamedTuple):
    """What takes most, the worst first.

    Arguments:
        rates: lambda (J,), energy that the channel takes in by effort; negative where it gives
        amounts: of every function of the basis (J, n)
    """

    rates: Array
    amounts: Array


def worst_motions(
    scheme: Scheme,
    schedule: Schedule,
    basis: Basis,
    far: LaggingFollower,
    limits: HandLimits,
    count: int = 1,
) -> Extraction:
    """Motions of the leader against that follower.

    Effort is the integral of (v / speed)^2 + (x / reach)^2 [s], so that a rate is a power [W].

    Arguments:
        far: with as many axes as the basis has functions
        count: J
    """
    answer, (x, v) = respond(scheme, schedule, basis.v, far), basis
    effort = scheme.dt * (v.T @ v / limits.speed**2 + x.T @ x / limits.reach**2)
    return _least(energy_form(answer, scheme.dt), effort, count)


def worst_pairs(
    scheme: Scheme, schedule: Schedule, basis: Basis, impedance: float, count: int = 1
) -> Extraction:
    """Motions of the leader and forces on the follower that conspire against the channel.

    Effort is the integral of b v^2 / 2 + F_s^2 / 2b [J], so that a rate is a share; the first half
    of the amounts are of velocities phi, the other of forces b phi [N].

    Arguments:
        impedance: b [N s/m]
        count: J
    """
    none, forces = np.zeros_like(basis.v), impedance * basis.v
    v, F_s = np.hstack([basis.v, none]), np.hstack([none, forces])
    answer = respond(scheme, schedule, v, GivenForce(F_s))
    effort = 0.5 * scheme.dt * (impedance * v.T @ v + F_s.T @ F_s / impedance)
    return _least(energy_form(answer, scheme.dt), effort, count)


def _least(form: Array, effort: Array, count: int) -> Extraction:
    rates, vectors = scipy.linalg.eigh(form, effort, subset_by_index=(0, count - 1))
    return Extraction(rates, vectors.T)
