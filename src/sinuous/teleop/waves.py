"""Wave variables as pairs of two-ports (paper A, section 3.1), for any number of axes.

The leader's port takes a velocity and gives a force, the follower's takes a force and gives a
velocity. A port reads its own samples and what it has received; what happens on the way is the
link's. Per axis and tick the channel between them absorbs F_m v_m - F_s v_sd.
"""

import warnings
from dataclasses import dataclass
from functools import cached_property
from math import inf, isnan, sqrt
from typing import NamedTuple, Protocol, Self

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop import kernels
from sinuous.teleop.checks import positive

PASSIVE_GAIN = 0.5
"""The smallest K that makes no energy, whatever b, the delay and the filter (notes A11)."""

TOO_SMALL = (
    "a gain K of {gain} is below 1/2: the channel makes energy at some frequencies, and what it is "
    "connected to may go unstable"
)


class ActiveChannelWarning(UserWarning):
    """A channel that makes energy was asked for, and built."""


class PortState(NamedTuple):
    """What a port remembers between ticks.

    Arguments:
        memory: of the forward low-pass, K u_m (A,) [N]; empty (0,) for a port without memory
    """

    memory: Array


class Scheme(Protocol):
    """How velocity and force become waves and waves become force and velocity.

    Velocities, forces and waves are (A,), on the wave side: in metres of the follower.
    """

    @property
    def dt(self) -> float:
        """Time of a tick [s]."""
        ...

    @property
    def damping(self) -> float:
        """What the leader's port answers a velocity with at once [N s/m]."""
        ...

    def force_at_rest(self, received: Array) -> Array:
        """F_m of a leader that stands still (A,) [N]; moving, damping v comes on top."""
        ...

    def leader_init(self, axes: int) -> PortState:
        """The leader's port with nothing in it."""
        ...

    def follower_init(self, axes: int) -> PortState:
        """The follower's port with nothing in it."""
        ...

    def leader_step(
        self, state: PortState, v: Array, received: Array
    ) -> tuple[PortState, Array, Array]:
        """Force on the leader [N] and wave to send, given its velocity [m/s]."""
        ...

    def follower_step(
        self, state: PortState, force: Array, received: Array
    ) -> tuple[PortState, Array, Array]:
        """Desired velocity of the follower [m/s] and wave to send, given the force on it [N]."""
        ...

    def follower_loss(self, force: Array, received: Array) -> float:
        """Power [W] that the follower's port dissipates for certain, whatever the link does."""
        ...


_NOTHING = PortState(memory=np.zeros(0))


@dataclass(frozen=True, kw_only=True)
class StandardWaves:
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

    @property
    def damping(self) -> float:
        """b [N s/m]."""
        return self.impedance

    def force_at_rest(self, received: Array) -> Array:
        """F_m of a leader that stands still (A,) [N]."""
        return -sqrt(2.0 * self.impedance) * received

    def leader_init(self, axes: int) -> PortState:
        """The leader's port, which remembers nothing."""
        return _NOTHING

    def follower_init(self, axes: int) -> PortState:
        """The follower's port, which remembers nothing."""
        return _NOTHING

    def leader_step(
        self, state: PortState, v: Array, received: Array
    ) -> tuple[PortState, Array, Array]:
        """Force on the leader [N] and wave to send, given its velocity [m/s]."""
        force, sent = np.empty(v.size), np.empty(v.size)
        kernels.standard_leader(self.impedance, v, received, force, sent)
        return state, force, sent

    def follower_step(
        self, state: PortState, force: Array, received: Array
    ) -> tuple[PortState, Array, Array]:
        """Desired velocity of the follower [m/s] and wave to send, given the force on it [N]."""
        desired, sent = np.empty(force.size), np.empty(force.size)
        kernels.standard_follower(self.impedance, force, received, desired, sent)
        return state, desired, sent

    def follower_loss(self, force: Array, received: Array) -> float:
        """None [W]: all that comes in goes out."""
        return 0.0


@dataclass(frozen=True, kw_only=True)
class ModifiedWaves:
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
    def share(self) -> float:
        """Share of the way to its input that the low-pass goes in a tick: lambda dt."""
        return min(self.cutoff * self.dt, 1.0)

    @property
    def damping(self) -> float:
        """K b [N s/m]."""
        return self.gain * self.impedance

    def force_at_rest(self, received: Array) -> Array:
        """F_s of one delay ago (A,) [N] (19)."""
        return self.gain * received

    def leader_init(self, axes: int) -> PortState:
        """The leader's port with an empty low-pass."""
        return PortState(memory=np.zeros(axes))

    def follower_init(self, axes: int) -> PortState:
        """The follower's port, which remembers nothing."""
        return _NOTHING

    def leader_step(
        self, state: PortState, v: Array, received: Array
    ) -> tuple[PortState, Array, Array]:
        """Force on the leader [N] and wave to send (16), (19), given its velocity [m/s]."""
        filtered, force, sent = np.empty(v.size), np.empty(v.size), np.empty(v.size)
        kernels.modified_leader(
            self.gain, self.impedance, self.share, state.memory, v, received, filtered, force, sent
        )
        return PortState(filtered), force, sent

    def follower_step(
        self, state: PortState, force: Array, received: Array
    ) -> tuple[PortState, Array, Array]:
        """Desired velocity [m/s] and wave to send (17), (18), given the follower's force [N]."""
        desired, sent = np.empty(force.size), np.empty(force.size)
        kernels.modified_follower(self.gain, self.impedance, force, received, desired, sent)
        return state, desired, sent

    def follower_loss(self, force: Array, received: Array) -> float:
        """|F_s - g_r|^2 / 2b [W], a term of the channel's power (notes A11)."""
        return kernels.modified_loss(self.gain, self.impedance, force, received)
