"""What `sinuous bench link` does for one connection: a task that any process can take."""

from collections.abc import Sequence
from dataclasses import dataclass, field, fields
from typing import Any

import numpy as np

from sinuous.bench.link_cost import cost
from sinuous.bench.link_drift import drift
from sinuous.bench.link_evolve import evolve
from sinuous.bench.link_grid import Cell, Connection, Contact, Hand, SchemeName
from sinuous.bench.link_hand import ARMS, DURATION, arm
from sinuous.bench.link_models import model
from sinuous.bench.link_pairs import MOVING, conspire
from sinuous.bench.link_rig import row, scheme
from sinuous.bench.link_summary import DT
from sinuous.bench.link_worst import Worst, search
from sinuous.bench.result import Row
from sinuous.teleop.link import LinkModel
from sinuous.teleop.operators import Operator
from sinuous.teleop.worst_case import Schedule


@dataclass(frozen=True, kw_only=True)
class Task:
    """What to do with a connection.

    Arguments:
        connection: which one
        seed: of its luck, and of all that is drawn
        contacts: that are tried in cells
        duration: of a run [s]
        pairs: whether both ends conspire
        cost: whether control is compared with none
        drift: how long the hand moves about, in all [s]; zero for not at all
        tries: of evolution under control; zero for none
    """

    connection: Connection
    seed: int
    contacts: tuple[Contact, ...] = ()
    duration: float = DURATION
    pairs: bool = False
    cost: bool = False
    drift: float = 0.0
    tries: int = 0

    @property
    def moving(self) -> float:
        """How long both ends act when they conspire [s]."""
        return min(MOVING, self.duration)

    @property
    def link(self) -> LinkModel:
        """Both ways."""
        return model(self.connection, self.seed, DT)

    @property
    def name(self) -> str:
        """For the progress bar."""
        c = self.connection
        parts = [f"{c.delay * 1e3:g} ms", f"jitter {c.jitter:.0%}", f"loss {c.loss:.0%}"]
        return ", ".join([*parts, c.trouble.value] if c.trouble.value != "-" else parts)


@dataclass(frozen=True, kw_only=True)
class Found:
    """What there is to say.

    Arguments:
        rows: one for each cell
        worst: what the search for the worst operator has found
        pairs: what both ends together could do
        evolved: what was found under control
        drift: after a minute
        cost: of control on a clean connection
    """

    rows: list[Row] = field(default_factory=list[Row])
    worst: list[Row] = field(default_factory=list[Row])
    pairs: list[Row] = field(default_factory=list[Row])
    evolved: list[Row] = field(default_factory=list[Row])
    drift: list[Row] = field(default_factory=list[Row])
    cost: list[Row] = field(default_factory=list[Row])

    def add(self, other: "Found") -> None:
        """Take in what another has found."""
        for each in fields(self):
            getattr(self, each.name).extend(getattr(other, each.name))


def work(task: Task) -> Found:
    """All of it, for every scheme."""
    found, link = Found(), task.link
    for name in SchemeName:
        for contact in task.contacts:
            _cells(task, name, contact, found)
        if task.pairs:
            found.pairs.extend(conspire(name, task.connection, link, DT, task.moving))
        if task.tries:
            rng = np.random.default_rng(task.seed)
            found.evolved.append(
                evolve(
                    name, task.connection, link, DT, tries=task.tries, rng=rng, moving=task.moving
                )
            )
        if task.drift:
            found.drift.extend(drift(name, task.connection, link, DT, task.drift))
        if task.cost:
            found.cost.extend(cost(name, task.connection, link, DT))
    return found


def _cells(task: Task, name: SchemeName, contact: Contact, found: Found) -> None:
    """Look for the worst case, then let all hands try, without control and with it."""
    link = task.link
    schedule = Schedule.of(link, link, round(task.duration / DT))
    worst = search(scheme(name, DT), schedule, contact)
    connection = task.connection
    found.worst.append(
        {
            "scheme": name.value,
            "delay_s": connection.delay,
            "jitter_s": connection.spread,
            "loss": connection.loss,
            "trouble": connection.trouble.value,
            "contact": contact.value,
            **worst.row,
        }
    )
    for control in (False, True):
        for hand in Hand:
            cell = Cell(
                scheme=name, control=control, connection=connection, hand=hand, contact=contact
            )
            who = _who(hand, worst, 3 if contact is Contact.MESH else 1)
            found.rows.append(row(cell, who, link, DT, task.duration))


def _who(hand: Hand, worst: Worst, axes: int) -> Sequence[Operator[Any]]:
    return worst.operators(DT, axes) if hand is Hand.WORST else (arm(ARMS[hand], axes),)
