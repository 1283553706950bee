"""3Dconnexion SpaceMouse and its relatives, by their HID reports."""

import sys
from collections.abc import Callable
from typing import Protocol

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.leaders.leader import About, ForceKind, Hand, Leader
from sinuous.leaders.motion import Rates, beyond_dead_zone
from sinuous.leaders.packages import require
from sinuous.leaders.rate_hand import RateHand
from sinuous.leaders.reader import Reader

MODULE = "hidraw" if sys.platform == "linux" else "hid"
"""Of hidapi: on Linux its `hid` goes through libusb, which takes the device away from the kernel
and does not say what kind of device it is."""

VENDORS = (0x256F, 0x046D)  # 3Dconnexion; Logitech, who made them before
MULTI_AXIS = (0x01, 0x08)  # usage page and usage of a multi-axis controller (HID Usage Tables)

TRANSLATION = 0x01  # the report that begins with the translation
FULL = 350.0  # counts of a cap that is pushed as far as it goes

LONGEST_REPORT = 64  # [bytes]
SILENCE_MS = 100  # how long to wait for a report
DEAD_ZONE = 0.05

LET_GO = 0.2
"""How long a deflection counts that is not repeated [s]: a cap that is pushed is reported every 8
or 16 ms, and zeros when it is let go. Only if those are lost does this matter."""


class Hid(Protocol):
    """A device of the package hidapi."""

    def read(self, max_length: int, timeout_ms: int, /) -> list[int]:
        """A report; none after the time; raises OSError if the device is gone."""
        ...

    def close(self) -> None:
        """Let go of the device."""
        ...


def deflection_in(report: bytes) -> Array | None:
    """How far the cap is pushed (3,), -1 to 1 along our axes; None if the report does not say.

    Report 1 begins with the translation, three 16-bit numbers, little-endian. Older devices send
    the rotation in report 2, newer ones behind the translation in report 1; neither is used here.
    The device counts x to the right, y towards the operator and z down.
    """
    if len(report) < 7 or report[0] != TRANSLATION:
        return None
    x, y, z = np.frombuffer(report[1:7], dtype="<i2").astype(np.float64)
    return np.clip(np.array([x, -y, -z]) / FULL, -1.0, 1.0)


class HidLine:
    """A SpaceMouse that is plugged in.

    Arguments:
        device: open
    """

    def __init__(self, device: Hid) -> None:
        self._device = device

    def wait(self) -> Array | None:
        """How far the cap is pushed (3,)."""
        return deflection_in(bytes(self._device.read(LONGEST_REPORT, SILENCE_MS)))

    def close(self) -> None:
        """Let go of the device."""
        self._device.close()


class SpaceMouse(Leader):
    """Pushing the cap moves the hand.

    Arguments:
        rates: from the cap to motion
        find: opens the device; by default the first one that is plugged in
    """

    about = About(
        name="SpaceMouse",
        axes="the cap pushed right, away, and pulled up; turning it does nothing",
        force=ForceKind.NONE,
        run_on_hardware=False,
    )

    def __init__(
        self, rates: Rates | None = None, *, find: Callable[[], Hid] | None = None
    ) -> None:
        find = find or find_spacemouse
        self._hand = RateHand(rates or Rates(), stale=LET_GO)
        self._reader = Reader(lambda: HidLine(find()), name="leader spacemouse")

    def open(self) -> None:
        """Connect to the device.

        Raises:
            InputError: if there is none, or the package is not installed
        """
        self._hand.reset()
        self._reader.open()

    def close(self) -> None:
        """Let go of the device."""
        self._reader.close()

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        number, pushed, connected = self._reader.latest
        if not connected:
            return self._hand.read(time, None, number)
        deflection = np.zeros(3) if pushed is None else beyond_dead_zone(pushed, DEAD_ZONE)
        return self._hand.read(time, deflection, number)


def find_spacemouse() -> Hid:
    """Open the first SpaceMouse there is.

    Raises:
        InputError: if there is none, it may not be opened, or hidapi is not installed
    """
    hid = require(MODULE, package="hidapi", extra="spacemouse")
    found = [
        device
        for vendor in VENDORS
        for device in hid.enumerate(vendor, 0)
        if (device["usage_page"], device["usage"]) == MULTI_AXIS
    ]
    if not found:
        raise InputError(
            file="leader spacemouse",
            expected="a SpaceMouse",
            found="no 3Dconnexion device that is plugged in",
            remedy="Plug it in; in a container, pass the device through.",
        )
    device = hid.device()
    try:
        device.open_path(found[0]["path"])
    except OSError as error:
        raise InputError(
            file="leader spacemouse",
            expected="a SpaceMouse that may be opened",
            found=f"{found[0]['product_string']}, which may not",
            remedy="On Linux give yourself access by a udev rule (docs/devices.md); "
            "elsewhere quit the 3Dconnexion driver.",
        ) from error
    return device
