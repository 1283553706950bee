"""3.2: the signs and units of the virtual force as printed, and ours (notes A7, A8, A9).

Two followers: a point that follows its desired place with a lag, for which nothing is bounded, and
the robot's whole chain, in which the arm's length bounds what it can do.
"""

from collections.abc import Callable
from dataclasses import dataclass, fields, replace
from functools import partial
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.papers.experiment import Data, Experiment
from sinuous.papers.qin2020.rigs import HIGH, LOW, point_follower, push, resistive
from sinuous.papers.qin2020.runs import BOUNDARY, DELAY, inverse
from sinuous.papers.qin2020.sets.experiment import CONTACT, IMPEDANCE, chain
from sinuous.papers.qin2020.sets.signals import Signals
from sinuous.papers.qin2020.signs.figures import OURS, PRINTED, draw
from sinuous.papers.workers import Workers
from sinuous.scenario import Scenario
from sinuous.scenario.teleop import Teleoperation
from sinuous.session import run as run_session
from sinuous.teleop.analysis.tradeoff import follow
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.force import ErrorForce, Motion, VirtualForce
from sinuous.teleop.operators import Goal, ImpedanceOperator
from sinuous.teleop.printed import PrintedForce
from sinuous.teleop.waves import ModifiedWaves

FORCES: dict[str, Callable[[], VirtualForce]] = {
    PRINTED: partial(PrintedForce, low=LOW, high=HIGH),
    OURS: resistive,
}
SIDES = {"upper": 1.0, "lower": -1.0}

PUSH = 0.22  # how far the hand goes on the follower's side [m]
LAG = 0.2  # of the point, that of the printed K_P [s]
POINT_TIME, QUICK_POINT_TIME = 20.0, 6.0  # [s]
CHAIN_TIME, QUICK_CHAIN_TIME = 9.0, 4.0  # [s]
STRIDE = 20  # ticks between the points that are kept
PER_CM = 100.0  # c_b read per centimetre like k_b [N s/m]
HOLD = (4.5, 6.5)  # a time of Set 2 in which the hand holds still [s]

ERROR = 0.04  # largest tracking error at which F_e is looked at [m]
SPEED = 0.1  # into the wall, at which dampers are compared [m/s]
Z = 1  # the axis along which the wall is pushed


def run(workers: Workers, quick: bool) -> Data:
    """Both readings at both sides, with both followers; and the damper by itself."""
    point = QUICK_POINT_TIME if quick else POINT_TIME
    whole = QUICK_CHAIN_TIME if quick else CHAIN_TIME
    damping = HOLD[1] if quick else CHAIN_TIME
    cases = [(force, side) for force in FORCES for side in SIDES]
    return {
        "boundary_m": BOUNDARY,
        "lag_s": LAG,
        "speed_m_s": SPEED,
        "point": workers.map("signs: a point", push_point, [(*case, point) for case in cases]),
        "chain": workers.map("signs: the arm", push_arm, [(*case, whole) for case in cases]),
        "error": _error_force(),
        "damper": [_damper(name, side) for name in (*FORCES, "scalar") for side in SIDES],
        "damping": workers.map(
            "signs: the damper", push_damper, [(value, damping) for value in (1.0, PER_CM)]
        ),
    }


def push_point(item: tuple[str, str, float]) -> dict[str, Any]:
    """A hand pushes a point against one side of the boundary, along z."""
    name, side, duration = item
    way = [0.0, SIDES[side] * PUSH]
    hand = ImpedanceOperator(push(way, after=0.5, lasting=3.0))
    teleop = point_follower(ModifiedWaves.c2(), hand, FORCES[name]())
    signals = follow(teleop, lag=LAG, duration=duration)
    z = np.array([one.follower.X_s[Z] for one in signals])
    force = np.array([one.follower.F_s[Z] for one in signals])
    return {"force": name, "side": side, **_growth(z, force, teleop.dt)}


def _growth(z: Array, force: Array, dt: float) -> dict[str, Any]:
    """How far it goes: a place (K,) [m] and a force (K,) [N] over time."""
    beyond = np.flatnonzero(np.abs(z) > 1.0)
    return {
        "farthest_m": float(np.max(np.abs(z))),
        "last_m": float(z[-1]),
        "beyond_a_metre_s": float(beyond[0] * dt) if len(beyond) else None,
        "largest_force_n": float(np.max(np.abs(force))),
        "period_s": STRIDE * dt,
        "z_m": z[::STRIDE].tolist(),
    }


