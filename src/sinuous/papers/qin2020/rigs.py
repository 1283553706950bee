"""Teleoperation without a robot: the follower is a point in the plane PTY."""

from collections.abc import Callable
from typing import Any

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.papers.qin2020.runs import BOUNDARY, DELAY, SCALE
from sinuous.teleop.bilateral import Bilateral
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.ends import FollowerEnd, LeaderEnd
from sinuous.teleop.force import ErrorForce, Together, VirtualForce
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.link import ConstantDelay
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.operators import Operator
from sinuous.teleop.waves import Scheme

LOW, HIGH = (-BOUNDARY, -BOUNDARY), (BOUNDARY, BOUNDARY)
"""Of the room without force [m]."""

Way = Callable[[float], Array]
"""Where a leader wants to be (2,) [m], by time [s]."""


def resistive() -> VirtualForce:
    """F_e + F_b with the printed gains, both as reactions."""
    return Together((ErrorForce(), BoxForce(low=LOW, high=HIGH)))


def plane() -> Mapping:
    """From the leader to a plane through the origin."""
    return Mapping.plane(SCALE, 0.0)


def point_follower(
    scheme: Scheme,
    operator: Operator[Any],
    force: VirtualForce,
    *,
    correction: DriftCorrection | None = None,
) -> Bilateral[Any]:
    """Both ends over the printed delay.

    Arguments:
        scheme: of the waves
        operator: who holds the leader
        force: what the follower feels
        correction: of drift
    """
    link, mapping = ConstantDelay(delay=DELAY, dt=scheme.dt), plane()
    return Bilateral(
        leader=LeaderEnd(scheme=scheme, mapping=mapping, operator=operator, device=LeaderDevice()),
        follower=FollowerEnd(scheme=scheme, mapping=mapping, force=force, correction=correction),
        forward=link,
        backward=link,
    )


def push(way: ArrayLike, *, after: float, lasting: float) -> Way:
    """A smooth way from zero to a place (2,) of the follower's side [m], for a leader.

    Arguments:
        after: when it begins [s]
        lasting: how long it takes [s]
    """
    end = np.asarray(way, dtype=np.float64) / SCALE

    def goal(time: float) -> Array:
        share = min(max((time - after) / lasting, 0.0), 1.0)
        return share**3 * (10.0 - 15.0 * share + 6.0 * share**2) * end

    return goal
