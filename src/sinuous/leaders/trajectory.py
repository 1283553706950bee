"""A hand that was recorded before, or written down."""

from pathlib import Path
from typing import Self

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.errors import InputError
from sinuous.files import read_path_csv
from sinuous.leaders.leader import About, ForceKind, Hand, Leader


class Trajectory(Leader):
    """Follows places over time, smoothly and without leaving the range between two of them.

    Between the rows it is piecewise cubic with slopes that keep it monotone (PCHIP), so it neither
    overshoots nor stops at a row. Its zero is the first row, so that nothing jumps when it begins;
    after the last row it rests.

    Arguments:
        times: increasing (K,) [s]; the first is when the session begins
        places: (K, 3) [m]

    Raises:
        ValueError: if they do not fit, are not finite, or the times do not increase
    """

    about = About(
        name="recorded trajectory",
        axes="as recorded",
        force=ForceKind.NONE,
        run_on_hardware=None,
    )

    def __init__(self, times: ArrayLike, places: ArrayLike) -> None:
        t = np.array(times, dtype=np.float64)
        # No slope between places a picometre apart or more is too small to compute with.
        p = np.round(np.array(places, dtype=np.float64), 12)
        if t.ndim != 1 or t.size < 2 or p.shape != (t.size, 3):
            raise ValueError(
                f"a trajectory needs times (K,) and places (K, 3), two or more, "
                f"not {t.shape} and {p.shape}"
            )
        if not np.all(np.isfinite(t)) or not np.all(np.isfinite(p)) or np.any(np.diff(t) <= 0.0):
            raise ValueError("a trajectory needs finite places at times that increase")
        from scipy.interpolate import PchipInterpolator  # late: it takes a while to load

        self._times, self._last = t - t[0], p[-1] - p[0]
        self._cubics = np.ascontiguousarray(
            np.moveaxis(PchipInterpolator(self._times, p - p[0], axis=0).c, 0, 1)
        )
        self.open()

    @classmethod
    def load(cls, path: Path | str) -> Self:
        """That of a CSV file with columns such as `t_s,x_mm,y_mm,z_mm`.

        Raises:
            InputError: naming row and column, if something is missing, not a finite number, or the
                times do not increase
        """
        times, places = read_path_csv(path)
        if len(times) < 2:
            raise InputError(
                file=str(path),
                expected="two rows of numbers or more",
                found="one",
                remedy="A hand that moves needs a row for where it begins and one for the end.",
            )
        return cls(times, places)

    @property
    def duration(self) -> float:
        """How long it takes [s]."""
        return float(self._times[-1])

    def open(self) -> None:
        """Begin with the next reading."""
        self._began: float | None = None

    def read(self, time: float) -> Hand:
        """The hand at a time [s] of the session."""
        if self._began is None:
            self._began = time
        t = time - self._began
        if t >= self._times[-1]:
            return Hand(self._last, held=True, connected=True, age=0.0)
        row = int(np.searchsorted(self._times, t, side="right")) - 1
        a, b, c, d = self._cubics[row]
        s = t - self._times[row]
        place: Array = ((a * s + b) * s + c) * s + d
        return Hand(place, held=True, connected=True, age=0.0)
