"""Keys that are pressed and released, on a page or wherever both are told."""

from math import inf
from threading import Lock
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array
from sinuous.leaders.leader import About, ForceKind, Hand, Leader
from sinuous.leaders.motion import Rates
from sinuous.leaders.rate_hand import RateHand

DIRECTIONS: dict[str, tuple[float, float, float]] = {
    "ArrowRight": (1.0, 0.0, 0.0),
    "ArrowLeft": (-1.0, 0.0, 0.0),
    "ArrowUp": (0.0, 1.0, 0.0),
    "ArrowDown": (0.0, -1.0, 0.0),
    "PageUp": (0.0, 0.0, 1.0),
    "PageDown": (0.0, 0.0, -1.0),
}
"""Where each key moves the hand; names as in a browser's `KeyboardEvent.code`."""

AXES = "arrow keys right and left, away and towards; page up and page down"


class Keys(NamedTuple):
    """What is known of the keys.

    Arguments:
        number: of events so far
        deflection: of all keys that are down (3,)
        connected: whether there is somebody who tells
    """

    number: int
    deflection: Array
    connected: bool


class Keyboard(Leader):
    """Moves the hand while keys are down.

    `press`, `release`, `release_all` and `lost` may be called from any thread. Events carry a stamp
    of the sender's clock or count; of each key the one with the latest stamp counts, so it does
    not matter in which order they arrive.

    Arguments:
        rates: from keys to motion
    """

    about = About(name="keyboard", axes=AXES, force=ForceKind.NONE, run_on_hardware=None)

    def __init__(self, rates: Rates | None = None) -> None:
        self._hand = RateHand(rates or Rates())
        self._writing = Lock()
        self.open()

    def open(self) -> None:
        """At zero, with no key down."""
        self._hand.reset()
        self._events: dict[str, tuple[float, bool]] = dict.fromkeys(DIRECTIONS, (-inf, False))
        self._keys = Keys(0, np.zeros(3), connected=True)

    def press(self, key: str, stamp: float) -> None:
        """A key went down; keys that move nothing are passed over."""
        self._note([key], stamp, down=True)

    def release(self, key: str, stamp: float) -> None:
        """A key went up."""
        self._note([key], stamp, down=False)

    def release_all(self, stamp: float) -> None:
        """No key is down any more, because the page has lost the focus."""
        self._note(list(DIRECTIONS), stamp, down=False)

    def lost(self) -> None:
        """The page is gone: all keys are up; the next event brings it back."""
        with self._writing:
            self._events = {key: (stamp, False) for key, (stamp, _) in self._events.items()}
            self._keys = Keys(self._keys.number, np.zeros(3), connected=False)

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        number, deflection, connected = self._keys
        return self._hand.read(time, deflection if connected else None, number)

    def _note(self, keys: list[str], stamp: float, *, down: bool) -> None:
        """Note an event of some keys, unless a later one is known."""
        with self._writing:
            for key in keys:
                if key in DIRECTIONS and stamp > self._events[key][0]:
                    self._events[key] = (stamp, down)
            pressed = [DIRECTIONS[key] for key, (_, is_down) in self._events.items() if is_down]
            deflection = np.sum(np.array([(0.0, 0.0, 0.0), *pressed]), axis=0)
            self._keys = Keys(self._keys.number + 1, deflection, connected=True)
