"""The page beside a session: started, watched, started again if it dies, and ended."""

import os
from collections.abc import Callable
from contextlib import suppress
from multiprocessing import get_context
from multiprocessing.connection import Connection
from multiprocessing.context import SpawnContext, SpawnProcess
from threading import Event, Lock, Thread
from typing import Any, Self, cast

from sinuous.live import LiveSession, Recipe, Snapshot
from sinuous.live.orders import Pause
from sinuous.live.processes import LeaderMaker
from sinuous.scenario import Scenario
from sinuous.view.page.messages import Begun, Desk, Recording, Serving, Told
from sinuous.view.page.outbox import Outbox

PATIENCE = 3.0  # for the process to end by itself [s]
MOST = 5  # times that it is started again


class PageSupervisor:
    """Keeps a page beside a session. Used as

        with PageSupervisor(...) as page:
            session = LiveSession(..., started=page.started, observe=page.observe, ...)
            page.serve(session)
            session.run()

    Arguments:
        port: to serve at; the next free one if it is taken
        hands: makers of devices by what they are called, the one in use first
        ready: called with the address once the page is there, and again if it had to be restarted
        lost: called when its process has died
    """

    def __init__(
        self,
        *,
        port: int,
        hands: dict[str, LeaderMaker],
        ready: Callable[[str], None],
        lost: Callable[[str], None],
    ) -> None:
        self._port, self._hands, self._ready, self._lost = port, hands, ready, lost
        self._lock, self._ending = Lock(), Event()
        self._outbox: Outbox | None = None
        self._begun: Begun | None = None
        self._recording = Recording(None)
        self._process: SpawnProcess | None = None
        self._thread: Thread | None = None

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self._ending.set()
        with self._lock:
            outbox, self._outbox = self._outbox, None
        if outbox is not None:
            outbox.close()
        if self._thread is not None:
            self._thread.join()

    @property
    def pid(self) -> int | None:
        """Of the page's process, while there is one."""
        return None if self._process is None else self._process.pid

    def serve(self, session: LiveSession) -> None:
        """Start the page; its orders go to that session."""
        orders = self._start()
        self._thread = Thread(target=self._watch, args=(session, orders), name="page watch")
        self._thread.start()

    def started(self, _: Scenario, recipe: Recipe) -> None:
        """The session has begun, or begun again."""
        with self._lock:
            self._begun = Begun(recipe)
            if self._outbox is not None:
                self._outbox.send(self._begun)

    def observe(self, snapshot: Snapshot) -> None:
        """How things are."""
        outbox = self._outbox  # another thread may take it away
        if outbox is not None:
            outbox.show(snapshot)

    def recording(self, folder: str | None) -> None:
        """What happens is recorded into a folder, or no longer."""
        with self._lock:
            self._recording = Recording(folder)
            if self._outbox is not None:
                self._outbox.send(self._recording)

    def tell(self, text: str, *, lasting: bool = False) -> None:
        """Show a text."""
        with self._lock:
            if self._outbox is not None:
                self._outbox.send(Told(text, lasting))

    def _start(self) -> "Connection[Any, Any]":
        context = get_context("spawn")
        inbox, to_page = _pipe(context)
        orders, from_page = _pipe(context)
        desk = Desk(port=self._port, hands=self._hands, parent=os.getpid())
        self._process = context.Process(
            target=_run, args=(desk, inbox, from_page), name="the page", daemon=True
        )
        self._process.start()
        # Whoever loses the other end shall notice.
        inbox.close()
        from_page.close()
        with self._lock:
            self._outbox = Outbox(to_page)
            if self._begun is not None:
                self._outbox.send(self._begun)
            self._outbox.send(self._recording)
        return orders

    def _watch(self, session: LiveSession, orders: "Connection[Any, Any]") -> None:
        for _ in range(MOST):
            with suppress(EOFError, OSError):
                serving: Serving = orders.recv()
                self._port = serving.port  # where a page that comes later finds it
                session.listen(orders)
                self._ready(serving.address)
            code = self._wait()
            if self._ending.is_set():
                return
            session.order(Pause())  # nobody sees the robot
            self._lost(f"the page's process ended with code {code}: the robot holds still")
            with self._lock:
                outbox, self._outbox = self._outbox, None
            if outbox is not None:
                outbox.close()
            orders = self._start()
        self._lost("the page's process ends whenever it is started: it is left alone")
        self._wait()

    def _wait(self) -> int | None:
        """Until the process has ended, which it does once there is nothing more to show."""
        process = self._process
        assert process is not None
        while process.is_alive() and not self._ending.is_set():
            process.join(0.2)
        process.join(PATIENCE)
        if process.is_alive():
            process.kill()
            process.join()
        code = process.exitcode
        process.close()
        return code


def _pipe(context: SpawnContext) -> "tuple[Connection[Any, Any], Connection[Any, Any]]":
    """One end to read and one to write."""
    reading, writing = context.Pipe(duplex=False)
    return cast("Connection[Any, Any]", reading), cast("Connection[Any, Any]", writing)


def _run(desk: Desk, inbox: "Connection[Any, Any]", orders: "Connection[Any, Any]") -> None:
    from sinuous.view.page.process import run_page  # late: only that process draws

    run_page(desk, inbox, orders)
