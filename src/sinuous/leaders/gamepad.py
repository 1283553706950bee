"""A gamepad: two sticks that say how fast, and two motors that rumble."""

import numpy as np

from sinuous.arrays import Array
from sinuous.leaders.leader import About, ForceKind, Hand, Leader, positive
from sinuous.leaders.motion import Rates, beyond_dead_zone
from sinuous.leaders.rate_hand import RateHand
from sinuous.leaders.reader import Reader
from sinuous.leaders.sdl import Pad, SdlLine

DEAD_ZONE = 0.15  # sticks rest up to a tenth off their middle, and more when they are worn


class Gamepad(Leader):
    """The left stick moves the hand in the plane, the right one up and down; forces rumble.

    Arguments:
        rates: from sticks to motion
        strongest: the force at which it rumbles as strongly as it can [N]

    Raises:
        ValueError: if the strongest force is not positive
    """

    about = About(
        name="gamepad",
        axes="left stick right and away, right stick up",
        force=ForceKind.RUMBLE,
        run_on_hardware=False,
    )

    def __init__(self, rates: Rates | None = None, *, strongest: float = 1.5) -> None:
        positive("strongest", strongest)
        self._hand, self._strongest = RateHand(rates or Rates()), strongest
        self._reader = Reader(lambda: SdlLine(lambda: self._rumble), name="leader gamepad")
        self._rumble = 0.0

    def open(self) -> None:
        """Connect to the first gamepad.

        Raises:
            InputError: if there is none, or SDL is not installed
        """
        self._hand.reset()
        self._rumble = 0.0
        self._reader.open()

    def close(self) -> None:
        """Let go of it."""
        self._reader.close()

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        number, pad, connected = self._reader.latest
        if not connected:
            return self._hand.read(time, None, number)
        return self._hand.read(time, np.zeros(3) if pad is None else deflection_of(pad), number)

    def feel(self, force: Array) -> None:
        """Rumble by the size of a force (3,) [N]."""
        size = float(np.sqrt(force @ force)) / self._strongest
        self._rumble = min(size, 1.0) if size > 0.0 else 0.0  # neither for what is no number


def deflection_of(pad: Pad) -> Array:
    """How far the sticks are pushed (3,), along our axes, each without its dead zone.

    SDL counts y downwards, which is towards the operator on the left stick.
    """
    right, away = beyond_dead_zone(np.array([pad.left_x, -pad.left_y]), DEAD_ZONE)
    (up,) = beyond_dead_zone(np.array([-pad.right_y]), DEAD_ZONE)
    return np.array([right, away, up])
