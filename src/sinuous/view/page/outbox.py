"""Sends to a process that may be slow or dead, without ever waiting for it."""

from collections import deque
from contextlib import suppress
from multiprocessing.connection import Connection
from threading import Condition, Thread
from typing import Any

PARTING = 1.0  # how long the last messages may take [s]


class Outbox:
    """A thread that sends: every message, and of the snapshots the newest.

    Arguments:
        connection: to the other process
    """

    def __init__(self, connection: "Connection[Any, Any]") -> None:
        self._connection, self._changed = connection, Condition()
        self._messages = deque[object]()
        self._newest: object | None = None
        self._open = True
        self._thread = Thread(target=self._run, name="to the page", daemon=True)
        self._thread.start()

    def send(self, message: object) -> None:
        """Send this, in its turn."""
        with self._changed:
            self._messages.append(message)
            self._changed.notify()

    def show(self, snapshot: object) -> None:
        """Send this, unless a newer one comes before it is its turn."""
        with self._changed:
            self._newest = snapshot
            self._changed.notify()

    def close(self) -> None:
        """Send what is there, as far as somebody listens, and no more."""
        with self._changed:
            self._open = False
            self._changed.notify()
        self._thread.join(PARTING)
        self._connection.close()

    def _run(self) -> None:
        with suppress(OSError):  # nobody listens any more, which others notice
            while (message := self._next()) is not None:
                self._connection.send(message)

    def _next(self) -> object | None:
        with self._changed:
            while True:
                if self._messages:
                    return self._messages.popleft()
                if self._newest is not None:
                    newest, self._newest = self._newest, None
                    return newest
                if not self._open:
                    return None
                self._changed.wait()
