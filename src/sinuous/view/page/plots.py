"""What happened in the last seconds, as curves."""

from collections import deque
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import viser
from viser import uplot

from sinuous.live import Snapshot
from sinuous.view.style import BLUE, GREEN, VERMILION
from sinuous.view.units import MJ_PER_J, MM_PER_M, MS_PER_S

SPAN = 20.0  # seconds that are shown
EVERY = 0.1  # between two points [s]
HEIGHT = 128  # [pixels]
LEGEND = 24  # of one [pixels]


@dataclass(frozen=True, kw_only=True)
class Curve:
    """One line of a plot: its name, colour and what of a snapshot it shows."""

    name: str
    color: str
    value: Callable[[Snapshot], float]


@dataclass(frozen=True, kw_only=True)
class Plot:
    """One plot.

    Arguments:
        title: with the unit
        reach: of its axis at least, so that what is next to nothing looks like nothing
        curves: in it
    """

    title: str
    reach: float
    curves: tuple[Curve, ...]

    @property
    def scales(self) -> "dict[str, uplot.Scale]":
        """Of time, and from zero to the reach or as far as there are values."""
        low = {"pad": 0.1, "soft": 0.0, "mode": 1}
        high = {"pad": 0.1, "soft": self.reach, "mode": 1}
        return {"x": uplot.Scale(time=False), "y": uplot.Scale(range={"min": low, "max": high})}


PLOTS = (
    Plot(
        title="tracking error [mm]",
        reach=1.0,
        curves=(Curve(name="error", color=BLUE, value=lambda s: s.tracking_error * MM_PER_M),),
    ),
    Plot(
        title="force [N]",
        reach=0.1,
        curves=(
            Curve(name="hand", color=VERMILION, value=lambda s: float(np.linalg.norm(s.felt))),
            Curve(name="robot", color=BLUE, value=lambda s: float(np.linalg.norm(s.virtual))),
        ),
    ),
    Plot(
        title="body clearance [mm]",
        reach=5.0,
        curves=(Curve(name="least", color=GREEN, value=lambda s: s.clearance * MM_PER_M),),
    ),
    Plot(
        title="solve time [ms]",
        reach=2.0,
        curves=(Curve(name="solve", color=BLUE, value=lambda s: s.solve_time * MS_PER_S),),
    ),
    Plot(
        title="energy taken in [mJ]",
        reach=1.0,
        curves=(
            Curve(name="channel", color=BLUE, value=lambda s: float(s.energies[0]) * MJ_PER_J),
            Curve(name="hand", color=VERMILION, value=lambda s: float(s.energies[1]) * MJ_PER_J),
            Curve(name="robot", color=GREEN, value=lambda s: float(s.energies[2]) * MJ_PER_J),
        ),
    ),
)


class Plots:
    """The plots of a page.

    Arguments:
        gui: of the page, in the container where they belong
    """

    def __init__(self, gui: viser.GuiApi) -> None:
        self._times = deque[float](maxlen=round(SPAN / EVERY))
        self._values = [
            [deque[float](maxlen=self._times.maxlen) for _ in plot.curves] for plot in PLOTS
        ]
        none = np.zeros(1)
        self._handles = [
            gui.add_uplot(
                (none, *(none for _ in plot.curves)),
                (
                    uplot.Series(label="t [s]"),
                    *(
                        uplot.Series(label=curve.name, stroke=curve.color, width=2)
                        for curve in plot.curves
                    ),
                ),
                title=plot.title,
                scales=plot.scales,
                axes=(uplot.Axis(size=24, space=60), uplot.Axis(size=44, space=24)),
                legend=uplot.Legend(show=len(plot.curves) > 1),
                height=HEIGHT + LEGEND * (len(plot.curves) > 1),
                padding=(4, 8, LEGEND * (len(plot.curves) > 1), 0),
            )
            for plot in PLOTS
        ]

    def clear(self) -> None:
        """Begin anew."""
        self._times.clear()
        for lines in self._values:
            for line in lines:
                line.clear()

    def show(self, snapshot: Snapshot) -> None:
        """Add a moment, if it is time for one."""
        if self._times and snapshot.time < self._times[-1] + EVERY:
            return
        self._times.append(snapshot.time)
        times = np.array(self._times)
        for plot, lines, handle in zip(PLOTS, self._values, self._handles, strict=True):
            for curve, line in zip(plot.curves, lines, strict=True):
                line.append(curve.value(snapshot))
            values = np.array(lines)
            known = np.all(np.isfinite(values), axis=0)  # one that is not takes the curve away
            if np.any(known):
                handle.data = (times[known], *values[:, known])
