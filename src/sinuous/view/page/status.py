"""How things are in two lines, in a box whose height stays."""

from html import escape
from math import isfinite

import numpy as np

from sinuous.live import Snapshot
from sinuous.view.page.limits import few
from sinuous.view.style import VERMILION
from sinuous.view.units import MM_PER_M

BOX = "padding:0 1em;height:8.5em;overflow-y:auto;font-size:0.875em;line-height:1.45"


def status_of(snapshot: Snapshot, *, dragged: bool) -> str:
    """What limits the robot, and what that means, as HTML.

    Arguments:
        snapshot: of the session
        dragged: whether the hand is the one on the page
    """
    advice = snapshot.advice
    if dragged and not snapshot.connected:
        advice = "every page was closed: press Resume"
    room = snapshot.clearance
    clear = f"{MM_PER_M * room:.1f} mm from the nearest wall" if isfinite(room) else "no walls"
    felt = float(np.linalg.norm(snapshot.felt))
    first = _warning(advice) if advice else f"<b>limited by: {escape(few(snapshot.limits))}</b>"
    return _box(f"{first}<br>{clear}; {felt:.2f} N on the hand")


def told(text: str) -> str:
    """A text that people should read, as HTML."""
    return _box(_warning(text))


def _warning(text: str) -> str:
    lines = escape(text).replace("\n", "<br>")
    return f'<b style="color:{VERMILION}">{lines}</b>'


def _box(content: str) -> str:
    return f'<div style="{BOX}">{content}</div>'
