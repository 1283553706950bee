"""Teleoperations for tests: the paper's numbers, and a follower that lags behind its target."""

from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.bilateral import Bilateral, BilateralState, Signals
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.ends import FollowerEnd, LeaderEnd
from sinuous.teleop.force import ErrorForce, Together, VirtualForce
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.ledger import Ledger
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.operators import Operator
from sinuous.teleop.waves import ModifiedWaves, Scheme

DT = 1e-3  # [s]
DELAY, TICKS = 0.2, 200
B, CUTOFF = 10.0, 20.0  # [N s/m], [rad/s]
BOUNDARY = 0.18  # [m]
PLANE = Mapping.plane(2.25, y0=0.6)
FREE = ErrorForce()
WALLED = Together((FREE, BoxForce(low=(-BOUNDARY, -BOUNDARY), high=(BOUNDARY, BOUNDARY))))
C1, C2 = ModifiedWaves.c1(), ModifiedWaves.c2()
LAG = 0.05  # of the follower [s]
STILL = 1e-9  # [m/s]: a source of motion leaves rounding where it stands


def smooth(share: float) -> float:
    """From 0 to 1 with speed and acceleration zero at both ends."""
    s = min(max(share, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


def to_and_hold(place: Array, duration: float = 2.0) -> Callable[[float], Array]:
    """A goal that moves smoothly from zero to a place and stays there."""
    return lambda t: smooth(t / duration) * place


def wave_about(size: float = 0.06) -> Callable[[float], Array]:
    """A goal that wanders on both axes, from zero and from rest."""
    return lambda t: size * smooth(t) * np.array([np.sin(1.3 * t), np.sin(0.9 * t + 1.0)])


def rig(
    operator: Operator[Any],
    *,
    scheme: Scheme = C2,
    force: VirtualForce = WALLED,
    mapping: Mapping = PLANE,
    delay: float = DELAY,
    correction: DriftCorrection | None = None,
) -> Bilateral[Any]:
    """A teleoperation with the paper's numbers."""
    link = ConstantDelay(delay=delay, dt=DT)
    return Bilateral(
        leader=LeaderEnd(scheme=scheme, mapping=mapping, operator=operator, device=LeaderDevice()),
        follower=FollowerEnd(scheme=scheme, mapping=mapping, force=force, correction=correction),
        forward=link,
        backward=link,
    )


class Run(NamedTuple):
    """Signals over time (K,), (K, A), and what was seen of energy."""

    time: Array
    x: Array
    V: Array
    F_h: Array
    F_m: Array
    X: Array
    X_sd: Array
    V_sd: Array
    X_s: Array
    F_s: Array
    ledger: Ledger
    state: BilateralState[Any]


def run(
    teleop: Bilateral[Any],
    duration: float,
    *,
    start: Array | None = None,
    disturb: Callable[[int, BilateralState[Any]], BilateralState[Any]] = lambda _, s: s,
) -> Run:
    """Teleoperate a point with a first-order lag.

    Arguments:
        start: of the point on the wave side (A,) [m]
        disturb: what else happens to the state before a tick
    """
    mapping, ledger = teleop.follower.mapping, Ledger(DT)
    tip = mapping.place(np.zeros(mapping.scale.size) if start is None else start)
    state, seen = teleop.init(tip), list[Signals]()
    for k in range(round(duration / DT)):
        state, signals = teleop.step(disturb(k, state), tip)
        tip = tip + DT / LAG * (signals.follower.target_w - tip)
        ledger.observe(signals)
        seen.append(signals)
    leader, follower = [s.leader for s in seen], [s.follower for s in seen]
    return Run(
        time=np.array([s.time for s in seen]),
        x=np.array([s.x for s in leader]),
        V=np.array([s.V for s in leader]),
        F_h=np.array([s.F_h for s in leader]),
        F_m=np.array([s.F_m for s in leader]),
        X=np.array([s.X for s in leader]),
        X_sd=np.array([s.X_sd for s in follower]),
        V_sd=np.array([s.V_sd for s in follower]),
        X_s=np.array([s.X_s for s in follower]),
        F_s=np.array([s.F_s for s in follower]),
        ledger=ledger,
        state=state,
    )
