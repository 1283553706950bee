"""What session and page tell each other, beside snapshots and orders."""

from dataclasses import dataclass

from sinuous.live import Recipe
from sinuous.live.processes import LeaderMaker


@dataclass(frozen=True, kw_only=True)
class Desk:
    """What the page's process has to know.

    Arguments:
        port: to serve at; the next free one if it is taken
        hands: makers of devices by what they are called, the one in use first
        parent: the process that must be alive
    """

    port: int
    hands: dict[str, LeaderMaker]
    parent: int


@dataclass(frozen=True)
class Serving:
    """The page is there.

    Arguments:
        port: of this machine
        address: to open
    """

    port: int
    address: str


@dataclass(frozen=True)
class Begun:
    """Loops have begun, or begun again.

    Arguments:
        recipe: of their scenario
    """

    recipe: Recipe


@dataclass(frozen=True)
class Recording:
    """Whether what happens is recorded.

    Arguments:
        folder: where to; None if it is not
    """

    folder: str | None


@dataclass(frozen=True)
class Told:
    """Something that people should read.

    Arguments:
        text: what happened
        lasting: whether nothing goes on until it is dealt with
    """

    text: str
    lasting: bool = False
