"""A pad that SDL itself believes to be plugged in, with sticks and motors."""

import ctypes
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from sinuous.errors import InputError
from sinuous.leaders import Gamepad, Hand, Rates
from sinuous.leaders.gamepad import DEAD_ZONE, deflection_of
from sinuous.leaders.sdl import Pad, load_sdl

from .eventually import eventually

DT = 0.001
LEFT_X, LEFT_Y, RIGHT_X, RIGHT_Y = 0, 1, 2, 3


class VirtualPad:
    """A gamepad of SDL's own making: its driver, not its events, is what is simulated."""

    def __init__(self) -> None:
        self.sdl: Any = load_sdl()
        self.rumbles = list[tuple[int, int]]()
        self._sticks, self._stick = [0] * 6, None
        sdl = self.sdl
        description = sdl.SDL_VirtualJoystickDesc()
        kinds = dict(description._fields_)
        self._rumble = kinds["Rumble"](self._note)
        self._update = kinds["Update"](self._show)
        description.version = sdl.SDL_VIRTUAL_JOYSTICK_DESC_VERSION
        description.type = sdl.SDL_JOYSTICK_TYPE_GAMECONTROLLER
        description.naxes, description.nbuttons = 6, 15
        description.vendor_id, description.product_id = 0x1234, 0x0001
        description.axis_mask, description.button_mask = 0x3F, 0x7FFF
        description.name = b"pad of the test"
        description.Rumble, description.Update = self._rumble, self._update
        self._description = description
        self.plug()

    def plug(self) -> None:
        self.index = self.sdl.SDL_JoystickAttachVirtualEx(ctypes.byref(self._description))
        assert self.index >= 0, self.sdl.SDL_GetError()
        self._stick = self.sdl.SDL_JoystickOpen(self.index)

    def pull(self) -> None:
        self.sdl.SDL_JoystickClose(self._stick)
        self._stick = None
        assert self.sdl.SDL_JoystickDetachVirtual(self.index) == 0

    def push(self, axis: int, counts: int) -> None:
        self._sticks[axis] = counts

    def quit(self) -> None:
        self.sdl.SDL_QuitSubSystem(self.sdl.SDL_INIT_GAMECONTROLLER)

    def _show(self, _: object) -> None:
        for axis, counts in enumerate(self._sticks if self._stick else ()):
            self.sdl.SDL_JoystickSetVirtualAxis(self._stick, axis, counts)

    def _note(self, _: object, low: int, high: int) -> int:
        self.rumbles.append((low, high))
        return 0


@pytest.fixture
def pad() -> Iterator[VirtualPad]:
    pad = VirtualPad()
    yield pad
    pad.quit()


def run(gamepad: Gamepad, since: float, seconds: float) -> Hand:
    """The hand after some time."""
    for k in range(round(seconds / DT) + 1):
        hand = gamepad.read(since + k * DT)
    return hand


def sticks(gamepad: Gamepad) -> Pad:
    said = gamepad._reader.latest.said
    return Pad(0.0, 0.0, 0.0) if said is None else said


@pytest.mark.parametrize(
    ("axis", "counts", "direction"),
    [
        (LEFT_X, 32767, [1, 0, 0]),
        (LEFT_X, -32768, [-1, 0, 0]),
        (LEFT_Y, 32767, [0, -1, 0]),  # SDL: down, towards the operator
        (LEFT_Y, -32768, [0, 1, 0]),
        (RIGHT_Y, 32767, [0, 0, -1]),
        (RIGHT_Y, -32768, [0, 0, 1]),
        (RIGHT_X, 32767, [0, 0, 0]),
    ],
)
def test_each_stick_moves_along_its_axis(
    pad: VirtualPad, axis: int, counts: int, direction: list[int]
) -> None:
    with Gamepad(Rates(speed=0.02, acceleration=0.2)) as gamepad:
        pad.push(axis, counts)
        assert eventually(lambda: any(sticks(gamepad)) or axis == RIGHT_X)
        hand = run(gamepad, 0.0, 1.0)
    np.testing.assert_allclose(hand.position, 0.019 * np.array(direction), atol=1e-6)


def test_forces_rumble_by_their_size_and_closing_ends_it(pad: VirtualPad) -> None:
    with Gamepad(strongest=2.0) as gamepad:
        gamepad.feel(np.array([0.0, 0.6, 0.8]))
        half = round(0xFFFF / 2)
        assert eventually(lambda: (half, half) in pad.rumbles)
        gamepad.feel(np.array([0.0, -30.0, 0.0]))
        assert eventually(lambda: (0xFFFF, 0xFFFF) in pad.rumbles)
        gamepad.feel(np.full(3, np.nan))
        assert eventually(lambda: pad.rumbles[-1] == (0, 0))
        gamepad.feel(np.array([2.0, 0.0, 0.0]))
        assert eventually(lambda: pad.rumbles[-1] != (0, 0))
    assert pad.rumbles[-1] == (0, 0)


def test_a_pad_that_is_pulled_out_holds_still_and_comes_back(pad: VirtualPad) -> None:
    gamepad = Gamepad()
    gamepad._reader._retry = 0.01
    with gamepad:
        pad.push(LEFT_X, 32767)
        assert eventually(lambda: sticks(gamepad).left_x == 1.0)
        before = run(gamepad, 0.0, 0.2)
        pad.pull()
        assert eventually(lambda: not gamepad.read(0.2).connected)
        lost = run(gamepad, 0.201, 0.2)
        assert np.linalg.norm(lost.position - before.position) <= 0.03 * DT
        pad.push(LEFT_X, 0)
        pad.plug()
        assert eventually(lambda: gamepad.read(0.401).connected)
        np.testing.assert_array_equal(run(gamepad, 0.402, 0.1).position, lost.position)


def test_no_events_pile_up(pad: VirtualPad) -> None:
    with Gamepad() as gamepad:
        pad.sdl.SDL_FlushEvents(pad.sdl.SDL_FIRSTEVENT, pad.sdl.SDL_LASTEVENT)
        for counts in range(-32000, 32001, 4000):
            pad.push(LEFT_X, counts)
            assert eventually(lambda counts=counts: seen(gamepad, counts))
        first, last = pad.sdl.SDL_JOYAXISMOTION, pad.sdl.SDL_CONTROLLERDEVICEREMAPPED
        assert pad.sdl.SDL_HasEvents(first, last) == pad.sdl.SDL_FALSE


def seen(gamepad: Gamepad, counts: int) -> bool:
    return abs(sticks(gamepad).left_x - counts / 32767.0) < 1e-6


def test_a_stick_that_rests_off_its_middle_does_not_drift() -> None:
    rest = Pad(0.7 * DEAD_ZONE, -0.7 * DEAD_ZONE, 0.9 * DEAD_ZONE)
    np.testing.assert_array_equal(deflection_of(rest), np.zeros(3))


def test_without_a_pad_the_message_says_so() -> None:
    with pytest.raises(InputError, match="expected a gamepad, found none among"):
        Gamepad().open()


@pytest.mark.parametrize("strongest", [0.0, -1.0, float("nan")])
def test_a_strongest_force_that_makes_no_sense_is_refused(strongest: float) -> None:
    with pytest.raises(ValueError, match="strongest must be positive"):
        Gamepad(strongest=strongest)
