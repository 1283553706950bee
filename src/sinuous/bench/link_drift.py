"""A minute of moving about on a connection that loses packets, and what stays of it at rest."""

import numpy as np

from sinuous.arrays import Array
from sinuous.bench import link_hand
from sinuous.bench.link_drive import drive
from sinuous.bench.link_follower import place
from sinuous.bench.link_grid import Connection, Contact, SchemeName
from sinuous.bench.link_hand import DURATION, STIFF
from sinuous.bench.link_rig import connect, scheme
from sinuous.bench.result import Row
from sinuous.teleop.link import LinkModel
from sinuous.teleop.operators import ImpedanceOperator

MINUTE, AT_REST = 60.0, 10.0  # how long it takes, and how long of it the hand rests at the end [s]
LAST = 0.1  # drift is averaged over that [s]

KINDS = {"none": (False, False), "control": (True, False), "control, correction": (True, True)}
"""Whether there is passivity control, and correction of drift."""


class Repeated:
    """The path again and again, and rest in the end.

    Arguments:
        until: when no new round begins [s]
    """

    def __init__(self, until: float) -> None:
        self._until = DURATION * max(int(until / DURATION), 1)

    def __call__(self, time: float) -> Array:
        """The goal (1,) [m]."""
        return np.array([link_hand.place(time % DURATION if time < self._until else DURATION)])


def drift(
    name: SchemeName, connection: Connection, link: LinkModel, dt: float, duration: float
) -> list[Row]:
    """How far apart both ends are at rest, with and without what can be done about it."""
    rows = list[Row]()
    goal = Repeated(duration - AT_REST)
    hand = ImpedanceOperator(goal, stiffness=STIFF.stiffness, damping=STIFF.damping)
    for kind, (control, correction) in KINDS.items():
        where = place(Contact.FREE, dt)
        both = connect(where, scheme(name, dt), hand, link, control=control, correction=correction)
        trace = drive(both, where.follower, where.tip_w, duration)
        apart = np.abs(trace.X_sd - trace.X)[-round(LAST / dt) :]
        rows.append(
            {
                "scheme": name.value,
                "delay_s": connection.delay,
                "loss": connection.loss,
                "kind": kind,
                "drift_m": float(np.mean(apart)),
                "ledger_min_j": trace.least.channel,
            }
        )
    return rows
