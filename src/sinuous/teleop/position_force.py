"""Velocity one way and force the other, as they are: two channels and no waves.

    F_m = F_r + B v_m,  v_sd = v_r,  v_m forward and F_s back,

with what is received marked r. It is as transparent as can be and makes energy with any delay: it
needs passivity control, here in the time domain.

*What is counted* (`passivity`): `sent` is the sum of the power that goes into a port, `used` that
of the power that comes out, so that (2) is an equality.

*The follower's port* gives out F_s . v_sd. It knows both when the tick begins, and takes

    v_sd = v_r - beta F_s,  beta = (F_s . v_r - spare / dt) / |F_s|^2 where that is positive,

the velocity nearest to v_r for which F_s . v_sd dt is what is left: damping, of an admittance.

*The leader's port* gives out - F_m . v_m, of a velocity that the tick will show. So it answers with
a law that keeps to what is left with any velocity: F_m = h F_r + B v_m, where

    h = 1 - a / (4 spare), but zero or more, for a = - F_r . v_m dt > 0,  and h = 1 for a <= 0.

Then - F_m . v_m dt <= h a <= a - a^2 / (4 spare) <= spare. A hand that presses on feels all of
the force; one that gives way feels a damper of h, as an impedance has, but never a pull. Nothing
left is a force that stops the hand from pressing on, and does not push it back.

What the wall gives back is heard of one delay after the hand has felt it, and on a clean link a
relaxed hand would lose a quarter of the force to that. A loan bridges it: the ledger may fall to
minus this sum, which is less than a third of what 10 N and 0.25 m/s move in a tick of 1 ms.

The local damper B puts energy in while the hand moves: without any the follower could not set out
against a force before the force has been felt.
"""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import energy_kernels
from sinuous.teleop.checks import positive, zero_or_more
from sinuous.teleop.passivity import Flow, spare, work_in, work_out
from sinuous.teleop.scheme import NOTHING


@dataclass(frozen=True, kw_only=True)
class PositionForce:
    """The leader's velocity and the follower's force; its position is for `DriftCorrection`.

    Arguments:
        local_damping: B, of the leader's own motion in the force it feels [N s/m]
        loan: energy that the leader's port may give out before it has heard of any [J]
        dt: time of a tick [s]

    Raises:
        ValueError: if damping or loan is negative, or dt not positive
    """

    local_damping: float = 10.0
    loan: float = 0.75e-3
    dt: float = 1e-3

    def __post_init__(self) -> None:
        zero_or_more("local_damping", self.local_damping)
        zero_or_more("loan", self.loan)
        positive("dt", self.dt)

    @property
    def damping(self) -> float:
        """B [N s/m]."""
        return self.local_damping

    @property
    def force_gain(self) -> float:
        """1."""
        return 1.0

    @property
    def speed_gain(self) -> float:
        """1."""
        return 1.0

    @property
    def is_passive(self) -> bool:
        """Under control."""
        return True

    @property
    def yields(self) -> bool:
        """Yes: what comes out at the leader depends on how the hand moves."""
        return True

    def force_at_rest(self, received: Array) -> Array:
        """F_r (A,) [N]."""
        return received

    def leader_init(self, axes: int) -> Array:
        """The leader's port, which remembers nothing."""
        return NOTHING

    def follower_init(self, axes: int) -> Array:
        """The follower's port, which remembers nothing."""
        return NOTHING

    def leader_step(self, state: Array, v: Array, received: Array) -> tuple[Array, Array, Array]:
        """Force on the leader [N], and its velocity to send [m/s]."""
        return state, received + self.local_damping * v, v

    def follower_step(
        self, state: Array, force: Array, received: Array
    ) -> tuple[Array, Array, Array]:
        """Desired velocity of the follower [m/s], and the force on it to send [N]."""
        return state, received, force

    def follower_loss(self, force: Array, received: Array) -> float:
        """None [W]."""
        return 0.0

    def leader_use(self, received: Array, heard: float, used: float) -> Array:
        """F_r, for all that is known before the hand moves (A,) [N]."""
        return received

    def leader_flow(self, v: Array, force: Array, received: Array, sent: Array) -> Flow:
        """Energy of a tick of the leader's port."""
        return Flow(work_in(force, v, self.dt), work_out(force, v, self.dt))

    def follower_use(self, force: Array, received: Array, heard: float, used: float) -> Array:
        """v_r - beta F_s (A,) [m/s]."""
        return damped(force, received, spare(heard, used), self.dt)

    def follower_flow(self, force: Array, desired: Array, received: Array, sent: Array) -> Flow:
        """Energy of a tick of the follower's port."""
        return Flow(work_out(force, desired, self.dt), work_in(force, desired, self.dt))


def damped(force: Array, v: Array, left: float, dt: float) -> Array:
    """The velocity nearest to v for which force . velocity dt is at most what is left [J]."""
    out = np.empty(v.size)
    energy_kernels.limit_motion(force, v, left, dt, out)
    return out


def yielding(force: Array, v: Array, left: float, dt: float) -> Array:
    """What stays of a force on whom moves with v: h F (A,) [N].

    Arguments:
        left: energy that may be given out [J]
    """
    return energy_kernels.left(force, v, left, dt) * force
