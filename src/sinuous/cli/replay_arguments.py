"""What `sinuous replay` takes; the texts here are its manual."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, arg


@dataclass(frozen=True, kw_only=True)
class Replay:
    """Look at a recorded run in the browser, or write it as one page.

    Exit codes: 0 done, 2 bad input, 130 interrupted.
    """

    run: Positional[Annotated[str, arg(metavar="RUN")]]
    """a run.mcap, or the folder of a run"""
    html: Annotated[str | None, arg(metavar="FILE")] = None
    """write one self-contained page and end"""
    port: Annotated[int, arg(metavar="PORT")] = 8080
    """of the page on this machine; the next that is free if it is taken"""
    duration: Annotated[float | None, arg(metavar="S")] = None
    """how long to serve it; by default until Ctrl-C, or 20 s where there is no terminal"""
    browser: bool = True
    """open it if there is a display"""
