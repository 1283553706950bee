"""What docs/devices.md shows: its table is true, its code runs."""

import re
import sys
from pathlib import Path
from types import ModuleType, SimpleNamespace
from typing import Any

import numpy as np
import pytest

from sinuous import leaders
from sinuous.leaders import Leader

PAGE = (Path(__file__).parents[2] / "docs/devices.md").read_text(encoding="utf-8")
EXAMPLE, TOUCH = re.findall(r"```python\n(.*?)```", PAGE, flags=re.DOTALL)
CLASSES: list[type[Leader]] = [
    leaders.Gizmo,
    leaders.Keyboard,
    leaders.TerminalKeyboard,
    leaders.Gamepad,
    leaders.SpaceMouse,
    leaders.Haply,
    leaders.Trajectory,
]


@pytest.mark.parametrize("leader", CLASSES)
def test_the_table_says_what_each_driver_says(leader: type[Leader]) -> None:
    rows = {line.split("|")[1].strip(): line for line in PAGE.splitlines() if line[:1] == "|"}
    cells = [cell.strip() for cell in rows[leader.about.name].split("|")[1:-1]]
    assert cells[1:3] == [leader.about.axes, leader.about.force.value]
    assert cells[4] == {None: "needs none", False: "no", True: "yes"}[leader.about.run_on_hardware]


def test_no_driver_claims_hardware_that_it_never_met() -> None:
    assert all(leader.about.run_on_hardware is not True for leader in CLASSES)
    assert str(leaders.SpaceMouse.about).endswith("force: none; never run on hardware")
    assert str(leaders.Gizmo.about) == "gizmo: dragged on the page; force: none"


def test_the_example_runs(capsys: pytest.CaptureFixture[str]) -> None:
    exec(compile(EXAMPLE, "docs/devices.md", "exec"), {})
    assert capsys.readouterr().out.endswith("True True\n")


@pytest.fixture
def openhaptics(monkeypatch: pytest.MonkeyPatch) -> SimpleNamespace:
    """A stand-in for the device and its package."""
    touch = SimpleNamespace(at=[0.0, 0.0, 0.0], buttons=0, force=None, tick=None, closed=False)
    hd: Any = ModuleType("pyOpenHaptics.hd")
    hd.get_transform = lambda: [[0.0] * 4] * 3 + [[*touch.at, 1.0]]
    hd.get_buttons = lambda: touch.buttons
    hd.set_force = lambda force: setattr(touch, "force", force)
    callback: Any = ModuleType("pyOpenHaptics.hd_callback")
    callback.hd_callback = lambda function: function
    device: Any = ModuleType("pyOpenHaptics.hd_device")

    def connect(*, callback: object, scheduler_type: str) -> SimpleNamespace:
        touch.tick = callback
        return SimpleNamespace(close=lambda: setattr(touch, "closed", True))

    device.HapticDevice = connect
    package: Any = ModuleType("pyOpenHaptics")
    package.hd = hd
    for module in (package, hd, callback, device):
        monkeypatch.setitem(sys.modules, module.__name__, module)
    return touch


def test_the_driver_for_the_touch_turns_axes_and_lets_go(openhaptics: SimpleNamespace) -> None:
    names: dict[str, Any] = {"__name__": "touch"}
    exec(compile(TOUCH, "docs/devices.md", "exec"), names)
    touch = openhaptics
    with names["Touch"]() as leader:
        touch.tick()
        assert not leader.read(0.0).held
        touch.buttons = 1
        touch.tick()
        leader.read(0.001)
        touch.at = [10.0, 20.0, -30.0]  # right, up, away [mm]
        touch.tick()
        hand = leader.read(0.002)
        assert hand.held
        np.testing.assert_allclose(hand.position, [0.01, 0.03, 0.02])
        leader.feel(np.array([0.1, 0.2, 0.3]))
        touch.tick()
        np.testing.assert_allclose(touch.force, [0.1, 0.3, -0.2])
        leader.feel(np.array([0.0, 9.0, 0.0]))
        touch.tick()
        np.testing.assert_allclose(touch.force, [0.0, 0.0, -0.5])
        leader.feel(np.full(3, np.nan))
        touch.tick()
        assert not np.any(touch.force)
        leader.feel(np.ones(3))
        for _ in range(20):
            touch.tick()
        assert not np.any(touch.force), "the session hangs and the device still pushes"
        leader.read(0.003)
        lost = leader.read(0.2)
        assert not lost.connected
        np.testing.assert_array_equal(lost.position, hand.position)
    assert touch.closed
