"""Starting, stopping, pausing and going on without a kick."""

from dataclasses import dataclass

from sinuous.teleop.checks import positive


@dataclass(frozen=True)
class Ramp:
    """How an end joins and leaves the channel: by a transformer whose ratio rho ramps.

    An end that takes part by a share rho of 0 to 1 shows its port rho of its velocity, and is shown
    rho of the port's force (the leader's end), or shows rho of its force and is shown rho of the
    velocity (the follower's). At either side of the transformer the power is the same,

        F_m . v_m = (rho F) . v_m = F . (rho v_m),

    in every tick and however rho changes: joining and leaving make no energy and lose none. With
    rho = 0 the end is on its own: no force is felt, the desired point stands still, and waves of
    before die away unused. An end takes part as long as it and the other end want to.

    When the follower's end joins again, its desired point starts from where the follower is, and
    where the leader is then is where it belongs: nothing that was moved in the pause is caught up
    with.

    Arguments:
        duration: of a ramp from 0 to 1 or back [s]

    Raises:
        ValueError: if it is not positive
    """

    duration: float = 0.5

    def __post_init__(self) -> None:
        positive("duration", self.duration)

    def step(self, share: float, dt: float, *, join: bool) -> float:
        """rho of the next tick, after one of dt [s]."""
        change = dt / self.duration
        return min(share + change, 1.0) if join else max(share - change, 0.0)
