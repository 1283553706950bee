"""Which passive arm a connection without passivity control gives most energy to.

A spring and a damper whose end follows the path take no more energy out of a channel than it has
taken in; but a channel that makes some can set them swinging. Axes do not act on each other in the
ports, so that every arm is tried on an axis of its own, all in one run.
"""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.bench import link_hand
from sinuous.bench.link_follower import LAG, WALL
from sinuous.bench.link_grid import Contact
from sinuous.bench.link_hand import Impedance
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.force import ErrorForce, Motion, Together, VirtualForce
from sinuous.teleop.leader import LeaderDevice, Load
from sinuous.teleop.waves import Scheme
from sinuous.teleop.worst_case import Schedule

STIFFNESS = np.geomspace(3.0, 3000.0, 25)  # [N/m]
DAMPING = np.concatenate([[0.0], np.geomspace(0.3, 30.0, 9)])  # [N s/m]
ROUNDING = 1e-9  # less energy than that is none [J]
FAR = 1.0  # an arm that got so far has been set swinging [m]


@dataclass(frozen=True, kw_only=True)
class WorstArm:
    """What was found among all of them.

    Arguments:
        arm: that took most
        energy: the least that the channel had taken in [J]
        swing: how far arm or follower still are from where they should be, at the end [m]
        tried: how many arms
    """

    arm: Impedance
    energy: float
    swing: float
    tried: int


def worst_arm(scheme: Scheme, schedule: Schedule, contact: Contact) -> WorstArm:
    """Let all arms follow the path against a follower that lags, free or at the box.

    The worst is the one that got most energy; if none got any, the one that swings most.
    """
    grid = np.array([(k, d) for k in STIFFNESS for d in DAMPING])
    least, swing = _try(scheme, schedule, _force(contact, len(grid)), *grid.T.copy())
    worst = int(np.lexsort((-swing, np.minimum(least, -ROUNDING)))[0])
    return WorstArm(
        arm=Impedance(*grid[worst].tolist()),
        energy=float(least[worst]),
        swing=float(swing[worst]),
        tried=len(grid),
    )


def _force(contact: Contact, axes: int) -> VirtualForce:
    if contact is Contact.FREE:
        return ErrorForce()
    wall = np.full(axes, WALL)
    return Together((ErrorForce(), BoxForce(low=wall - 10.0, high=wall)))


def _try(
    scheme: Scheme, schedule: Schedule, force: VirtualForce, stiffness: Array, damping: Array
) -> tuple[Array, Array]:
    """For every arm (A,), the least energy that the channel had taken in [J] and its swing [m]."""
    axes, ticks, dt, device = len(stiffness), len(schedule.forward), scheme.dt, LeaderDevice()
    ahead, back = np.zeros((2, ticks + 1, axes))
    leader, follower = scheme.leader_init(axes), scheme.follower_init(axes)
    x, v, X_sd, X_s, V_sd, V_s, energy, least = np.zeros((8, axes))
    resistance = np.full(axes, scheme.damping)
    for k in range(ticks):
        received = back[schedule.backward[k]]
        load = Load(scheme.force_at_rest(received), resistance)
        F_h = stiffness * (link_hand.place(k * dt) - x) - damping * v
        x, v = device.step(x, v, F_h, load, dt)
        leader, F_m, ahead[k] = scheme.leader_step(leader, v, received)
        F_s = force.force(Motion(X_sd, V_sd, X_s, V_s))
        follower, V_sd, back[k] = scheme.follower_step(follower, F_s, ahead[schedule.forward[k]])
        X_sd = X_sd + dt * V_sd
        V_s = (X_sd - X_s) / LAG
        X_s = X_s + dt * V_s
        energy = energy + dt * (F_m * v - F_s * V_sd)
        near = np.maximum(np.abs(x), np.abs(X_sd)) < FAR
        least = np.where(near, np.minimum(least, energy), least)
        # What is far stays where it is: its numbers would overflow.
        stiffness, v, back[k] = stiffness * near, v * near, back[k] * near
        ahead[k] *= near
    return least, np.maximum(np.abs(x), np.abs(X_sd))
