"""Both ends conspire: motion and force that take most energy out of the channel together.

The channel may be connected to anything, so this is the test of the channel: no hand and no
follower can do worse than what both are told to do.
"""

from typing import Any, NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.bench.link_drive import Trace, drive
from sinuous.bench.link_follower import LINE, Place
from sinuous.bench.link_grid import Connection, SchemeName
from sinuous.bench.link_hand import FASTEST, puppet
from sinuous.bench.link_rig import IMPEDANCE, connect, scheme
from sinuous.bench.link_summary import LARGEST
from sinuous.bench.result import Row
from sinuous.teleop.force import Motion
from sinuous.teleop.link import LinkModel
from sinuous.teleop.worst_case import Basis, Schedule, worst_pairs

MOVING, AFTER = 3.0, 0.5  # how long they act, and how long they are watched after that [s]
KNOT = 0.03  # of splines [s]
TINY = 1e-12  # in place of zero


class Told:
    """A follower whose place says what force it puts on its port: one newton by metre.

    Arguments:
        force: in every tick (K,) [N]; zero after that
    """

    def __init__(self, force: Array) -> None:
        self._force, self._count = np.append(force, 0.0), 0

    def step(self, target_w: Array) -> Array:
        """The place (3,) that stands for the force of the next tick."""
        self._count += 1
        return np.array([self._force[min(self._count, len(self._force) - 1)], 0.0, 0.0])


class AsTold:
    """The force that a place stands for."""

    def force(self, motion: Motion) -> Array:
        """F_s (A,) [N]."""
        return motion.X_s


class Pairs(NamedTuple):
    """The worst of them.

    Arguments:
        x: of the leader, at the beginning of every tick and at the end (J, K + 1) [m]
        force: on the follower (J, K) [N]
        energy: that the channel takes in by the linear forecast (J,) [J]
    """

    x: Array
    force: Array
    energy: Array

    def mix(self, amounts: Array, dt: float) -> tuple[Array, Array, float]:
        """A sum of them, as large as both ends can; and how many times it was enlarged."""
        x, force = amounts @ self.x, amounts @ self.force
        speed, most = np.max(np.abs(np.diff(x))) / dt, np.max(np.abs(force))
        size = float(min(FASTEST / max(speed, TINY), LARGEST / max(most, TINY)))
        return size * x, size * force, size


def pairs(
    name: SchemeName, link: LinkModel, dt: float, count: int, moving: float = MOVING
) -> Pairs:
    """That many of the worst without control, of unit effort each, for some time [s]."""
    ticks = round(moving / dt)
    basis = Basis.bumps(ticks, dt, KNOT)
    found = worst_pairs(scheme(name, dt), Schedule.of(link, link, ticks), basis, IMPEDANCE, count)
    hand, far = np.hsplit(found.amounts, 2)
    return Pairs(hand @ basis.x.T, IMPEDANCE * far @ basis.v.T, found.rates)


def conspire(
    name: SchemeName, connection: Connection, link: LinkModel, dt: float, moving: float = MOVING
) -> list[Row]:
    """The worst pair, without control and with it."""
    worst = pairs(name, link, dt, 1, moving)
    x, force, size = worst.mix(np.ones(1), dt)
    about = {
        "scheme": name.value,
        "delay_s": connection.delay,
        "jitter_s": connection.spread,
        "loss": connection.loss,
        "trouble": connection.trouble.value,
        "forecast_j": float(worst.energy[0]) * size**2,
        "speed_m_s": float(np.max(np.abs(np.diff(x)))) / dt,
        "force_n": float(np.max(np.abs(force))),
    }
    return [
        {
            **about,
            "passivity_control": control,
            "ledger_min_j": attempt(name, link, x, force, dt, control=control).least.channel,
        }
        for control in (False, True)
    ]


def attempt(
    name: SchemeName, link: LinkModel, x: Array, force: Array, dt: float, *, control: bool
) -> Trace:
    """What comes of it, by ports that hold the newest wave."""
    where = Place(
        mapping=LINE, force=AsTold(), follower=Told(force), tip_w=np.array([force[0], 0.0, 0.0])
    )
    hand: Any = puppet(x, dt, 1)
    both = connect(where, scheme(name, dt), hand, link, control=control, correction=control)
    return drive(both, where.follower, where.tip_w, len(force) * dt + AFTER, far=np.inf)
