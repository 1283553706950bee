"""What b and K cost: distortion of the velocity against error of the force (section 3.3)."""

from dataclasses import dataclass, field
from typing import Any, NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop.bilateral import Bilateral, Signals
from sinuous.teleop.ends import FollowerEnd, LeaderEnd
from sinuous.teleop.force import VirtualForce
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.operators import Operator
from sinuous.teleop.waves import ModifiedWaves

# A leader slower than that stands still [m/s]; a source of motion leaves rounding.
STILL = 1e-9


def follow(teleop: Bilateral[Any], *, lag: float, duration: float) -> list[Signals]:
    """Teleoperate a point that follows its target with a first-order lag, from the origin.

    Arguments:
        teleop: both ends and the connection
        lag: time constant of the point [s], of a tick or more
        duration: [s]
    """
    tip, signals = teleop.follower.mapping.origin, list[Signals]()
    state = teleop.init(tip)
    for _ in range(round(duration / teleop.dt)):
        state, now = teleop.step(state, tip)
        tip = tip + teleop.dt / lag * (now.follower.target_w - tip)
        signals.append(now)
    return signals


class Fidelity(NamedTuple):
    """How far from the ideal a run was, root mean squares.

    Arguments:
        velocity: V_sd less the filtered V_m of one delay before (20) [m/s]
        force: F_m less F_s of one delay before (21) [N]
        waiting: the same, of the ticks in which the leader stands still [N]; nan without any
    """

    velocity: float
    force: float
    waiting: float


def fidelity(signals: list[Signals], scheme: ModifiedWaves, ticks: int) -> Fidelity:
    """How far from the ideal a run was.

    Arguments:
        signals: of every tick
        scheme: that was used
        ticks: of delay, one way
    """
    V = np.array([s.leader.V for s in signals])
    F_m = np.array([s.leader.F_m for s in signals])
    F_s = np.array([s.follower.F_s for s in signals])
    V_sd = np.array([s.follower.V_sd for s in signals])
    filtered, low = np.empty_like(V), np.zeros(V.shape[1])
    for k, v in enumerate(V):
        low = low + scheme.share * (v - low)
        filtered[k] = low
    distortion = V_sd - _late(filtered, ticks)
    error = np.sum((F_m - _late(F_s, ticks)) ** 2, axis=1)
    still = np.all(np.abs(V) < STILL, axis=1) & (np.arange(len(V)) > ticks)
    return Fidelity(
        velocity=float(np.sqrt(np.mean(np.sum(distortion**2, axis=1)))),
        force=float(np.sqrt(np.mean(error))),
        waiting=float(np.sqrt(np.mean(error[still]))) if np.any(still) else np.nan,
    )


def _late(signal: Array, ticks: int) -> Array:
    """A signal (K, A) some ticks later, zero before."""
    late = np.zeros_like(signal)
    late[ticks:] = signal[:-ticks]
    return late


@dataclass(frozen=True, kw_only=True, eq=False)
class Task:
    """What is done at every point of a sweep.

    Arguments:
        operator: who holds the leader; a source of motion shows what b and K alone do
        force: what the follower feels
        mapping: of workspaces
        cutoff: lambda [rad/s]
        delay: one way [s]
        lag: of the follower [s]
        duration: [s]
        dt: time of a tick [s]
    """

    operator: Operator[Any]
    force: VirtualForce
    mapping: Mapping
    cutoff: float = 20.0
    delay: float = 0.2
    lag: float = 0.05
    duration: float = 20.0
    dt: float = 1e-3
    device: LeaderDevice = field(default_factory=LeaderDevice)

    def run(self, impedance: float, gain: float) -> Fidelity:
        """Do it with b [N s/m] and K."""
        scheme = ModifiedWaves(impedance=impedance, gain=gain, cutoff=self.cutoff, dt=self.dt)
        link = ConstantDelay(delay=self.delay, dt=self.dt)
        leader = LeaderEnd(
            scheme=scheme, mapping=self.mapping, operator=self.operator, device=self.device
        )
        follower = FollowerEnd(scheme=scheme, mapping=self.mapping, force=self.force)
        teleop = Bilateral(leader=leader, follower=follower, forward=link, backward=link)
        signals = follow(teleop, lag=self.lag, duration=self.duration)
        return fidelity(signals, scheme, link.ticks)


class TradeOff(NamedTuple):
    """What was measured over a grid (B, K), as in `Fidelity`."""

    velocity: Array
    force: Array
    waiting: Array


def sweep(task: Task, *, impedances: ArrayLike, gains: ArrayLike) -> TradeOff:
    """Do a task with every b [N s/m] (B,) and K (K,)."""
    b, K = np.atleast_1d(np.asarray(impedances)), np.atleast_1d(np.asarray(gains))
    found = np.array([[task.run(float(i), float(g)) for g in K] for i in b])
    return TradeOff(*np.moveaxis(found, -1, 0))
