"""Where the hand of `sinuous bench link` goes, and who moves it."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.link_grid import Hand
from sinuous.teleop.operators import ImpedanceOperator, Prescribed

DURATION = 9.0  # of a run [s]
HOME = 5.0  # when the hand has come to its last place [s]
SETTLED = 6.0  # since when nothing has happened that could make anything grow [s]
REACH = 0.03  # how far it goes [m]
FASTEST = 0.25  # that a hand moves: v_max [m/s]


class Leg(NamedTuple):
    """A move of least jerk.

    Arguments:
        begin, end: [s]
        to: where it ends [m]
    """

    begin: float
    end: float
    to: float


LEGS = (
    Leg(0.5, 1.3, REACH),
    Leg(2.0, 2.5, 0.005),
    Leg(3.0, 3.5, REACH),
    Leg(4.2, HOME, 0.0),
)
"""Out, nearly back, out again fast, and home: with a wall on the way, two contacts."""


def place(time: float) -> float:
    """Where the hand wants to be [m] at a time [s]."""
    x = 0.0
    for begin, end, to in LEGS:
        x += least_jerk((time - begin) / (end - begin)) * (to - x)
    return x


def least_jerk(share: float) -> float:
    """Share of the way that a move of least jerk has gone, by the share of its time."""
    s = min(max(share, 0.0), 1.0)
    return s**3 * (10.0 - 15.0 * s + 6.0 * s**2)


class Along:
    """The path along the first of some axes; at rest along the others.

    Arguments:
        axes: how many
    """

    def __init__(self, axes: int) -> None:
        self._axes = axes

    def __call__(self, time: float) -> Array:
        """The goal (A,) [m]."""
        goal = np.zeros(self._axes)
        goal[0] = place(time)
        return goal


class Sampled:
    """A motion by samples along the first of some axes, at rest when they end.

    Arguments:
        x: places at the beginning of every tick (K,) [m]
        dt: time of a tick [s]
        axes: how many
    """

    def __init__(self, x: Array, dt: float, axes: int) -> None:
        self._x, self._dt, self._axes = x, dt, axes

    def __call__(self, time: float) -> Array:
        """The goal (A,) [m]."""
        goal = np.zeros(self._axes)
        goal[0] = self._x[min(round(time / self._dt), len(self._x) - 1)]
        return goal


class Impedance(NamedTuple):
    """Of an arm.

    Arguments:
        stiffness: [N/m]
        damping: [N s/m]
    """

    stiffness: float
    damping: float


RELAXED, STIFF = Impedance(20.0, 2.0), Impedance(600.0, 20.0)
ARMS = {Hand.RELAXED: RELAXED, Hand.STIFF: STIFF}


def arm(impedance: Impedance, axes: int) -> ImpedanceOperator:
    """An arm of that impedance that follows the path."""
    return ImpedanceOperator(Along(axes), stiffness=impedance.stiffness, damping=impedance.damping)


def puppet(x: Array, dt: float, axes: int) -> Prescribed:
    """A hand that moves as it is told, whatever that takes: a source of motion."""
    return Prescribed(Sampled(x, dt, axes))
