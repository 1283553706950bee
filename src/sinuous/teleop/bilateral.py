"""Both ends and the connection between them, on one clock."""

from dataclasses import dataclass
from typing import Generic, NamedTuple, Self

from sinuous.arrays import ArrayLike
from sinuous.teleop.drift import DriftCorrection
from sinuous.teleop.follower_end import FollowerEnd, FollowerSignals, FollowerState
from sinuous.teleop.force import VirtualForce
from sinuous.teleop.leader import LeaderDevice
from sinuous.teleop.leader_end import LeaderEnd, LeaderSignals, LeaderState
from sinuous.teleop.limits import Limits
from sinuous.teleop.link import ConstantDelay, Link, LinkModel
from sinuous.teleop.mapping import Mapping
from sinuous.teleop.motion import NO_WALLS, Walls
from sinuous.teleop.operators import O, Operator
from sinuous.teleop.passivity import PassivityControl
from sinuous.teleop.ramp import Ramp
from sinuous.teleop.receivers import Packets, Receiver, ZeroFill
from sinuous.teleop.scheme import Scheme
from sinuous.teleop.waves import ModifiedWaves


class Signals(NamedTuple):
    """What there is to see in a tick.

    Arguments:
        time: when it begins [s]
        leader: of the leader's end
        follower: of the follower's end
    """

    time: float
    leader: LeaderSignals
    follower: FollowerSignals


class BilateralState(NamedTuple, Generic[O]):
    """What both ends remember, and the connection between them.

    The links are simulated parts that change with every tick, so a state can be gone on from once.

    Arguments:
        leader, follower: what the ends remember
        forward, backward: the links, with the packets under way
        to_leader, to_follower: all that arrives for the next tick
    """

    leader: LeaderState[O]
    follower: FollowerState
    forward: Link
    backward: Link
    to_leader: Packets
    to_follower: Packets


@dataclass(frozen=True, kw_only=True, eq=False)
class Bilateral(Generic[O]):
    """Operator -> leader -> mapping -> port -> link -> port -> desired point, and back.

    In a tick both ends step with what has arrived; what they send arrives a tick later or more.

    Arguments:
        leader: the one end
        follower: the other
        forward, backward: what connects them, to the follower and back to the leader

    Raises:
        ValueError: if the parts have different ticks, axes, schemes or control
    """

    leader: LeaderEnd[O]
    follower: FollowerEnd
    forward: LinkModel
    backward: LinkModel

    def __post_init__(self) -> None:
        if self.leader.scheme != self.follower.scheme:
            raise ValueError("both ends must use the same scheme")
        if (self.leader.control is None) != (self.follower.control is None):
            raise ValueError("passivity control takes both ends: each says what it has sent")
        if self.leader.mapping.scale.size != self.follower.mapping.scale.size:
            raise ValueError("both ends must have the same number of axes")
        for name, link in (("forward", self.forward), ("backward", self.backward)):
            if link.dt != self.dt:
                raise ValueError(f"{name} must have ticks of {self.dt} s, not {link.dt}")

    @classmethod
    def connect(
        cls,
        *,
        operator: Operator[O],
        mapping: Mapping,
        force: VirtualForce,
        scheme: Scheme | None = None,
        delay: float = 0.0,
        link: LinkModel | None = None,
        receiver: Receiver | None = None,
        control: PassivityControl | None = None,
        device: LeaderDevice | None = None,
        correction: DriftCorrection | None = None,
        felt: Limits | None = None,
        speed: Limits | None = None,
        ramp: Ramp | None = None,
    ) -> Self:
        """Both ends with the same scheme, mapping and receiver, and the same link both ways.

        Arguments:
            operator: whoever holds the device
            mapping: from the device's workspace to the world
            force: what the operator shall feel
            scheme: of the waves, by default the paper's own (C2)
            delay: one way, of a link that is always the same [s]
            link: another link than that
            receiver: which wave to use; by default the one that arrives in a tick, or zero
            control: of passivity; None for none, which is enough for a constant delay
            device: what is held
            correction: of the desired point's drift; None as printed
            felt: limits of the force from afar [N], [N/s]
            speed: limits of the desired velocity without a force [m/s], [m/s^2]
            ramp: for joining and leaving

        Raises:
            ValueError: if the delay is negative or not finite
        """
        scheme = ModifiedWaves.c2() if scheme is None else scheme
        link = ConstantDelay(delay=delay, dt=scheme.dt) if link is None else link
        receiver = ZeroFill() if receiver is None else receiver
        return cls(
            leader=LeaderEnd(
                scheme=scheme,
                mapping=mapping,
                operator=operator,
                device=device or LeaderDevice(),
                receiver=receiver,
                control=control,
                limits=felt,
                ramp=ramp or Ramp(),
            ),
            follower=FollowerEnd(
                scheme=scheme,
                mapping=mapping,
                force=force,
                correction=correction,
                receiver=receiver,
                control=control,
                limits=speed,
                ramp=ramp or Ramp(),
            ),
            forward=link,
            backward=link,
        )

    @property
    def dt(self) -> float:
        """Time of a tick [s]."""
        return self.leader.scheme.dt

    def init(self, tip_w: ArrayLike, *, running: bool = True) -> BilateralState[O]:
        """At rest, the follower's tip at (3,) [m], the leader where (22) puts it for that.

        Arguments:
            running: whether both ends take part from the start, or pause until `resume`

        Raises:
            ValueError: if the tip is not three finite numbers
        """
        follower = self.follower.init(tip_w, running=running)
        leader = self.leader.init(follower.X_sd, running=running)
        forward, backward = self.forward.open(0), self.backward.open(1)
        return BilateralState(leader, follower, forward, backward, (), ())

    def pause(self, state: BilateralState[O]) -> BilateralState[O]:
        """Have the leader leave the channel, and the follower as soon as it hears of it."""
        return state._replace(leader=self.leader.pause(state.leader))

    def resume(self, state: BilateralState[O]) -> BilateralState[O]:
        """Have both join it again."""
        return state._replace(leader=self.leader.resume(state.leader))

    def step(
        self, state: BilateralState[O], tip_w: ArrayLike, walls: Walls = NO_WALLS
    ) -> tuple[BilateralState[O], Signals]:
        """One tick, given the follower's measured tip (3,) [m]; never raises for bad numbers.

        Arguments:
            walls: that the follower's controller knows of
        """
        leader, follower, forward, backward, to_leader, to_follower = state
        time = leader.tick * self.leader.scheme.dt
        leader, at_leader, ahead = self.leader.step(leader, to_leader)
        follower, at_follower, back = self.follower.step(follower, tip_w, to_follower, walls)
        after = BilateralState(
            leader, follower, forward, backward, backward.step(back), forward.step(ahead)
        )
        return after, Signals(time, at_leader, at_follower)
