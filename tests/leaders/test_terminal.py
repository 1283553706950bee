"""The bytes that terminals send, through a real pseudo-terminal."""

import os
import pty
import termios
from collections.abc import Iterator

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.errors import InputError
from sinuous.leaders import TerminalKeyboard
from sinuous.leaders.terminal import HELD, keys_in

from .eventually import eventually

XTERM = {
    "\x1b[A": "ArrowUp",
    "\x1bOA": "ArrowUp",  # in application mode
    "\x1b[1;5B": "ArrowDown",  # with control
    "\x1b[C": "ArrowRight",
    "\x1b[D": "ArrowLeft",
    "\x1b[5~": "PageUp",
    "\x1b[6;2~": "PageDown",  # with shift
}
OTHERS = ["a", "\x1b[H", "\x1b[3~", "\x1b[15~", "\x1bx", "\n", "~"]


@given(st.lists(st.sampled_from([*XTERM, *OTHERS]), max_size=12), st.data())
def test_keys_are_found_however_the_bytes_are_cut(sent: list[str], data: st.DataObject) -> None:
    text = "".join(sent)
    cut = data.draw(st.integers(0, len(text)))
    first, rest = keys_in(text[:cut])
    second, left = keys_in(rest + text[cut:])
    assert first + second == [XTERM[one] for one in sent if one in XTERM]
    assert left == ""


@pytest.fixture
def terminal() -> Iterator[tuple[int, int]]:
    """What the user types into, and what a program reads from."""
    ends = pty.openpty()
    yield ends
    for end in ends:
        os.close(end)


def test_a_key_moves_the_hand_while_it_repeats(terminal: tuple[int, int]) -> None:
    typed, program = terminal
    with TerminalKeyboard(file=program) as keyboard:
        keyboard.read(0.0)
        os.write(typed, b"\x1b[5~")
        assert eventually(lambda: keyboard._reader.latest.number > 0)
        times = np.arange(0.0, 1.0, 0.001)
        places = np.array([keyboard.read(t).position for t in times])
    assert np.all(places[:, :2] == 0.0)
    assert np.all(np.diff(places[times < HELD, 2]) > 0.0)
    assert np.all(np.diff(places[times > HELD + 0.1, 2]) == 0.0), "the ramp down takes 0.1 s"


def test_the_terminal_is_put_back_as_it_was(terminal: tuple[int, int]) -> None:
    before = termios.tcgetattr(terminal[1])
    with TerminalKeyboard(file=terminal[1]):
        assert not termios.tcgetattr(terminal[1])[3] & termios.ECHO
    assert termios.tcgetattr(terminal[1]) == before


def test_without_a_terminal_the_message_says_so() -> None:
    reading, writing = os.pipe()
    with pytest.raises(InputError, match="expected a terminal, found that there is none"):
        TerminalKeyboard(file=reading).open()
    os.close(reading)
    os.close(writing)
