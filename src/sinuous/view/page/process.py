"""What the page's own process runs, so that drawing never holds the loops up."""

import os
from contextlib import suppress
from multiprocessing.connection import Connection
from threading import Lock
from typing import Any

from sinuous.live import Snapshot
from sinuous.live.machine import leave_ctrl_c_to_the_parent
from sinuous.live.orders import Order
from sinuous.view.page.messages import Begun, Desk, Recording, Serving, Told
from sinuous.view.page.page import Page
from sinuous.view.page.server import address_of, start_server, stop_server

MOMENT = 0.05  # longest wait for a snapshot [s]


def run_page(desk: Desk, inbox: "Connection[Any, Any]", orders: "Connection[Any, Any]") -> None:
    """Serve the page until the session has nothing more to say.

    Arguments:
        inbox: from the session: `Begun`, `Told`, snapshots
        orders: to the session: `Serving`, then orders
    """
    leave_ctrl_c_to_the_parent()
    server = start_server(desk.port, "sinuous", wide=False)
    sending = Lock()  # callbacks come from several threads

    def order(asked: Order) -> None:
        with sending, suppress(OSError):  # the session is over
            orders.send(asked)

    page = Page(server, order, desk.hands)
    orders.send(Serving(server.get_port(), address_of(server)))
    with suppress(EOFError, OSError):
        while os.getppid() == desk.parent:
            page.settle()
            if inbox.poll(MOMENT):
                _deal(page, _newest(inbox))
    page.close()
    stop_server(server)


def _newest(inbox: "Connection[Any, Any]") -> list[object]:
    """What has come, without snapshots that are followed by another message."""
    messages = [inbox.recv()]
    while inbox.poll():
        message = inbox.recv()
        if isinstance(messages[-1], Snapshot):
            messages.pop()
        messages.append(message)
    return messages


def _deal(page: Page, messages: list[object]) -> None:
    for message in messages:
        match message:
            case Begun():
                page.begin(message.recipe)
            case Recording():
                page.recording(message.folder)
            case Told():
                page.tell(message.text, lasting=message.lasting)
            case Snapshot():
                page.show(message)
            case _:
                raise TypeError(f"no message: {message}")
