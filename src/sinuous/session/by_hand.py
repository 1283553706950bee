"""An operator's hand follows the path, far away; what arrives of it is the controller's target."""

from collections.abc import Sequence

import numpy as np

from sinuous.arrays import Array
from sinuous.scenario.path import Leg
from sinuous.scenario.teleop import Teleoperation
from sinuous.teleop.bilateral import Signals
from sinuous.teleop.motion import NO_WALLS, Walls

VECTORS = (
    "leader_m",
    "hand_n",
    "felt_n",
    "sent_m",
    "sent_m_s",
    "desired_m",
    "desired_m_s",
    "tip_m",
    "virtual_n",
)
"""Signals with a value for each axis: x, F_h, F_m, X and V of the leader's end, X_sd, V_sd, X_s and
F_s of the follower's; all but the first two on the wave side."""

HAND, FELT, SPEED, DESIRED_SPEED, VIRTUAL = 1, 2, 4, 6, 8  # places in `VECTORS`

ENERGIES = ("channel_j", "operator_j", "follower_j")
"""Energy taken in by each part since the start [J], see `teleop.ledger`."""

FAULT = "fault"
"""How many of the two ends report a fault: they hold still, or ignored a packet."""


def signal_names(axes: Sequence[str]) -> tuple[str, ...]:
    """Names (C,) of what is recorded at every tick."""
    vectors = [f"{stem}_{axis}" for stem in VECTORS for axis in axes]
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

    def target(self, tip: Array, walls: Walls = NO_WALLS) -> Array:
        """One tick: what arrived of where the hand is (3,) [m], given the measured tip."""
        self._state, signals = self._bilateral.step(self._state, tip, walls)
        self._count += 1
        self._ticks.append(signals)
        return signals.follower.target_w

    def take(self) -> Array:
        """The signals (k, C) of the ticks since they were last taken."""
        ticks, axes = self._ticks, len(self._teleop.axes)
        vectors = [
            vector
            for _, a, b in ticks
            for vector in (a.x, a.F_h, a.F_m, a.X, a.V, b.X_sd, b.V_sd, b.X_s, b.F_s)
        ]
        faults = [[float(bool(a.fault) + bool(b.fault))] for _, a, b in ticks]
        table = np.concatenate(vectors).reshape(len(ticks), -1, axes)
        energies = self._energies + np.cumsum(self._work(table), axis=0)
        self._energies = energies[-1]
        ticks.clear()
        return np.concatenate([table.reshape(len(table), -1), energies, faults], axis=1)

    def _work(self, table: Array) -> Array:
        """Energy (k, 3) [J] taken in during each tick, see `teleop.ledger`."""
        force = table[:, [FELT, HAND, VIRTUAL]]
        speed = table[:, [SPEED, SPEED, DESIRED_SPEED]]
        felt, hand, follower = self.tick * np.sum(force * speed, axis=2).T
        return np.stack([felt - follower, -hand, follower], axis=1)

    def _goal(self, time: float) -> Array:
        return self._in_hand(self._leg.at(time - self._began))

    def _in_hand(self, place: Array) -> Array:
        """The leader's coordinates (A,) [m] of a place (3,) [m]."""
        return self._mapping.project(place) / self._mapping.scale
