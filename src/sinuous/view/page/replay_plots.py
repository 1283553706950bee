"""Curves of a recording up to the moment that is shown."""

import numpy as np
import viser
from viser import uplot

from sinuous.arrays import Array
from sinuous.view.page.recorded import Recorded
from sinuous.view.style import BLUE, GREEN, VERMILION
from sinuous.view.units import MM_PER_M

SPAN = 10.0  # seconds before
MOST = 300  # points of a curve
HEIGHT = 150  # [pixels]


class ReplayPlots:
    """Error of the tip, clearance of the body and force on the hand.

    Arguments:
        gui: of the page
        recorded: what is played
    """

    def __init__(self, gui: viser.GuiApi, recorded: Recorded) -> None:
        recording = recorded.recording
        self._time = recording.time
        error = np.linalg.norm(recording.actual_tip - recording.target, axis=1) * MM_PER_M
        clearance = recording.actual_clearance * MM_PER_M
        curves = [("tip error [mm]", error, BLUE)]
        if np.any(np.isfinite(clearance)):
            curves.append(("body clearance [mm]", clearance, GREEN))
        if np.any(recorded.forces != 0.0):
            force = np.linalg.norm(recorded.forces, axis=1)
            curves.append(("force on the hand [N]", force, VERMILION))
        self._values = [values for _, values, _ in curves]
        self._handles = [
            gui.add_uplot(
                self._until(values, float(self._time[0])),
                (
                    uplot.Series(label="t [s]"),
                    uplot.Series(label=title, stroke=color, width=2),
                ),
                title=title,
                scales={"x": uplot.Scale(time=False)},
                legend=uplot.Legend(show=False),
                height=HEIGHT,
            )
            for title, values, color in curves
        ]

    def show(self, now: float) -> None:
        """Show what was until a time [s]."""
        for handle, values in zip(self._handles, self._values, strict=True):
            handle.data = self._until(values, now)

    def _until(self, values: Array, now: float) -> tuple[Array, Array]:
        """Finite numbers only, for one that is not takes the whole curve away."""
        first, after = np.searchsorted(self._time, (now - SPAN, now + 1e-9))
        rows = np.unique(np.linspace(first, max(after - 1, first), MOST).astype(int))
        rows = rows[np.isfinite(values[rows])]
        return self._time[rows], values[rows]
