"""Hands by name: one that is there is made in another process, one that is not is said so."""

import os
import pickle
import pty
import subprocess
import sys
import termios
import time
from collections.abc import Iterator
from contextlib import suppress
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.cli import teleop_leaders
from sinuous.cli.teleop import teleop
from sinuous.cli.teleop_arguments import Teleop
from sinuous.cli.teleop_leaders import MOVED, leader_choice, recorded_run
from sinuous.errors import InputError
from sinuous.leaders import Gizmo, Haply, Leader, TerminalKeyboard, Trajectory
from sinuous.live import PathHand, Recipe
from sinuous.live.hand import HandSide

SCENARIOS = Path(__file__).parents[2] / "examples" / "scenarios"


def test_makers_can_be_sent_to_another_process(tmp_path: Path) -> None:
    scenario = Recipe(str(SCENARIOS / "live_watchdog.toml")).make()
    file = tmp_path / "hand.csv"
    file.write_text("t_s,x_mm,y_mm,z_mm\n0,0,0,0\n1,1,2,3\n")
    for name, kind in (("recorded", PathHand), (str(file), Trajectory)):
        maker = pickle.loads(pickle.dumps(leader_choice(name).make))
        assert isinstance(maker(scenario), kind)


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("joystick", "expected one of gizmo, recorded, keyboard"),
        ("gamepad", "expected a gamepad"),
        ("spacemouse", "expected a SpaceMouse"),
        ("haply", "expected the Haply Inverse service"),
        ("nowhere.csv", "nowhere.csv"),
        ("nowhere.mcap", "expected a recording"),
    ],
)
def test_what_cannot_be_had_is_said_before_anything_starts(name: str, words: str) -> None:
    with pytest.raises(InputError, match=words):
        leader_choice(name)


def test_a_package_that_is_missing_is_named_with_its_extra(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setitem(sys.modules, "sdl2", None)
    with pytest.raises(InputError, match=r"sinuous\[gamepad\]"):
        leader_choice("gamepad")


def test_a_device_with_a_true_force_is_moved_and_not_modelled(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(Haply, "open", Leader.open)
    monkeypatch.setattr(Haply, "close", Leader.close)
    choice = leader_choice("haply")
    assert choice.fields == MOVED
    assert leader_choice("recorded").fields == ()
    file = str(SCENARIOS / "live_watchdog.toml")
    teleop = Recipe(file, choice.fields).make().teleop
    assert teleop is not None
    assert teleop.table.operator.kind.value == "trajectory"


@pytest.mark.parametrize("axes", [2, 3])
def test_the_hand_of_a_recording_moves_as_it_did(
    axes: int, monkeypatch: pytest.MonkeyPatch
) -> None:
    moved = np.cumsum(np.random.default_rng(1).normal(scale=1e-4, size=(50, axes)), axis=0)

    def signal(name: str) -> Array:
        return moved

    def read(path: str) -> SimpleNamespace:
        return SimpleNamespace(signal=signal, header=SimpleNamespace(tick=0.002))

    monkeypatch.setattr(teleop_leaders, "read", read)
    hand = recorded_run("run.mcap")
    places = np.array([hand.read(0.002 * k).position for k in range(50)])
    columns = [0, 1, 2] if axes == 3 else [0, 2]
    np.testing.assert_allclose(places[:, columns], moved - moved[0], atol=1e-11)
    assert hand.duration == pytest.approx(0.098)


class Felt(Gizmo):
    """Notes what it is told to show."""

    def __init__(self) -> None:
        super().__init__()
        self.forces = list[Array]()

    def feel(self, force: Array) -> None:
        self.forces.append(force)


def test_the_force_of_the_live_loop_reaches_the_device() -> None:
    scenario = Recipe(str(SCENARIOS / "live_watchdog.toml")).make()
    assert scenario.teleop is not None
    tip, leader = scenario.robot.tip(scenario.first_configuration), Felt()
    side = HandSide(scenario.teleop, tip, leader)
    leader.aim(np.array([0.03, 0.0, 0.0]), 1.0)
    for _ in range(600):
        side.tick(tip)  # a tip that does not follow is one that drags
    assert len(leader.forces) == 600
    assert leader.forces[-1][0] < -0.01, "towards where the tip is held"


@pytest.fixture
def terminal() -> Iterator[tuple[int, int]]:
    """What a user types into, and the terminal of a program."""
    ends = pty.openpty()
    yield ends
    for end in ends:
        with suppress(OSError):
            os.close(end)


# The first terminal that the leader of a session opens is its controlling one.
PROGRAM = """
import os, sys
os.open(sys.argv[1], os.O_RDWR)
from sinuous.cli.teleop_leaders import leader_choice
from sinuous.live import LiveSession, Recipe
session = LiveSession(
    Recipe(sys.argv[2]),
    leader_choice("keyboard").make,
    started=lambda *_: print("Live", flush=True),
)
print(session.run(float(sys.argv[3]), record=sys.argv[4]).end.name, flush=True)
"""


@pytest.mark.skipif(sys.platform != "linux", reason="controlling terminals of Linux")
@pytest.mark.parametrize("end", ["FINISHED", "INTERRUPTED"])
def test_keys_of_the_terminal_move_the_hand_in_its_own_process(
    terminal: tuple[int, int], tmp_path: Path, end: str
) -> None:
    typed, seen = terminal
    before = termios.tcgetattr(seen)
    duration = "2.5" if end == "FINISHED" else "60"
    scenario, out = str(SCENARIOS / "live_watchdog.toml"), str(tmp_path / "run")
    command = [sys.executable, "-c", PROGRAM, os.ttyname(seen), scenario, duration, out]
    with subprocess.Popen(
        command, stdin=seen, stdout=subprocess.PIPE, text=True, start_new_session=True
    ) as program:
        assert program.stdout is not None
        assert program.stdout.readline() == "Live\n"
        for _ in range(15):
            os.write(typed, b"\x1b[C")
            time.sleep(0.1)
        if end == "INTERRUPTED":
            os.write(typed, b"\x03")
        assert program.stdout.readline() == f"{end}\n"
        assert program.wait(60.0) == 0
    assert termios.tcgetattr(seen) == before
    hand = recorded_run(str(tmp_path / "run" / "run.mcap"))
    assert hand.read(0.0).position[0] == 0.0
    assert hand.read(hand.duration).position[0] > 0.005, "1.5 s at 30 mm/s, against a force"


def test_without_a_terminal_the_keyboard_says_so() -> None:
    code = "from sinuous.cli.teleop_leaders import leader_choice; leader_choice('keyboard')"
    program = subprocess.run(
        [sys.executable, "-c", code], capture_output=True, text=True, start_new_session=True
    )
    assert "expected a terminal, found that there is none" in program.stderr


def test_the_terminal_itself_is_the_default(
    terminal: tuple[int, int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("sinuous.leaders.terminal.TERMINAL", os.ttyname(terminal[1]))
    with TerminalKeyboard():
        assert not termios.tcgetattr(terminal[1])[3] & termios.ICANON
    assert termios.tcgetattr(terminal[1])[3] & termios.ICANON


def test_a_gizmo_without_its_page_is_refused() -> None:
    with pytest.raises(InputError, match="needs no page"):
        teleop(Teleop(leader="gizmo", browser=False))
