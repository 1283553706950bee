"""Between a device that knows where it is and a hand that may let go of it."""

import numpy as np

from sinuous.arrays import Array


class Clutch:
    """Adds up the motion of a device while it is held, and only then.

    So the hand stays where it is while the operator lets go and takes the device elsewhere, and
    when a lost device comes back at another place.
    """

    def __init__(self) -> None:
        self._place, self._before = np.zeros(3), None

    _before: Array | None

    def move(self, device: Array | None, *, held: bool) -> Array:
        """Where the hand is (3,) [m], for a device at (3,) [m] or, if it is gone, None."""
        if device is not None and held and self._before is not None:
            self._place = self._place + (device - self._before)
        self._before = device if held else None
        return self._place
