"""`sinuous replay`: a recorded run on a page."""

import sys
import time
from pathlib import Path

from rich.console import Console

from sinuous.cli.browser import check_duration, check_port, open_page
from sinuous.cli.codes import GOOD
from sinuous.cli.replay_arguments import Replay
from sinuous.errors import InputError
from sinuous.files import write_text
from sinuous.recording import read
from sinuous.session.folder import RECORDING
from sinuous.view.page.recorded import Recorded
from sinuous.view.page.replay import FRAME, as_html, frames_of
from sinuous.view.page.replay import Replay as Page

SHOW = 20.0  # how long a page is served that nobody can end [s]


def replay(arguments: Replay) -> int:
    """Serve a recording, or write it as a page."""
    _check(arguments)
    path = Path(arguments.run)
    path = path / RECORDING if path.is_dir() else path
    recorded, console = Recorded.of(read(path), file=str(path)), Console()
    if arguments.html is not None:
        _write(recorded, Path(arguments.html), arguments.port, console)
        return GOOD
    duration = arguments.duration
    if duration is None and not sys.stdout.isatty():
        duration = SHOW
    with Page(recorded, port=arguments.port) as page:
        end = "Ctrl-C ends it." if duration is None else f"It ends after {duration:g} s."
        console.print(f"{page.address}  {end}", markup=False, highlight=False, soft_wrap=True)
        if arguments.browser:
            open_page(page.address)
        _play(page, float("inf") if duration is None else duration)
    return GOOD


def _play(page: Page, duration: float) -> None:
    before = start = time.monotonic()
    while before < start + duration:
        time.sleep(FRAME)
        now = time.monotonic()
        page.advance(now - before)
        before = now


def _write(recorded: Recorded, out: Path, port: int, console: Console) -> None:
    text = as_html(recorded, port=port)
    write_text(out, text)
    steps, period = frames_of(recorded)
    thinned = " (thinned out, for it is long)" if period > FRAME else ""
    console.print(
        f"{out}: {len(steps)} frames, {1.0 / period:.3g} per second{thinned}, "
        f"{len(text) / 1e6:.1f} MB",
        markup=False, highlight=False, soft_wrap=True,
    )  # fmt: skip


def _check(arguments: Replay) -> None:
    """Refuse what is not meant to work.

    Raises:
        InputError: if it is
    """
    if not arguments.run.strip():
        raise InputError(
            file="RUN", expected="a recorded run", found="an empty name", remedy="Name one."
        )
    check_duration(arguments.duration)
    check_port(arguments.port)
