"""What carries packets from one end to the other, one way, and takes its time."""

from collections import deque
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from sinuous.arrays import Array
from sinuous.teleop.checks import positive, zero_or_more


class Packet(NamedTuple):
    """What one end tells the other in a tick.

    Arguments:
        wave: (A,)
        position: of the sender on the wave side (A,) [m]: the leader's, for a follower that
            corrects its drift; the follower's desired one
        number: of the packet, one more with every tick
        time: when it was sent [s]
        energy: that the sender has put into its waves since the start, this one included [J]
        running: whether the sender takes part, or wants to pause
    """

    wave: Array
    position: Array
    number: int = 0
    time: float = 0.0
    energy: float = 0.0
    running: bool = True


class Link(Protocol):
    """One way of a connection with packets under way: a simulated part, like a plant."""

    def step(self, sent: Packet) -> tuple[Packet, ...]:
        """Take what is sent in this tick and yield all that the other end has by the next."""
        ...


class LinkModel(Protocol):
    """A kind of connection."""

    @property
    def dt(self) -> float:
        """Time of a tick [s]."""
        ...

    def open(self, way: int = 0) -> Link:
        """One way of a connection, with nothing under way.

        Arguments:
            way: 0 to the follower, 1 back to the leader: each way has luck of its own
        """
        ...


@dataclass(frozen=True, kw_only=True)
class ConstantDelay:
    """Every packet takes the same time: the nearest whole number of ticks, one at least.

    Arguments:
        delay: one way [s]
        dt: time of a tick [s]

    Raises:
        ValueError: if the delay is negative or not finite, or dt not positive
    """

    delay: float
    dt: float = 1e-3

    def __post_init__(self) -> None:
        zero_or_more("delay", self.delay)
        positive("dt", self.dt)

    @property
    def ticks(self) -> int:
        """From the tick in which a packet is sent to the one in which it is received."""
        return max(round(self.delay / self.dt), 1)

    def open(self, way: int = 0) -> Link:
        """One way of a connection, with nothing under way."""
        return _Line(self.ticks)


class _Line:
    """Packets under way; what is sent in one tick can be had in the next at the earliest."""

    def __init__(self, ticks: int) -> None:
        self._under_way = deque[tuple[Packet, ...]]([()] * (ticks - 1))

    def step(self, sent: Packet) -> tuple[Packet, ...]:
        """Take what is sent in this tick and yield all that the other end has by the next."""
        self._under_way.append((sent,))
        return self._under_way.popleft()
