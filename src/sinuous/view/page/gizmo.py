"""The target that is dragged: from a drag on the page to an order."""

from collections.abc import Callable
from time import monotonic

import numpy as np
import viser

from sinuous.arrays import Array
from sinuous.live.orders import Aim, Order
from sinuous.view.page.scale import PER_METRE

NAME = "/target"


class TargetGizmo:
    """Three arrows and planes at the target; every tab may drag it.

    Arguments:
        scene: of the page
        order: asks the session for something
        size: of the gizmo [m]
        place: where it begins (3,) [m]
    """

    def __init__(
        self,
        scene: viser.SceneApi,
        order: Callable[[Order], None],
        *,
        size: float,
        place: Array,
    ) -> None:
        self._order = order
        self._handle = scene.add_transform_controls(
            NAME,
            scale=size * PER_METRE,
            line_width=4.0,
            disable_rotations=True,
            depth_test=False,
            position=PER_METRE * place,
        )
        self._handle.on_update(self._dragged)

    def _dragged(self, event: viser.TransformControlsEvent) -> None:
        self.aim()

    def aim(self) -> None:
        """Ask for where it is; the clock's stamp grows over the death of a page's process, too."""
        target = np.asarray(self._handle.position, dtype=np.float64) / PER_METRE
        self._order(Aim(target=target, stamp=monotonic()))

    def put(self, place: Array) -> None:
        """Take it to a place (3,) [m], and ask for that."""
        self._handle.position = PER_METRE * place
        self.aim()

    def remove(self) -> None:
        """Take it away."""
        self._handle.remove()
