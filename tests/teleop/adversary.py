"""Who takes out of a channel whatever there is to take: a hand and a follower in league.

Two kinds: robbers who take what they see, and conspirators who know beforehand what the links will
do, which without passivity control is a question of eigenvectors.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.analysis.ports import Channel, drive_over
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import LinkModel
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.ports import FollowerPort, LeaderPort
from sinuous.teleop.position_force import PositionForce
from sinuous.teleop.receivers import Receiver
from sinuous.teleop.scheme import Scheme
from sinuous.teleop.waves import ModifiedWaves, StandardWaves

from .rigs import DT, B

SCHEMES: dict[str, Scheme] = {
    "standard": StandardWaves(),
    "C1": ModifiedWaves.c1(),
    "C2": ModifiedWaves.c2(),
    "position-force": PositionForce(),
}
PUSHED, TAKEN = 40, 60  # ticks in which energy is put in, and taken out, in turns


class Ports(NamedTuple):
    """Both of them."""

    leader: LeaderPort
    follower: FollowerPort


def ports(
    scheme: Scheme,
    receiver: Receiver,
    control: PassivityControl | None,
    limits: Limits | None = None,
) -> Ports:
    """Both ports with the same parts."""
    parts = {"scheme": scheme, "receiver": receiver, "control": control, "limits": limits}
    return Ports(LeaderPort(**parts), FollowerPort(**parts))  # type: ignore[arg-type]


def robbed(
    pair: Ports,
    forward: LinkModel,
    backward: LinkModel,
    *,
    seed: int = 0,
    ticks: int = 400,
    axes: int = 1,
) -> Array:
    """Energy [J] (K,) that a channel has taken in, tick by tick, in the hands of robbers.

    In turns they put energy in, at random, and take out what they can. A port whose answer is
    F_r + D v gives most to v = - F_r / 2D, one whose answer is (g_r - F) / b to F = g_r / 2. What
    F_r and g_r are they know from the tick before.
    """
    rng = np.random.default_rng(seed)
    channel = Channel(*pair, forward, backward, axes)
    scheme = pair.leader.scheme
    damping, b = max(scheme.damping, 1e-3), scheme.force_gain / scheme.speed_gain
    v, force, energy = np.zeros(axes), np.zeros(axes), np.zeros(ticks)
    felt, moved = np.zeros(axes), np.zeros(axes)
    for k in range(ticks):
        if k % (PUSHED + TAKEN) < PUSHED:
            if k % (PUSHED + TAKEN) == 0:
                v, force = 0.2 * rng.normal(size=axes), rng.normal(size=axes)
        else:
            v = -0.5 * (felt - damping * v) / damping
            force = 0.5 * (b * moved + force)
        felt, moved, _, _ = channel.step(v, force)
        energy[k] = DT * float(felt @ v - force @ moved)
    return np.cumsum(energy)


class Signals(NamedTuple):
    """At both ends (K, 1), with an effort of 1 J, and the energy that goes in by theory [J]."""

    v: Array
    F_s: Array
    energy: float


def conspired(pair: Ports, forward: LinkModel, backward: LinkModel, ticks: int) -> Signals:
    """What takes most energy out, by effort, over ports without control.

    For one realisation of the links, ports without control are linear. Every tick of v and of F_s
    gets an axis of its own, on which it is an impulse; the energy of all is a quadratic form, and
    its least eigenvalue with an effort of b v^2 / 2 + F_s^2 / 2b per second that of the worst.
    """
    pulses, none = np.eye(ticks), np.zeros((ticks, ticks))
    v = np.hstack([pulses, none]) / np.sqrt(0.5 * DT * B)
    F_s = np.hstack([none, pulses]) / np.sqrt(0.5 * DT / B)
    got = drive_over(*pair, forward, backward, v, F_s)
    form = DT * (v.T @ got.F_m - F_s.T @ got.v_sd)
    values, vectors = np.linalg.eigh(0.5 * (form + form.T))
    worst = vectors[:, :1]
    return Signals(v @ worst, F_s @ worst, float(values[0]))
