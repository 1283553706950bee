"""One run of a teleoperation, and what an observer who sees both ends says of it."""

from typing import Any, NamedTuple, Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.link_hand import SETTLED
from sinuous.bench.loop import no_garbage_collection
from sinuous.bench.result import Row
from sinuous.teleop.bilateral import Bilateral, Signals
from sinuous.teleop.ledger import Energies, Ledger

FAR = 1.0  # whatever goes that far is unbounded: the hand goes 0.03 m [m]
PARTS, GROWTH = 4, 1.05  # so is what grows by more than that from part to part of the time at rest,
TREMBLE = 1e-3  # and ends above that [m]
WATCH = 2.5  # what moves in so long a time is not at rest yet [s]
AT_THE_END = 0.1  # drift is averaged over that [s]


class Follower(Protocol):
    """Robot and controller."""

    def step(self, target_w: Array) -> Array:
        """Where the tip is (3,) [m] after a tick, given where it should be."""
        ...


class Trace(NamedTuple):
    """What was seen, tick by tick (K, A), on the wave side.

    Arguments:
        X, V, F_m: of the leader's end [m], [m/s], [N]
        X_sd, V_sd, F_s: of the follower's end [m], [m/s], [N]
        least: the smallest that each ledger has been [J]
        energy: of the channel's ledger after every tick (K,) [J]
        complete: whether it went on to its end, because nothing went too far
    """

    X: Array
    V: Array
    F_m: Array
    X_sd: Array
    V_sd: Array
    F_s: Array
    least: Energies
    energy: Array
    complete: bool


def drive(
    bilateral: Bilateral[Any],
    follower: Follower,
    tip_w: Array,
    duration: float,
    *,
    longest: float = 0.0,
    far: float = FAR,
) -> Trace:
    """Run both ends for a duration [s], or until something goes too far [m].

    Arguments:
        longest: for how long it goes on while something still moves [s]
    """
    state, ledger, seen = bilateral.init(tip_w), Ledger(bilateral.dt), list[Signals]()
    ticks, most, chunk = (round(t / bilateral.dt) for t in (duration, longest, WATCH))
    complete = True
    with no_garbage_collection():
        while complete and (len(seen) < ticks or (len(seen) < most and _moves(seen[-chunk:]))):
            for _ in range(min(chunk, ticks - len(seen)) if len(seen) < ticks else chunk):
                state, signals = bilateral.step(state, tip_w)
                tip_w = follower.step(signals.follower.target_w)
                ledger.observe(signals)
                seen.append(signals)
                complete = max(_size(signals.leader.X), _size(signals.follower.X_sd)) < far
                if not complete:
                    break
    near, away = [s.leader for s in seen], [s.follower for s in seen]
    return Trace(
        X=np.array([s.X for s in near]),
        V=np.array([s.V for s in near]),
        F_m=np.array([s.F_m for s in near]),
        X_sd=np.array([s.X_sd for s in away]),
        V_sd=np.array([s.V_sd for s in away]),
        F_s=np.array([s.F_s for s in away]),
        least=ledger.least,
        energy=ledger.history[:, 0],
        complete=complete,
    )


def judge(trace: Trace, dt: float, delay: float, duration: float) -> Row:
    """What a row says.

    Arguments:
        dt: time of a tick [s]
        delay: one way, on average [s]
        duration: for how long errors are looked at [s]; energy and motion are for all of it
    """
    late, last, end = max(round(delay / dt), 1), round(AT_THE_END / dt), round(duration / dt)
    X, X_sd, F_m, F_s = (x[:end] for x in (trace.X, trace.X_sd, trace.F_m, trace.F_s))
    tracking = X_sd[late:] - X[:-late]
    force = F_m[late:] - F_s[:-late]
    apart = np.linalg.norm(X_sd[-last:] - X[-last:], axis=1)
    return {
        "ledger_min_j": trace.least.channel,
        "unbounded": is_unbounded(trace, dt),
        "drift_m": float(np.mean(apart)),
        "tracking_rms_m": _rms(tracking),
        "force_rms_n": _rms(force),
        "peak_force_n": _rms(trace.F_m, most=True),
        "operator_min_j": trace.least.operator,
        "follower_min_j": trace.least.follower,
    }


def is_unbounded(trace: Trace, dt: float) -> bool:
    """Whether something went too far, or moves more and more while the hand is at rest."""
    if not trace.complete:
        return True
    rest = round(SETTLED / dt)
    if len(trace.X) < rest + PARTS:
        return False
    parts = np.array_split(np.hstack([trace.X[rest:], trace.X_sd[rest:]]), PARTS)
    swings = np.array([_swing(part) for part in parts])
    return swings[-1] > TREMBLE and bool(np.all(swings[1:] > GROWTH * swings[:-1]))


def _moves(last: list[Signals]) -> bool:
    """Whether either end has moved in the last ticks."""
    both = np.hstack([[s.leader.X for s in last], [s.follower.X_sd for s in last]])
    return _swing(both) > TREMBLE


def _swing(x: Array) -> float:
    """From one end of a motion (K, A) to the other [m]."""
    return float(np.max(np.ptp(x, axis=0)))


def _size(x: Array) -> float:
    return float(np.max(np.abs(x)))


def _rms(x: Array, *, most: bool = False) -> float:
    """Root of the mean square of vectors (K, A), or the largest."""
    square = np.sum(x * x, axis=1)
    return float(np.sqrt(np.max(square) if most else np.mean(square)))
