"""Models of the operator's hand: what force it puts on the device."""

from collections.abc import Callable
from dataclasses import dataclass
from typing import NamedTuple, Protocol, TypeVar

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop import kernels
from sinuous.teleop.checks import zero_or_more
from sinuous.teleop.leader import LeaderDevice, Load

Goal = Callable[[float], ArrayLike]
"""Where the hand wants to be (A,) [m], in the leader's coordinates, by time [s]."""

O = TypeVar("O")  # noqa: E741  what an operator remembers


class Felt(NamedTuple):
    """What the hand feels when a tick begins.

    Arguments:
        time: [s]
        x: where the device is (A,) [m]
        v: its velocity in the tick before (A,) [m/s]
        load: what it works against
    """

    time: float
    x: Array
    v: Array
    load: Load


class Operator(Protocol[O]):
    """Whoever holds the device."""

    def init(self, x: Array) -> O:
        """The state to start from, at rest with the device at x (A,) [m]."""
        ...

    def step(self, state: O, felt: Felt, device: LeaderDevice, dt: float) -> tuple[O, Array]:
        """The force F_h (A,) [N] on the device for one tick of dt [s]."""
        ...


@dataclass(frozen=True)
class Prescribed:
    """Moves as a trajectory does, from where it is, whatever that takes.

    The hand is a source of motion: in a tick the device goes as far as the goal does, and the
    force follows from (27).

    Arguments:
        goal: the trajectory
    """

    goal: Goal

    def init(self, x: Array) -> None:
        """It remembers nothing."""

    def step(self, state: None, felt: Felt, device: LeaderDevice, dt: float) -> tuple[None, Array]:
        """The force F_h (A,) [N] on the device for one tick of dt [s]."""
        speed = np.empty(felt.x.size)
        now = _place(self.goal, felt.time, felt.x)
        kernels.difference(_place(self.goal, felt.time + dt, felt.x), now, dt, speed)
        return None, device.force_for(speed, felt.v, felt.load, dt)


@dataclass(frozen=True)
class ImpedanceOperator:
    """Pulls the device to a moving goal by a spring and holds it back by a damper.

    Arguments:
        goal: where the spring ends
        stiffness: [N/m]
        damping: of the arm's own motion [N s/m]

    Raises:
        ValueError: if stiffness or damping is negative or not finite
    """

    goal: Goal
    stiffness: float = 60.0
    damping: float = 6.0

    def __post_init__(self) -> None:
        zero_or_more("stiffness", self.stiffness)
        zero_or_more("damping", self.damping)

    def init(self, x: Array) -> None:
        """It remembers nothing."""

    def step(self, state: None, felt: Felt, device: LeaderDevice, dt: float) -> tuple[None, Array]:
        """The force F_h (A,) [N] on the device for one tick of dt [s]."""
        force, goal = np.empty(felt.x.size), _place(self.goal, felt.time, felt.x)
        kernels.spring_damper(self.stiffness, self.damping, goal, felt.x, felt.v, force)
        return None, force


def _place(goal: Goal, time: float, x: Array) -> Array:
    """The goal (A,) at a time, for a device at x (A,).

    Raises:
        ValueError: if it has another number of axes
    """
    place = np.array(goal(time), dtype=np.float64)
    if place.shape != x.shape:
        raise ValueError(f"the operator's goal must have {x.size} axes, not {place.shape}")
    return place
