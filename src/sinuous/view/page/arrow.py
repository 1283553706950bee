"""A force as an arrow."""

import numpy as np
import viser

from sinuous.arrays import Array
from sinuous.view.page.scale import PER_METRE, byte_color, units

FULL = 5.0  # force [N] whose arrow is as long as SHARE of the scene
SHARE, LONGEST = 0.25, 0.5
LEAST_FORCE = 0.02  # [N] below which there is no arrow


class Arrow:
    """An arrow, to begin with none.

    Arguments:
        scene: of the page
        name: in it
        color: as "#RRGGBB"
        size: of the whole scene [m]
    """

    def __init__(self, scene: viser.SceneApi, name: str, *, color: str, size: float) -> None:
        self._size, radius = size, 0.008 * size * PER_METRE
        self._handle = scene.add_arrows(
            name,
            np.array([[[0.0, 0.0, 0.0], [0.0, 0.0, 1.0]]], dtype=np.float32),
            byte_color(color),
            shaft_radius=0.35 * radius,
            head_radius=0.9 * radius,
            head_length=2.0 * radius,
            visible=False,
        )

    @property
    def metres_per_newton(self) -> float:
        """Its length for one newton."""
        return SHARE * self._size / FULL

    @property
    def handle(self) -> viser.SceneNodeHandle:
        """What is in the scene."""
        return self._handle

    def show(self, place: Array, force: Array) -> None:
        """Show a force (3,) [N] at a place (3,) [m]; one that is too long is cut."""
        strength = float(np.linalg.norm(force))
        self._handle.visible = strength > LEAST_FORCE
        if strength > LEAST_FORCE:
            reach = min(self.metres_per_newton, LONGEST * self._size / strength) * force
            self._handle.points = units(np.stack([place, place + reach])[None])
