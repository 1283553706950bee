"""The keys of a terminal, which tells that a key repeats but never that it was released."""

import os
import select
from contextlib import suppress
from types import ModuleType
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.leaders.keyboard import AXES, DIRECTIONS
from sinuous.leaders.leader import About, ForceKind, Hand, Leader
from sinuous.leaders.motion import Rates
from sinuous.leaders.rate_hand import RateHand
from sinuous.leaders.reader import Reader

HELD = 0.15
"""How long a key counts as down after it was told [s]; keyboards repeat every 30 to 100 ms, after a
first wait of 250 to 500 ms, in which the hand rests."""

SILENCE = 0.1  # how long to wait for a key [s]
TERMINAL = "/dev/tty"

FINALS = {
    "A": "ArrowUp",
    "B": "ArrowDown",
    "C": "ArrowRight",
    "D": "ArrowLeft",
    "5~": "PageUp",
    "6~": "PageDown",
}
"""Keys by the end of their control sequence, ESC [ or ESC O before it (ECMA-48, xterm)."""


def keys_in(text: str) -> tuple[list[str], str]:
    """The keys in what a terminal sent, and what is left of a sequence that is not whole."""
    keys = list[str]()
    while (start := text.find("\x1b")) >= 0:
        text = text[start:]
        if len(text) >= 2 and text[1] not in "[O":
            text = text[1:]
            continue
        end = next((k for k, c in enumerate(text[2:], 2) if c.isalpha() or c == "~"), None)
        if end is None:
            return keys, text
        parameters = text[2:end].split(";")[0]  # what follows tells of shift and control
        final = parameters + "~" if text[end] == "~" else text[end]
        if final in FINALS:
            keys.append(FINALS[final])
        text = text[end + 1 :]
    return keys, ""


class TerminalLine:
    """A terminal that gives away keys as they are pressed, and is put back as it was.

    Control-C stays what it is.

    Arguments:
        file: its descriptor, which is closed in the end
        termios: the module
    """

    def __init__(self, file: int, termios: Any) -> None:
        self._file, self._termios = file, termios
        self._rest = ""
        try:
            self._before = termios.tcgetattr(file)
            quiet = list(self._before)
            quiet[3] &= ~(termios.ICANON | termios.ECHO)
            termios.tcsetattr(file, termios.TCSADRAIN, quiet)
        except termios.error:
            os.close(file)
            raise

    def wait(self) -> Array | None:
        """Where the last key that was pressed moves the hand (3,)."""
        ready, _, _ = select.select([self._file], [], [], SILENCE)
        if not ready:
            return None
        data = os.read(self._file, 256)
        if not data:
            raise OSError("the terminal is closed")
        keys, self._rest = keys_in(self._rest + data.decode(errors="replace"))
        return np.array(DIRECTIONS[keys[-1]]) if keys else None

    def close(self) -> None:
        """Let the terminal be as it was."""
        with suppress(self._termios.error):  # of a terminal that is closed
            self._termios.tcsetattr(self._file, self._termios.TCSADRAIN, self._before)
        os.close(self._file)


class TerminalKeyboard(Leader):
    """Moves the hand while a key repeats: the last one that was pressed.

    Arguments:
        rates: from keys to motion
        file: descriptor of the terminal; by default it is that from which the program was started,
            also for a process whose standard input is something else
    """

    about = About(name="terminal keyboard", axes=AXES, force=ForceKind.NONE, run_on_hardware=None)

    def __init__(self, rates: Rates | None = None, *, file: int | None = None) -> None:
        self._file = file
        self._hand = RateHand(rates or Rates(), stale=HELD)
        self._reader = Reader(self._connect, name="leader terminal")

    def open(self) -> None:
        """Take the keys of the terminal.

        Raises:
            InputError: if there is no terminal
        """
        self._hand.reset()
        self._reader.open()

    def close(self) -> None:
        """Let the terminal be as it was."""
        self._reader.close()

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        number, deflection, connected = self._reader.latest
        nothing = np.zeros(3) if connected else None
        return self._hand.read(time, nothing if deflection is None else deflection, number)

    def _connect(self) -> TerminalLine:
        termios = _termios()
        try:
            file = os.open(TERMINAL, os.O_RDONLY) if self._file is None else os.dup(self._file)
            return TerminalLine(file, termios)
        except (OSError, termios.error) as error:
            raise InputError(
                file="leader terminal",
                expected="a terminal",
                found="that there is none",
                remedy="Start it in a terminal, or use another leader.",
            ) from error


def _termios() -> ModuleType:
    """The module that knows terminals.

    Raises:
        InputError: on systems without it
    """
    try:
        import termios
    except ImportError as error:
        raise InputError(
            file="leader terminal",
            expected="a POSIX terminal",
            found="a system without one",
            remedy="Use the keys of the page, or another leader.",
        ) from error
    return termios
