"""What a pair of ports is, whatever travels between them.

The leader's port takes a velocity and gives a force, the follower's takes a force and gives a
velocity. A port reads its own samples and what it has received; what happens on the way is the
link's. Per axis and tick the channel between them absorbs F_m v_m - F_s v_sd.
"""

from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.teleop.passivity import Flow


class Scheme(Protocol):
    """How velocity and force become waves and waves become force and velocity.

    Velocities, forces and waves are (A,), on the wave side: in metres of the follower. What a port
    remembers between ticks is an array, empty for a port without memory.
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

    def leader_init(self, axes: int) -> Array:
        """The leader's port with nothing in it."""
        ...

    def follower_init(self, axes: int) -> Array:
        """The follower's port with nothing in it."""
        ...

    def leader_step(self, state: Array, v: Array, received: Array) -> tuple[Array, Array, Array]:
        """Force on the leader [N] and wave to send, given its velocity [m/s]."""
        ...

    def follower_step(
        self, state: Array, force: Array, received: Array
    ) -> tuple[Array, Array, Array]:
        """Desired velocity of the follower [m/s] and wave to send, given the force on it [N]."""
        ...

    def follower_loss(self, force: Array, received: Array) -> float:
        """Power [W] that the follower's port dissipates for certain, whatever the link does."""
        ...

    @property
    def force_gain(self) -> float:
        """|F_m| of a leader that stands still, by the wave that it received."""
        ...

    @property
    def speed_gain(self) -> float:
        """|v_sd| of a follower without a force, by the wave that it received."""
        ...

    @property
    def is_passive(self) -> bool:
        """Whether the ports by themselves make no energy."""
        ...

    @property
    def yields(self) -> bool:
        """Whether under control the leader's force gives way to a hand that takes energy out.

        If not, what the port uses of a wave is known before the hand moves.
        """
        ...

    @property
    def loan(self) -> float:
        """Energy that the leader's port may give out before it has heard of any [J]."""
        ...

    def leader_use(self, received: Array, heard: float, used: float) -> Array:
        """What of a wave the leader's port may use (A,), by (1) of `passivity`.

        Arguments:
            heard: energy that the other end is known to have sent [J]
            used: of it before [J]
        """
        ...

    def leader_flow(self, v: Array, force: Array, received: Array, sent: Array) -> Flow:
        """Energy of a tick of the leader's port, given what it did and used."""
        ...

    def follower_use(self, force: Array, received: Array, heard: float, used: float) -> Array:
        """What of a wave the follower's port may use (A,), by (1) of `passivity`."""
        ...

    def follower_flow(self, force: Array, desired: Array, received: Array, sent: Array) -> Flow:
        """Energy of a tick of the follower's port, given what it did and used."""
        ...


NOTHING = np.zeros(0)
"""What a port without memory remembers."""
