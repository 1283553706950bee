"""Gamepads through SDL, which knows the layout of each and needs no window."""

import time
from collections.abc import Callable
from typing import Any, NamedTuple

from sinuous.errors import InputError
from sinuous.leaders.packages import require

POLL = 0.004  # time between looks at the pad [s], as long as most take between their reports
FULL = 32767.0  # counts of a stick that is pushed as far as it goes

RUMBLE_MS = 200  # how long a motor goes on that is not told again
RUMBLE_AGAIN = 0.1  # time between tellings [s]
STRONGEST = 0xFFFF


class Pad(NamedTuple):
    """Where the sticks are, -1 to 1 as SDL counts: x to the right, y down, towards the operator."""

    left_x: float
    left_y: float
    right_y: float


class SdlLine:
    """The first gamepad there is.

    All of SDL is used by the thread that made this; no video, no event queue.

    Arguments:
        rumble: says how strongly to rumble, 0 to 1

    Raises:
        InputError: if there is no gamepad, or SDL is not installed
    """

    def __init__(self, rumble: Callable[[], float]) -> None:
        self._sdl, self._rumble = load_sdl(), rumble
        self._told, self._since = 0, 0
        self._pad = self._first()

    def wait(self) -> Pad:
        """Where the sticks are now.

        Raises:
            OSError: if the pad is gone
        """
        time.sleep(POLL)
        sdl, pad = self._sdl, self._pad
        sdl.SDL_GameControllerUpdate()
        if not sdl.SDL_GameControllerGetAttached(pad):
            raise OSError("the gamepad is unplugged")
        self._shake()
        left_x, left_y, right_y = (
            max(sdl.SDL_GameControllerGetAxis(pad, axis) / FULL, -1.0)
            for axis in (
                sdl.SDL_CONTROLLER_AXIS_LEFTX,
                sdl.SDL_CONTROLLER_AXIS_LEFTY,
                sdl.SDL_CONTROLLER_AXIS_RIGHTY,
            )
        )
        return Pad(left_x, left_y, right_y)

    def close(self) -> None:
        """Let go of the pad; it rumbles no more."""
        self._sdl.SDL_GameControllerRumble(self._pad, 0, 0, 0)
        self._sdl.SDL_GameControllerClose(self._pad)
        self._sdl.SDL_QuitSubSystem(self._sdl.SDL_INIT_GAMECONTROLLER)

    def _shake(self) -> None:
        """Tell the motors, if they have to know."""
        strength = round(STRONGEST * self._rumble())
        self._since += 1
        if strength == self._told and (strength == 0 or self._since * POLL < RUMBLE_AGAIN):
            return
        self._sdl.SDL_GameControllerRumble(self._pad, strength, strength, RUMBLE_MS)
        self._told, self._since = strength, 0

    def _first(self) -> Any:
        sdl = self._sdl
        sdl.SDL_GameControllerUpdate()
        for index in range(sdl.SDL_NumJoysticks()):
            if sdl.SDL_IsGameController(index) and (pad := sdl.SDL_GameControllerOpen(index)):
                return pad
        others = sdl.SDL_NumJoysticks()
        sdl.SDL_QuitSubSystem(sdl.SDL_INIT_GAMECONTROLLER)
        raise InputError(
            file="leader gamepad",
            expected="a gamepad",
            found=f"none among {others} input devices",
            remedy="Plug it in; on Linux you need access to /dev/input (docs/devices.md).",
        )


def load_sdl() -> Any:
    """SDL, ready for gamepads.

    Raises:
        InputError: if it is not installed, or does not start
    """
    sdl = require("sdl2", package="pysdl2", extra="gamepad")
    sdl.SDL_SetHint(sdl.SDL_HINT_JOYSTICK_ALLOW_BACKGROUND_EVENTS, b"1")
    if sdl.SDL_InitSubSystem(sdl.SDL_INIT_GAMECONTROLLER) != 0:
        raise InputError(
            file="leader gamepad",
            expected="SDL to start",
            found=f"that it does not ({sdl.SDL_GetError().decode()})",
            remedy="Install pysdl2-dll, which brings a library that does.",
        )
    # The state is asked for: events would pile up in a queue that nobody empties.
    sdl.SDL_JoystickEventState(sdl.SDL_IGNORE)
    sdl.SDL_GameControllerEventState(sdl.SDL_IGNORE)
    return sdl
