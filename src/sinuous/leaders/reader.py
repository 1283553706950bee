"""A thread that waits for a device, so that nobody else has to."""

from collections.abc import Callable
from threading import Event, Thread
from typing import Generic, NamedTuple, Protocol, TypeVar

from sinuous.errors import InputError

N = TypeVar("N")  # what a device says
Said = TypeVar("Said", covariant=True)

RETRY = 0.5  # time between attempts to find a lost device again [s]
PATIENCE = 10.0  # for a device to be found, and for the thread to end [s]


class Line(Protocol[Said]):
    """A connection to a device."""

    def wait(self) -> Said | None:
        """What the device says next; None if it says nothing for a tenth of a second or so.

        Raises:
            OSError: if the device is gone
        """
        ...

    def close(self) -> None:
        """Let go of the device, if it is still there."""
        ...


class Latest(NamedTuple, Generic[N]):
    """The newest there is of a device.

    Arguments:
        number: of all that it has said so far
        said: last; None if nothing since it was connected
        connected: whether it is there
    """

    number: int
    said: N | None
    connected: bool


class Reader(Generic[N]):
    """Finds a device, listens to it, and finds it again when it was lost.

    `latest` may be read by any thread at any time and makes nobody wait: a whole value is put in
    the place of another one, so nobody sees half of one.

    Arguments:
        connect: finds the device, or raises an InputError
        name: of the thread
        retry: time between attempts to find a lost device again [s]
    """

    def __init__(self, connect: Callable[[], Line[N]], *, name: str, retry: float = RETRY) -> None:
        self._connect, self._name, self._retry = connect, name, retry
        self.latest: Latest[N] = Latest(0, None, connected=False)
        self._stop, self._tried = Event(), Event()
        self._failure: Exception | None = None
        self._thread: Thread | None = None

    def open(self) -> None:
        """Find the device.

        Raises:
            InputError: if it is not there
        """
        self.close()
        self._stop.clear()
        self._tried.clear()
        self._failure = None
        self._thread = Thread(target=self._run, name=self._name, daemon=True)
        self._thread.start()
        found = self._tried.wait(PATIENCE)
        if not found or self._failure is not None:
            self.close()
            raise self._failure or InputError(
                file=self._name,
                expected="a device that answers",
                found=f"none after {PATIENCE:g} s",
                remedy="Unplug it, plug it in again, and see that no other program uses it.",
            )

    def close(self) -> None:
        """Let go of it."""
        self._stop.set()
        if self._thread is not None:
            self._thread.join(PATIENCE)
            self._thread = None

    def _run(self) -> None:
        while not self._stop.is_set():
            try:
                line = self._connect()
            except Exception as error:
                if not self._tried.is_set():  # `open` waits for it, and raises it
                    self._failure = error
                    self._tried.set()
                    return
                if not isinstance(error, InputError):
                    raise
                self._stop.wait(self._retry)
                continue
            self.latest = Latest(self.latest.number, None, connected=True)
            self._tried.set()
            self._listen(line)
            self._stop.wait(self._retry)

    def _listen(self, line: Line[N]) -> None:
        """Listen until told to stop or the device is gone."""
        try:
            while not self._stop.is_set():
                said = line.wait()
                if said is not None:
                    self.latest = Latest(self.latest.number + 1, said, connected=True)
        except OSError:
            pass  # a lost device is no fault of ours: `latest` says so
        finally:
            self.latest = Latest(self.latest.number, None, connected=False)
            line.close()
