"""Devices in the operator's hand: one interface in metres and newtons, a driver for each."""

from sinuous.leaders.gamepad import Gamepad
from sinuous.leaders.gizmo import Gizmo
from sinuous.leaders.haply import Haply
from sinuous.leaders.keyboard import Keyboard
from sinuous.leaders.leader import About, ForceKind, Hand, Leader
from sinuous.leaders.motion import Rates, Smoothing
from sinuous.leaders.spacemouse import SpaceMouse
from sinuous.leaders.terminal import TerminalKeyboard
from sinuous.leaders.trajectory import Trajectory

__all__ = [
    "About",
    "ForceKind",
    "Gamepad",
    "Gizmo",
    "Hand",
    "Haply",
    "Keyboard",
    "Leader",
    "Rates",
    "Smoothing",
    "SpaceMouse",
    "TerminalKeyboard",
    "Trajectory",
]
