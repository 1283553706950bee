"""The two ends of a teleoperation, each of which could be a machine of its own."""

from sinuous.teleop.follower_end import FollowerEnd, FollowerSignals, FollowerState
from sinuous.teleop.leader_end import LeaderEnd, LeaderSignals, LeaderState

__all__ = [
    "FollowerEnd",
    "FollowerSignals",
    "FollowerState",
    "LeaderEnd",
    "LeaderSignals",
    "LeaderState",
]
