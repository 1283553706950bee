"""Starting and ending what serves a page."""

from contextlib import redirect_stdout
from io import StringIO

import viser

HOST = "127.0.0.1"
"""Whoever reaches the page moves the robot: this machine only."""


def start_server(port: int, label: str, *, wide: bool = True) -> viser.ViserServer:
    """A page with its panel on the right, wide or not, at a port or the next one that is free."""
    with redirect_stdout(StringIO()):  # who asked for the page says where it is
        server = viser.ViserServer(host=HOST, port=port, label=label, verbose=False)
    width = "large" if wide else "medium"
    server.gui.configure_theme(control_width=width, show_logo=False, show_share_button=False)
    server.gui.main_panel.dock_right()
    return server


def address_of(server: viser.ViserServer) -> str:
    """Where the page is."""
    return f"http://{HOST}:{server.get_port()}"


def stop_server(server: viser.ViserServer) -> None:
    """End it."""
    with redirect_stdout(StringIO()):
        server.stop()
