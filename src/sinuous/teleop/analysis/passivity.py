"""When the paper's channel makes no energy: in closed form, and tick by tick (notes A11)."""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop.waves import ModifiedWaves


def least_gain(omega: ArrayLike, *, cutoff: ArrayLike, delay: ArrayLike) -> Array:
    """The smallest K (...) with which the channel takes no energy out of a frequency.

    H + H^H of (31) is positive semidefinite if and only if 4 K (1 - r) >= 1 + |Phi|^2 - 2 r with
    r = Re z, z = exp(-2 j omega T) Phi, whatever b. The right side is |1 - z|^2, so that this is
    K >= 1 / (4 Re(1 / (1 - z))), and 1/2 suffices for every filter with |Phi| <= 1 and every
    constant delay. For the low-pass, with x = omega / lambda, s and c sine and cosine of omega T,

        K >= 1/2 - x^2 / (2 (4 s^2 + 4 s c x + 2 x^2)):

    without it (x = 0) 1/2 is needed at every frequency, with it a little less.

    Arguments:
        omega: [rad/s]
        cutoff: lambda [rad/s], infinite for no low-pass
        delay: T, one way [s]
    """
    w = np.asarray(omega, dtype=np.float64)
    x = w / np.asarray(cutoff, dtype=np.float64)
    angle = w * np.asarray(delay, dtype=np.float64)
    s, c, x = np.broadcast_arrays(np.sin(angle), np.cos(angle), x)
    away = 4.0 * s**2 + 4.0 * s * c * x + 2.0 * x**2  # zero only where nothing is lost or made
    spared = np.divide(x**2, away, out=np.zeros(x.shape), where=away > 0.0)
    return 0.5 - 0.5 * spared


class PowerTerms(NamedTuple):
    """What makes up the power that the channel takes in, per tick and axis [W].

    Arguments:
        forward: (w^2 - g_r^2) / 2b, into the filter and the link forward less what comes out
        backward: (F_s^2 - F_r^2) / 2b, into the link backward less what comes out
        follower: (F_s - g_r)^2 / 2b, lost at the follower's port
        leader: (K - 1/2) (w - F_r)^2 / b, lost at the leader's port, or made if K is below 1/2
    """

    forward: Array
    backward: Array
    follower: Array
    leader: Array

    @property
    def total(self) -> Array:
        """F_m v_m - F_s v_sd."""
        return self.forward + self.backward + self.follower + self.leader


def power_terms(
    scheme: ModifiedWaves, *, v: Array, at_leader: Array, force: Array, at_follower: Array
) -> PowerTerms:
    """The identity of the channel's power: terms that add up to F_m v_m - F_s v_sd in every tick.

    With w = b v_m + F_r and what the ports receive being F_r / K and g_r / K, it holds whatever
    the link does. A link of constant delay and a filter of gain at most 1 give back no more
    squares than they took, so the first two terms add up to zero or more from the start on, and
    the energy of the channel is never below zero for K >= 1/2.

    Arguments:
        scheme: K and b
        v: of the leader (...) [m/s]
        at_leader: waves that the leader received (...)
        force: F_s (...) [N]
        at_follower: waves that the follower received (...)
    """
    K, b = scheme.gain, scheme.impedance
    F_r, g_r = K * at_leader, K * at_follower
    w = b * v + F_r
    return PowerTerms(
        forward=(w**2 - g_r**2) / (2.0 * b),
        backward=(force**2 - F_r**2) / (2.0 * b),
        follower=(force - g_r) ** 2 / (2.0 * b),
        leader=(K - 0.5) * (w - F_r) ** 2 / b,
    )
