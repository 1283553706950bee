"""An operator's hand follows the path, far away; what arrives of it is the controller's target."""

from collections.abc import Sequence

import numpy as np

from sinuous.arrays import Array
from sinuous.scenario.path import Leg
from sinuous.scenario.teleop import Teleoperation
from sinuous.teleop.bilateral import Signals

LEADER = {"leader_m": "x", "hand_n": "F_h", "felt_n": "F_m", "sent_m": "X", "sent_m_s": "V"}
"""Signals of the leader's end, and what they are called there."""

FOLLOWER = {"desired_m": "X_sd", "desired_m_s": "V_sd", "tip_m": "X_s", "virtual_n": "F_s"}
"""Signals of the follower's end, and what they are called there; all on the wave side."""

ENERGIES = ("channel_j", "operator_j", "follower_j")
"""Energy taken in by each part since the start [J], see `teleop.ledger`."""

FAULT = "fault"
"""How many of the two ends hold still because of a fault."""


def signal_names(axes: Sequence[str]) -> tuple[str, ...]:
    """Names (C,) of what is recorded at every tick."""
    vectors = [f"{stem}_{axis}" for stem in (*LEADER, *FOLLOWER) for axis in axes]
    return (*vectors, *ENERGIES, FAULT)


class ByHand:
    """Both ends of a teleoperation, with a model of the operator.

    Arguments:
        teleop: what is between hand and robot
        tip: where the robot's tip starts (3,) [m]
        path: where the hand goes, one after the other
    """

    def __init__(self, teleop: Teleoperation, tip: Array, path: Sequence[Leg]) -> None:
        self._teleop, self._mapping = teleop, teleop.mapping
        stops = [self._in_hand(leg.at(leg.moving)) for leg in path]
        self._bilateral = teleop.bilateral(self._goal, stops)
        self._state = self._bilateral.init(tip)
        self._leg, self._began = path[0], 0.0
        self._ticks = list[Signals]()
        self._energies, self._count = np.zeros(len(ENERGIES)), 0

    @property
    def tick(self) -> float:
        """Time between two targets [s]."""
        return self._bilateral.dt

    @property
    def patience(self) -> float:
        """How long the body must rest before the next leg may begin [s]."""
        return self._teleop.patience

    def begin(self, leg: Leg) -> None:
        """The hand sets out on a leg of the path."""
        self._leg, self._began = leg, self._count * self.tick

    def target(self, tip: Array) -> Array:
        """One tick: what arrived of where the hand is (3,) [m], given the measured tip."""
        self._state, signals = self._bilateral.step(self._state, tip)
        self._count += 1
        self._ticks.append(signals)
        return signals.follower.target_w

    def take(self) -> Array:
        """The signals (k, C) of the ticks since they were last taken."""
        leaders = [signals.leader for signals in self._ticks]
        followers = [signals.follower for signals in self._ticks]
        vectors = [np.array([getattr(one, name) for one in leaders]) for name in LEADER.values()]
        vectors += [
            np.array([getattr(one, name) for one in followers]) for name in FOLLOWER.values()
        ]
        faults = [
            float(bool(a.fault) + bool(b.fault)) for a, b in zip(leaders, followers, strict=True)
        ]
        energies = self._energies + np.cumsum(self._work(), axis=0)
        self._energies = energies[-1]
        self._ticks.clear()
        return np.column_stack([*vectors, energies, faults])

    def _work(self) -> Array:
        """Energy (k, 3) [J] taken in during each tick, see `teleop.ledger`."""
        powers = [(a.F_m @ a.V, a.F_h @ a.V, b.F_s @ b.V_sd) for _, a, b in self._ticks]
        into_leader, from_hand, into_follower = self.tick * np.array(powers).T
        return np.column_stack([into_leader - into_follower, -from_hand, into_follower])

    def _goal(self, time: float) -> Array:
        return self._in_hand(self._leg.at(time - self._began))

    def _in_hand(self, place: Array) -> Array:
        """The leader's coordinates (A,) [m] of a place (3,) [m]."""
        return self._mapping.project(place) / self._mapping.scale
