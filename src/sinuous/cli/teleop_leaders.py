"""What `--leader` means: a device by its name, or a hand that was recorded, by its file."""

from dataclasses import dataclass
from functools import partial
from pathlib import Path

import numpy as np

from sinuous.errors import InputError
from sinuous.leaders import (
    ForceKind,
    Gamepad,
    Haply,
    Leader,
    SpaceMouse,
    TerminalKeyboard,
    Trajectory,
)
from sinuous.live import PathHand
from sinuous.live.path_hand import hand_axes
from sinuous.live.processes import LeaderMaker
from sinuous.recording import read
from sinuous.scenario import Scenario
from sinuous.view.page.hands import gizmo_hand

GIZMO, RECORDED = "gizmo", "recorded"
DEVICES: dict[str, type[Leader]] = {
    "keyboard": TerminalKeyboard,
    "gamepad": Gamepad,
    "spacemouse": SpaceMouse,
    "haply": Haply,
}
NAMES = (GIZMO, RECORDED, *DEVICES, "FILE.csv", "FILE.mcap")

MOVED = ("teleop.operator.kind=trajectory",)
"""Fields of a scenario whose device is moved as the hand moves: it is the device itself that gives
way to a force, not a model of the hand that holds it."""


@dataclass(frozen=True, kw_only=True)
class Choice:
    """A hand for a session.

    Arguments:
        make: makes it in the process that reads it
        fields: of the scenario that it needs, as on the command line
    """

    make: LeaderMaker
    fields: tuple[str, ...] = ()


def leader_choice(name: str) -> Choice:
    """The hand that a name means, once it is known that it can be had.

    A device is opened and closed again, so that what is missing is said here and not by another
    process in the middle of a session.

    Arguments:
        name: one of `NAMES`, or a file or folder of a recording

    Raises:
        InputError: if there is no such name or file, the device is not there, or its package is
            not installed
    """
    if name == GIZMO:
        return Choice(make=gizmo_hand)
    if name == RECORDED:
        return Choice(make=PathHand)
    device = DEVICES.get(name)
    if device is not None:
        with device():
            pass
        moved = device.about.force is ForceKind.TRUE
        return Choice(make=partial(_device, name), fields=MOVED if moved else ())
    path = Path(name)
    if path.suffix.lower() == ".mcap" or path.is_dir():
        recording = path / "run.mcap" if path.is_dir() else path
        recorded_run(str(recording))
        return Choice(make=partial(_run, str(recording)))
    if path.suffix.lower() != ".csv" and not path.exists():
        raise InputError(
            file="--leader",
            expected=f"one of {', '.join(NAMES)}",
            found=f'"{name}"',
            remedy="Choose one, or give the path of an existing recording.",
        )
    Trajectory.load(name)
    return Choice(make=partial(csv_hand, name))


def recorded_run(path: str) -> Trajectory:
    """The motion of the leader's end in an earlier run (metres of the leader).

    Raises:
        InputError: if it is no recording, or nobody's hand was in it
    """
    recording = read(path)
    try:
        moved = recording.signal("leader_m")
    except KeyError:
        moved = np.empty((0, 3))
    if len(moved) < 2:
        raise InputError(
            file=path,
            expected="a recording of a hand",
            found="a run without one",
            remedy="Give one of `sinuous teleop`, or of a scenario with [teleop].",
        )
    places = np.zeros((len(moved), 3))
    places[:, hand_axes(moved.shape[1])] = moved
    return Trajectory(recording.header.tick * np.arange(len(moved)), places)


# A scenario comes with each call; functions of a module can be sent to another process.


def _device(name: str, scenario: Scenario) -> Leader:
    return DEVICES[name]()


def csv_hand(path: str, scenario: Scenario) -> Leader:
    """The hand of a CSV file."""
    return Trajectory.load(path)


def _run(path: str, scenario: Scenario) -> Leader:
    return recorded_run(path)
