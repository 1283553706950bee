"""The worst-case operator of `sinuous bench link`: how he is looked for, and what is found."""

from dataclasses import dataclass
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.link_arms import ROUNDING, WorstArm, worst_arm
from sinuous.bench.link_follower import LAG, WALL
from sinuous.bench.link_grid import Contact
from sinuous.bench.link_hand import FASTEST, REACH, SETTLED, arm, least_jerk, puppet
from sinuous.bench.result import Row
from sinuous.teleop.boundary import BoxForce
from sinuous.teleop.force import ErrorForce
from sinuous.teleop.operators import Operator
from sinuous.teleop.scheme import Scheme
from sinuous.teleop.worst_case import (
    Basis,
    HandLimits,
    LaggingFollower,
    Schedule,
    worst_motions,
)

PRESSING = 0.5  # how long the hand takes to where it presses [s]
MOVING = SETTLED  # when the worst motion has ended [s]
KNOT = 0.04  # of splines: motions of up to 10 Hz [s]
SPACE = 0.05  # to either side, in free motion [m]; in contact, what it has pressed


@dataclass(frozen=True, kw_only=True)
class Worst:
    """What was found for a scheme on a connection, without passivity control.

    Arguments:
        x: the motion that takes most energy out (K,) [m]
        power: that it takes in by the linear forecast, on average while it moves [W]
        frequency: at which it moves most [Hz]
        arm: the arm that takes most energy out
    """

    x: Array
    power: float
    frequency: float
    arm: WorstArm

    def operators(self, dt: float, axes: int) -> tuple[Operator[Any], ...]:
        """Those who shall try it: the motion, and the arm if any arm got energy.

        Arguments:
            dt: time of a tick [s]
            axes: how many there are
        """
        motion = puppet(self.x, dt, axes)
        if self.arm.energy > -ROUNDING:
            return (motion,)
        return motion, arm(self.arm.arm, axes)

    @property
    def row(self) -> Row:
        """For the table."""
        return {
            "motion_w": self.power,
            "motion_hz": self.frequency,
            "motion_m": float(np.ptp(self.x)),
            "arm_stiffness_n_m": self.arm.arm.stiffness,
            "arm_damping_n_s_m": self.arm.arm.damping,
            "arm_ledger_min_j": self.arm.energy,
            "arms": self.arm.tried,
        }


def search(scheme: Scheme, schedule: Schedule, contact: Contact) -> Worst:
    """The motion by its eigenvalue, the arm by trying all."""
    dt, before = scheme.dt, round(PRESSING / scheme.dt)
    ticks = min(round(MOVING / dt), len(schedule.forward))
    bumps = Basis.bumps(ticks - before, dt, KNOT)
    basis = Basis(*(np.pad(each, ((before, 0), (0, 0))) for each in bumps))
    limits = HandLimits(FASTEST, SPACE if contact is Contact.FREE else WALL)
    begun = Schedule(schedule.forward[:ticks], schedule.backward[:ticks])
    follower = _linear(contact, basis.v.shape[1], dt)
    found = worst_motions(scheme, begun, basis, follower, limits)
    x, v = (each @ found.amounts[0] for each in basis)
    size = limits.scale(x, v)
    press = 0.0 if contact is Contact.FREE else REACH
    way = np.array([least_jerk(k / before) for k in range(before)] + [1.0] * (len(x) - before))
    effort = float(np.sum((v / limits.speed) ** 2) + np.sum((x / limits.reach) ** 2)) * dt
    return Worst(
        x=press * way + size * x,
        power=float(found.rates[0]) * effort * size**2 / (dt * ticks - PRESSING),
        frequency=_frequency(v, dt),
        arm=worst_arm(scheme, schedule, contact),
    )


def _linear(contact: Contact, axes: int, dt: float) -> LaggingFollower:
    """The follower and its forces as they are for small motions, in contact if there is any."""
    pull = 0.25 * ErrorForce.gain / ErrorForce.length
    match contact:
        case Contact.FREE:
            return LaggingFollower(axes, dt, share=dt / LAG, pull=pull, wall=0.0)
        case Contact.BOX:
            return LaggingFollower(axes, dt, share=dt / LAG, pull=pull, wall=BoxForce.stiffness)
        case Contact.MESH:  # the robot stays where it is, and the wall pushes the desired point
            return LaggingFollower(axes, dt, share=0.0, pull=pull + BoxForce.stiffness, wall=0.0)


def _frequency(v: Array, dt: float) -> float:
    """Where the spectrum of a motion has its peak [Hz]."""
    power = np.abs(np.fft.rfft(v))
    return float(np.fft.rfftfreq(len(v), dt)[np.argmax(power)])
