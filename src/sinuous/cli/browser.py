"""Pages and the browser that shows them."""

import os
import sys
import webbrowser

from sinuous.errors import InputError


def open_page(address: str) -> None:
    """Show a page, if there is a display."""
    if _has_display():
        webbrowser.open(address)


def _has_display() -> bool:
    if sys.platform != "linux":
        return True
    return bool(os.environ.get("DISPLAY") or os.environ.get("WAYLAND_DISPLAY"))


def check_port(port: int) -> None:
    """Refuse what is no port.

    Raises:
        InputError: if it is none
    """
    if not 1 <= port <= 65535:
        raise InputError(
            file="--port",
            expected="a number from 1 to 65535",
            found=str(port),
            remedy="Write for example --port 8080.",
        )


def check_duration(duration: float | None) -> None:
    """Refuse a duration [s] that is none.

    Raises:
        InputError: if it is not positive and finite
    """
    if duration is not None and not 0.0 < duration < float("inf"):
        raise InputError(
            file="--duration",
            expected="a positive number of seconds",
            found=f"{duration:g}",
            remedy="Write for example --duration 20.",
        )