@dataclass(frozen=True, kw_only=True, eq=False)
class Replaced(Teleoperation):
    """A teleoperation with another force than its scenario says.

    Arguments:
        force: in its place
    """

    force: VirtualForce

    @classmethod
    def of(cls, scenario: Scenario, force: VirtualForce) -> Scenario:
        """A scenario with this force."""
        before = scenario.teleop
        assert before is not None
        same = {one.name: getattr(before, one.name) for one in fields(before)}
        return replace(scenario, teleop=cls(**same, force=force))

    def bilateral(self, goal: Goal, stops: Any) -> Bilateral[Any]:
        """Both ends, the follower's with the other force."""
        teleop = super().bilateral(goal, stops)
        return replace(teleop, follower=replace(teleop.follower, force=self.force))


def mirrored(scenario: Scenario) -> Scenario:
    """A scenario with z turned round."""
    (leg,) = scenario.path

    def target(time: float) -> Array:
        return leg.at(time) * (1.0, 1.0, -1.0)

    start = inverse().solve_one(target(0.0)).c
    return replace(scenario, path=(replace(leg, target=target),), start=start)


def push_arm(item: tuple[str, str, float]) -> dict[str, Any]:
    """The beginning of Set 2 with the whole chain, at its first side or the one across."""
    name, side, duration = item
    base = chain(CONTACT, "C2", IMPEDANCE, seconds=duration)
    base = base if side == "upper" else mirrored(base)
    recording = run_session(Replaced.of(base, FORCES[name]())).recording
    signals = Signals.of(recording, DELAY)
    desired = signals.X_sd[:, Z]
    return {
        "force": name,
        "side": side,
        **_growth(signals.X_s[:, Z], signals.F_s[:, Z], signals.dt),
        "desired_farthest_m": float(np.max(np.abs(desired))),
        "desired_last_m": float(desired[-1]),
        "desired_m": desired[::STRIDE].tolist(),
        "leader_last_m": float(signals.X[-1, Z]),
        "least_follower_j": float(np.min(recording.signal("follower_j"))),
    }


def push_damper(item: tuple[float, float]) -> dict[str, Any]:
    """The first contact of Set 2 with a damper c_b [N s/m], the hand at rest for a while."""
    damping, duration = item
    base = chain(CONTACT, "C2", IMPEDANCE, f"teleop.force.damping_n_s_m={damping}",
                 seconds=duration)  # fmt: skip
    recording = run_session(base).recording
    signals = Signals.of(recording, DELAY)
    first, last = (round(time / signals.dt) for time in HOLD)
    force = signals.F_s[:, Z]
    return {
        "damping_n_s_m": damping,
        "largest_force_n": float(np.max(np.abs(force))),
        "swing_at_rest_n": float(np.ptp(force[first:last])),
        "least_follower_j": float(np.min(recording.signal("follower_j"))),
        "period_s": signals.dt,
        "force_n": force.round(4).tolist(),
    }


def _error_force() -> dict[str, Any]:
    """F_e of (24) over the tracking error, and with the error in metres as printed [N]."""
    error = np.linspace(-ERROR, ERROR, 81)
    force, unscaled = (
        [_error(ErrorForce(length=length), float(one)) for one in error]
        for length in (ErrorForce.length, 1.0)
    )
    return {
        "error_m": error.tolist(),
        "force_n": force,
        "length_m": ErrorForce.length,
        "gain_n": ErrorForce.gain,
        "unscaled_n": unscaled,
    }


def _error(force: ErrorForce, error: float) -> float:
    zero = np.zeros(2)
    return float(force.force(Motion(np.array([0.0, error]), zero, zero, zero))[Z])


def _damper(name: str, side: str) -> dict[str, Any]:
    """F_b at a side of the boundary, moving into the wall, less its spring [N].

    `scalar` is c_b (v . N) as printed, a number, with the sign that makes the upper side resist.
    """
    outward = SIDES[side]
    X = np.array([0.0, outward * BOUNDARY])
    V = np.array([0.0, outward * SPEED])
    motion = Motion(X, V, X, V)
    box = BoxForce(low=LOW, high=HIGH)
    if name == "scalar":
        force = box.damping * float(V @ np.array([0.0, -outward])) * -1.0
    else:
        force = float(FORCES[name]().force(motion)[Z])
    return {"force": name, "side": side, "force_n": force, "resists": force * outward > 0.0}


SIGNS = Experiment(
    name="signs",
    title="Signs and units of the virtual force",
    section="3.2",
    run=run,
    draw=draw,
)
