"""Runs a scenario in real time, with a device in a real hand.

Everything that is simulated is as in `session`; only this package reads the wall clock.
"""

from sinuous.live.clock import Clock, SteppedClock, WallClock
from sinuous.live.orders import (
    Aim,
    Order,
    PageLost,
    Pause,
    Record,
    Reset,
    Resume,
    SetFeel,
    SetLink,
    Stop,
)
from sinuous.live.path_hand import PathHand
from sinuous.live.scenario import Recipe
from sinuous.live.session import LiveEnd, LiveResult, LiveSession
from sinuous.live.snapshot import Snapshot

__all__ = [
    "Aim",
    "Clock",
    "LiveEnd",
    "LiveResult",
    "LiveSession",
    "Order",
    "PageLost",
    "PathHand",
    "Pause",
    "Recipe",
    "Record",
    "Reset",
    "Resume",
    "SetFeel",
    "SetLink",
    "Snapshot",
    "SteppedClock",
    "Stop",
    "WallClock",
]
