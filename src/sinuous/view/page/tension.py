"""Colours of cables by how hard they are pulled."""

import numpy as np
from matplotlib import colormaps

from sinuous.arrays import Array
from sinuous.view.style import PURPLE, rgb

SLACK = 0.05  # [N] at which a cable hangs
SHADES = colormaps["cividis"](np.linspace(0.0, 1.0, 256))[:, :3]
"""Made for colour-blind people: dark blue without tension to yellow."""


class TensionColours:
    """From the tension to a colour, on a scale that grows with the largest seen so far."""

    def __init__(self) -> None:
        self.top = 1.0
        """Tension [N] of the brightest colour."""

    def of(self, tensions: Array) -> Array:
        """Colours (C, 3) of tensions (C,) [N]; purple, off the scale, if slack."""
        if not len(tensions):
            return np.zeros((0, 3))
        while float(np.max(tensions)) > self.top:
            self.top *= 2.0
        shade = np.clip(255.0 * tensions / self.top, 0.0, 255.0).astype(np.int64)
        return np.where((tensions <= SLACK)[:, None], rgb(PURPLE), SHADES[shade])
