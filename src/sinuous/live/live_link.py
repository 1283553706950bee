"""A connection that may become another one while packets are under way."""

from sinuous.teleop.link import Link, LinkModel, Packet


class LiveLink:
    """One way, whose kind may change.

    What was sent on the old one arrives as it would have, between the packets of the new one: to
    both ends that is a network with jitter. So passivity control, which needs nothing of a network
    but that the sums in its packets were true when they were sent, holds through the change.

    Arguments:
        model: to begin with
        way: 0 to the follower, 1 back to the leader
    """

    def __init__(self, model: LinkModel, way: int) -> None:
        self._way, self._dt = way, model.dt
        self._now = model.open(way)
        self._old: tuple[_Old, ...] = ()

    def become(self, model: LinkModel, longest: float) -> None:
        """Be of another kind from the next packet on.

        Arguments:
            model: of the new kind
            longest: time after which nothing is under way on the present one [s]
        """
        left = round(longest / self._dt) + 1
        self._old = (*self._old, _Old(self._now, left))
        self._now = model.open(self._way)

    def step(self, sent: Packet) -> tuple[Packet, ...]:
        """Take what is sent in this tick and yield all that the other end has by the next."""
        arrived = self._now.step(sent)
        if not self._old:
            return arrived
        late = [packet for old in self._old for packet in old.step(sent)]
        self._old = tuple(old for old in self._old if old.left > 0)
        return (*late, *arrived)


class _Old:
    """A link that is only waited for: what has to be put in for time to pass is thrown away."""

    def __init__(self, link: Link, left: int) -> None:
        self._link, self.left, self._after = link, left, -1

    def step(self, sent: Packet) -> tuple[Packet, ...]:
        """What arrives of the packets from before the change."""
        if self._after < 0:
            self._after = sent.number
        self.left -= 1
        return tuple(one for one in self._link.step(sent) if one.number < self._after)
