"""From metres and colours to what the page takes."""

import numpy as np
from numpy.typing import NDArray

from sinuous.arrays import Array
from sinuous.view.style import rgb

PER_METRE = 10.0
"""Units of the page in a metre: viser's camera does not draw what is closer than 0.01 of them."""


def units(lengths: Array) -> NDArray[np.float32]:
    """Lengths [m] in units of the page."""
    return (PER_METRE * lengths).astype(np.float32)


def byte_color(name: str) -> tuple[int, int, int]:
    """A colour "#RRGGBB" in numbers to 255."""
    red, green, blue = np.round(255.0 * rgb(name)).astype(int)
    return int(red), int(green), int(blue)
