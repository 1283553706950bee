"""Haply Inverse3, by the WebSocket of its service: a position in space and a true force."""

from collections.abc import Callable
from contextlib import ExitStack
from threading import Event
from typing import Any

import numpy as np

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.leaders.clutch import Clutch
from sinuous.leaders.freshness import Freshness
from sinuous.leaders.haply_messages import Frame, first_request, force_request, frame_in
from sinuous.leaders.leader import About, ForceKind, Hand, Leader, positive
from sinuous.leaders.packages import require
from sinuous.leaders.reader import Reader

ADDRESS = "ws://localhost:10001"

KEEP_ALIVE = 0.02
"""After this time [s] without a new force the device is asked where it is, and let go of: whoever
hangs leaves no force behind."""

ANSWER = 0.5  # how long the service may take for an answer before it counts as gone [s]


class HaplyLine:
    """One Inverse3 at the service. A message goes out for every force, and one comes back.

    Arguments:
        address: of the service
        force: waits for a new force (3,) [N], zero if there is none for a while

    Raises:
        InputError: if there is no service, no device, or websockets is not installed
    """

    def __init__(self, address: str, force: Callable[[], Array]) -> None:
        self._force = force
        client = require("websockets.sync.client", package="websockets", extra="haply")
        self._closed = require("websockets", package="websockets", extra="haply").ConnectionClosed
        self._connection = ExitStack()
        try:
            connecting = client.connect(
                address, compression=None, proxy=None, open_timeout=ANSWER, close_timeout=ANSWER
            )
            self._socket: Any = self._connection.enter_context(connecting)
        except Exception as error:  # refused, unknown, no WebSocket: all the same to the user
            raise _absent(f"none at {address} ({error})") from error
        try:
            frame = frame_in(self._socket.recv(timeout=ANSWER))
        except (OSError, self._closed, ValueError) as error:
            self.close()
            raise _absent(f"something at {address} that is none ({error})") from error
        if frame is None:
            self.close()
            raise InputError(
                file="leader haply",
                expected="an Inverse3",
                found="a service without one",
                remedy="Plug it in, switch it on, and calibrate it as Haply Hub says.",
            )
        self._device = frame.device
        self._greeted = False

    def wait(self) -> Frame:
        """Send a force, hear where the device is.

        Raises:
            OSError: if service or device is gone
        """
        force = self._force()
        message = force_request(self._device, force)
        if not self._greeted:
            message, self._greeted = first_request(self._device), True
        try:
            self._socket.send(message)
            frame = frame_in(self._socket.recv(timeout=ANSWER), self._device)
        except (self._closed, ValueError) as error:
            raise OSError(f"the service is gone: {error}") from error
        if frame is None:
            raise OSError("the device is unplugged")
        return frame

    def close(self) -> None:
        """Leave the service, which lets go of the device."""
        self._connection.close()


class Haply(Leader):
    """The cursor is the hand, metre by metre.

    The device is asked where it is whenever a force is told, so `feel` has to be called in every
    tick for it to be read in every tick.

    Arguments:
        clutch: whether the hand moves only while button a of a wireless VerseGrip is pressed
        strongest: forces are cut to this length [N]
        address: of the service

    Raises:
        ValueError: if the strongest force is not positive
    """

    about = About(
        name="Haply Inverse3",
        axes="the cursor in space",
        force=ForceKind.TRUE,
        run_on_hardware=False,
    )

    def __init__(
        self, *, clutch: bool = False, strongest: float = 3.0, address: str = ADDRESS
    ) -> None:
        positive("strongest", strongest)
        self._clutched, self._strongest = clutch, strongest
        self._reader = Reader(lambda: HaplyLine(address, self._next_force), name="leader haply")
        self._told, self._new = np.zeros(3), Event()
        self._clutch, self._freshness = Clutch(), Freshness()

    def open(self) -> None:
        """Connect to the service, with no force.

        Raises:
            InputError: if it or the device is not there, or websockets is not installed
        """
        self._told = np.zeros(3)
        self._clutch, self._freshness = Clutch(), Freshness()
        self._reader.open()

    def close(self) -> None:
        """Let go of the device."""
        self._reader.close()

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        number, frame, connected = self._reader.latest
        held = frame is not None and (frame.grip or not self._clutched)
        place = self._clutch.move(None if frame is None else frame.position, held=held)
        return Hand(place, held, connected, self._freshness.age(number, time))

    def feel(self, force: Array) -> None:
        """Push the hand with a force (3,) [N], cut to the strongest; zero for what is no number."""
        size = float(np.sqrt(force @ force))
        if size <= self._strongest:
            self._told = force.copy()
        elif size < np.inf:
            self._told = force * (self._strongest / size)
        else:
            self._told = np.zeros(3)
        self._new.set()

    def _next_force(self) -> Array:
        """The newest force (3,) [N], as soon as there is one; zero if there is none for a while."""
        if not self._new.wait(KEEP_ALIVE):
            return np.zeros(3)
        self._new.clear()
        return self._told


def _absent(found: str) -> InputError:
    return InputError(
        file="leader haply",
        expected="the Haply Inverse service, 3.5 or newer",
        found=found,
        remedy="Install and start it (Haply Hub does), see docs/devices.md.",
    )
