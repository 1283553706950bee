"""Wave variables as pairs of two-ports (paper A, section 3.1), for any number of axes.

Their energy is accounted for in `passivity`.
"""

import warnings
from dataclasses import dataclass
from functools import cached_property
from math import inf, isnan, sqrt
from typing import Self

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import positive
from sinuous.teleop.passivity import WaveEnergy
from sinuous.teleop.scheme import NOTHING, Scheme

__all__ = [
    "PASSIVE_GAIN",
    "ActiveChannelWarning",
    "ModifiedWaves",
    "Scheme",
    "StandardWaves",
]

PASSIVE_GAIN = 0.5
"""The smallest K that makes no energy, whatever b, the delay and the filter (notes A11)."""

TOO_SMALL = (
    "a gain K of {gain} is below 1/2: the channel makes energy at some frequencies, and what it is "
    "connected to may go unstable"
)


class ActiveChannelWarning(UserWarning):
    """A channel that makes energy was asked for, and built."""


@dataclass(frozen=True, kw_only=True)
class StandardWaves(WaveEnergy):
    """Wave variables as first published: u = (b v + F) / sqrt(2 b), v = (b v - F) / sqrt(2 b).

    The channel stores energy and loses none: b P is (w_m^2 - w_r^2) / 2 in waves.

    Arguments:
        impedance: b [N s/m]
        dt: time of a tick [s]

    Raises:
        ValueError: if one is not positive and finite

    Source: Niemeyer and Slotine, Stable adaptive teleoperation, IEEE J. Oceanic Eng. 16 (1991).
    """

    impedance: float = 10.0
    dt: float = 1e-3

    def __post_init__(self) -> None:
        positive("impedance", self.impedance)
        positive("dt", self.dt)

    @cached_property
    def wave_factor(self) -> float:
        """dt / 2: energy of a wave by its square, in a tick [J]."""
        return 0.5 * self.dt

    @property
    def force_gain(self) -> float:
        """sqrt(2 b)."""
        return sqrt(2.0 * self.impedance)

    @property
    def speed_gain(self) -> float:
        """sqrt(2 / b)."""
        return sqrt(2.0 / self.impedance)

    @property
    def is_passive(self) -> bool:
        """Yes: all that comes in goes out."""
        return True

    @property
    def damping(self) -> float:
        """b [N s/m]."""
        return self.impedance

    def force_at_rest(self, received: Array) -> Array:
        """F_m of a leader that stands still (A,) [N]."""
        force = np.empty(received.size)
        kernels.times(-self.force_gain, received, force)
        return force

    def leader_init(self, axes: int) -> Array:
        """The leader's port, which remembers nothing."""
        return NOTHING

    def follower_init(self, axes: int) -> Array:
        """The follower's port, which remembers nothing."""
        return NOTHING

    def leader_step(self, state: Array, v: Array, received: Array) -> tuple[Array, Array, Array]:
        """Force on the leader [N] and wave to send, given its velocity [m/s]."""
        force, sent = np.empty(v.size), np.empty(v.size)
        kernels.standard_leader(self.impedance, v, received, force, sent)
        return state, force, sent

    def follower_step(
        self, state: Array, force: Array, received: Array
    ) -> tuple[Array, Array, Array]:
        """Desired velocity of the follower [m/s] and wave to send, given the force on it [N]."""
        desired, sent = np.empty(force.size), np.empty(force.size)
        kernels.standard_follower(self.impedance, force, received, desired, sent)
        return state, desired, sent

    def follower_loss(self, force: Array, received: Array) -> float:
        """None [W]: all that comes in goes out."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class ModifiedWaves(WaveEnergy):
    """The paper's waves (16)-(19): a gain K on the force, and a low-pass on the way forward.

    With w = b v_m + F_r, what the leader's port receives being F_r / K, and g the filtered w:

        F_m = F_r + K b v_m,  v_sd = (g_r - F_s) / b,  waves g / K forward and F_s / K back.

    The filter is explicit Euler, g <- g + lambda dt (w - g). What it becomes is sent, so that
    lambda dt = 1 is no filter; that is a tick ahead of (16). For K >= 1/2 and lambda dt <= 1 the
    channel is passive, whatever b and a constant delay; see `analysis.passivity`.

    Arguments:
        impedance: b [N s/m]
        gain: K, of the leader's own motion in the force it feels
        cutoff: lambda of the low-pass [rad/s]; infinite for none
        dt: time of a tick [s]
        allow_active: take a gain below 1/2 too, with a warning

    Raises:
        ValueError: if a number makes no sense, lambda dt is above 1, or K below 1/2 is not allowed
    """

    impedance: float = 10.0
    gain: float = 0.5
    cutoff: float = 20.0
    dt: float = 1e-3
    allow_active: bool = False

    def __post_init__(self) -> None:
        positive("impedance", self.impedance)
        positive("gain", self.gain)
        positive("dt", self.dt)
        if isnan(self.cutoff) or self.cutoff <= 0.0:
            raise ValueError(f"cutoff must be positive, not {self.cutoff}")
        if self.cutoff < inf and self.cutoff * self.dt > 1.0:
            raise ValueError(
                f"cutoff times dt must be at most 1, not {self.cutoff * self.dt}: the low-pass "
                "would amplify; an infinite cutoff means no low-pass"
            )
        if self.gain < PASSIVE_GAIN:
            reason = TOO_SMALL.format(gain=self.gain)
            if not self.allow_active:
                raise ValueError(f"{reason}; allow_active takes it all the same")
            warnings.warn(reason, ActiveChannelWarning, stacklevel=3)

    @classmethod
    def c1(cls, *, impedance: float = 10.0, dt: float = 1e-3) -> Self:
        """What the paper compares itself with: K = 1 and no low-pass (notes A10)."""
        return cls(impedance=impedance, gain=1.0, cutoff=inf, dt=dt)

    @classmethod
    def c2(cls, *, impedance: float = 10.0, dt: float = 1e-3) -> Self:
        """The paper's own: K = 0.5 and lambda = 20 rad/s."""
        return cls(impedance=impedance, gain=0.5, cutoff=20.0, dt=dt)

    @cached_property
    def wave_factor(self) -> float:
        """K^2 dt / 2b: energy of a wave by its square, in a tick [J]."""
        return 0.5 * self.gain**2 * self.dt / self.impedance

    @property
    def force_gain(self) -> float:
        """K."""
        return self.gain

    @property
    def speed_gain(self) -> float:
        """K / b."""
        return self.gain / self.impedance

    @property
    def is_passive(self) -> bool:
        """Whether K is 1/2 or more."""
        return self.gain >= PASSIVE_GAIN

    @cached_property
    def share(self) -> float:
        """Share of the way to its input that the low-pass goes in a tick: lambda dt."""
        return min(self.cutoff * self.dt, 1.0)

    @property
    def damping(self) -> float:
        """K b [N s/m]."""
        return self.gain * self.impedance

    def force_at_rest(self, received: Array) -> Array:
        """F_s of one delay ago (A,) [N] (19)."""
        force = np.empty(received.size)
        kernels.times(self.gain, received, force)
        return force

    def leader_init(self, axes: int) -> Array:
        """The leader's port with an empty low-pass: g / K, what it sent (A,)."""
        return np.zeros(axes)

    def follower_init(self, axes: int) -> Array:
        """The follower's port, which remembers nothing."""
        return NOTHING

    def leader_step(self, state: Array, v: Array, received: Array) -> tuple[Array, Array, Array]:
        """Force on the leader [N] and wave to send (16), (19), given its velocity [m/s]."""
        force, sent = np.empty(v.size), np.empty(v.size)
        kernels.modified_leader(
            self.gain, self.impedance, self.share, state, v, received, force, sent
        )
        return sent, force, sent

    def follower_step(
        self, state: Array, force: Array, received: Array
    ) -> tuple[Array, Array, Array]:
        """Desired velocity [m/s] and wave to send (17), (18), given the follower's force [N]."""
        desired, sent = np.empty(force.size), np.empty(force.size)
        kernels.modified_follower(self.gain, self.impedance, force, received, desired, sent)
        return state, desired, sent

    def follower_loss(self, force: Array, received: Array) -> float:
        """|F_s - g_r|^2 / 2b [W], a term of the channel's power (notes A11)."""
        return kernels.modified_loss(self.gain, self.impedance, force, received)
