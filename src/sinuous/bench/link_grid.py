"""What `sinuous bench link` goes through: connections, and what is tried on each of them."""

from collections.abc import Iterator
from dataclasses import dataclass
from enum import StrEnum
from itertools import product

LEAST_JITTERED = 0.02  # delays below count as this one where jitter is a share of them [s]


class SchemeName(StrEnum):
    """How velocity and force travel."""

    STANDARD = "standard"
    C1 = "C1"
    C2 = "C2"
    POSITION_FORCE = "position-force"


class Hand(StrEnum):
    """Who holds the device."""

    RELAXED = "relaxed"
    STIFF = "stiff"
    WORST = "worst case"


class Contact(StrEnum):
    """What the follower meets."""

    FREE = "free"
    BOX = "box"  # the side of a virtual box
    MESH = "mesh"  # the wall of a tube, under the model predictive controller


class Trouble(StrEnum):
    """What a connection does besides delay, jitter and loss."""

    NONE = "-"
    REORDERING = "reordering"
    OUTAGES = "outages"
    STEPS = "delay steps"


@dataclass(frozen=True, kw_only=True)
class Connection:
    """Both ways of it.

    Arguments:
        delay: on average, one way [s]
        jitter: largest departure from it, as a share of it; of `LEAST_JITTERED` if it is shorter
        loss: share of packets that do not arrive
        trouble: what comes on top
    """

    delay: float
    jitter: float
    loss: float
    trouble: Trouble = Trouble.NONE

    @property
    def spread(self) -> float:
        """Largest departure from the delay [s]."""
        return self.jitter * max(self.delay, LEAST_JITTERED)

    @property
    def is_clean(self) -> bool:
        """Whether every packet takes the same time."""
        return self.jitter == self.loss == 0.0 and self.trouble is Trouble.NONE


DELAYS, JITTERS, LOSSES = (0.0, 0.05, 0.2, 0.7), (0.0, 0.2, 0.5), (0.0, 0.1, 0.3)
TROUBLES = (Trouble.REORDERING, Trouble.OUTAGES, Trouble.STEPS)

GRID = tuple(
    Connection(delay=delay, jitter=jitter, loss=loss)
    for delay, jitter, loss in product(DELAYS, JITTERS, LOSSES)
)
TROUBLED = tuple(
    Connection(delay=delay, jitter=0.2, loss=0.1, trouble=trouble)
    for delay, trouble in product(DELAYS, TROUBLES)
)
MESHED = tuple(
    Connection(delay=delay, jitter=0.2, loss=0.1, trouble=trouble)
    for delay, trouble in product((0.05, 0.2, 0.7), (Trouble.NONE, *TROUBLES))
)
"""Connections that are tried in contact with a mesh, too."""


@dataclass(frozen=True, kw_only=True)
class Cell:
    """One row.

    Arguments:
        scheme: of the waves
        control: whether the ports keep the channel passive
        connection: between them
        hand: of the operator
        contact: of the follower
    """

    scheme: SchemeName
    control: bool
    connection: Connection
    hand: Hand
    contact: Contact


def cells(connections: tuple[Connection, ...], contact: Contact) -> Iterator[Cell]:
    """All schemes with and without control, in every hand."""
    for connection, scheme, control, hand in product(connections, SchemeName, (False, True), Hand):
        yield Cell(
            scheme=scheme, control=control, connection=connection, hand=hand, contact=contact
        )
