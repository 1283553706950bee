"""A live session on a page: stage, panel, plots and the target, kept up to date."""

from collections.abc import Callable
from dataclasses import fields
from itertools import count

import numpy as np
import viser

from sinuous.live import Recipe, Snapshot
from sinuous.live.orders import Order, PageLost
from sinuous.live.processes import LeaderMaker
from sinuous.session.header import make_header
from sinuous.view.page.gizmo import TargetGizmo
from sinuous.view.page.moment import Moment
from sinuous.view.page.panel import Panel
from sinuous.view.page.plots import Plots
from sinuous.view.page.setup import Setup
from sinuous.view.page.stage import Stage

GIZMO = 0.16
"""Size of the target's arrows by that of the scene."""

SLOW = 6  # frames between two updates of the slower parts


class Page:
    """Everything on the page.

    Arguments:
        server: of the page
        order: asks the session for something
        hands: makers of devices by what they are called, the one in use first
    """

    def __init__(
        self,
        server: viser.ViserServer,
        order: Callable[[Order], None],
        hands: dict[str, LeaderMaker],
    ) -> None:
        self._server, self._order = server, order
        self._stage: Stage | None = None
        self._gizmo: TargetGizmo | None = None
        self._tip, self._parted, self._frames = np.zeros(3), False, count()
        self._panel = Panel(server, order, hands, self._rejoin)
        tab = self._panel.tabs.add_tab("Setup")
        self._setup = Setup(server, order, self._tell, tab=tab)
        curves = server.gui.add_panel()
        with curves.add_tab("Last 20 s"):
            self._plots = Plots(server.gui)
        curves.dock_left()
        server.on_client_disconnect(lambda _: self._left())

    def begin(self, recipe: Recipe) -> None:
        """Loops have begun, or begun again: show their scenario."""
        scenario = recipe.make()
        self.remove()
        stage = Stage(self._server.scene, make_header(scenario), scenario.robot)
        self._stage = stage
        position, look_at = stage.home_camera()
        self._server.initial_camera.position = position
        self._server.initial_camera.look_at = look_at
        self._tip = scenario.robot.tip(scenario.first_configuration)
        self._panel.begin(scenario)
        self._setup.scenario_changed(scenario, recipe.file)
        self._plots.clear()
        if self._panel.is_dragged:
            self._gizmo = TargetGizmo(
                self._server.scene, self._order, size=GIZMO * stage.size, place=self._tip
            )

    def remove(self) -> None:
        """Clear the stage."""
        if self._stage is not None:
            self._stage.remove()
        if self._gizmo is not None:
            self._gizmo.remove()
        self._stage = self._gizmo = None

    def show(self, snapshot: Snapshot) -> None:
        """How things are, 30 times a second."""
        if self._stage is None:
            return
        self._tip = snapshot.actual[-1]
        with self._server.atomic():
            self._stage.show(moment_of(snapshot))
            self._panel.show(snapshot)
        if next(self._frames) % SLOW == 0:
            self._plots.show(snapshot)
            self._panel.show_timing(snapshot)
        self._setup.show(snapshot)
        self._part(snapshot)

    def close(self) -> None:
        """Leave nothing behind."""
        self._setup.close()

    def recording(self, folder: str | None) -> None:
        """Show whether what happens is recorded."""
        self._panel.recording(folder)

    def tell(self, text: str, *, lasting: bool) -> None:
        """Say something that people should read."""
        self._panel.tell(text, lasting=lasting)

    def settle(self) -> None:
        """Send what sliders say, once they have come to rest."""
        self._panel.settle()

    def _tell(self, text: str) -> None:
        self.tell(text, lasting=False)

    def _part(self, snapshot: Snapshot) -> None:
        """When hand and robot are apart, the target waits where they meet again: at the tip."""
        apart = snapshot.paused and snapshot.share == 0.0
        if apart and not self._parted and snapshot.connected and self._gizmo is not None:
            self._gizmo.put(self._tip)
        self._parted = apart

    def _rejoin(self) -> None:
        if self._gizmo is not None:
            self._gizmo.put(self._tip)

    def _left(self) -> None:
        if not self._server.get_clients():
            self._order(PageLost())


def moment_of(snapshot: Snapshot) -> Moment:
    """What of a snapshot the stage shows."""
    return Moment(**{field.name: getattr(snapshot, field.name) for field in fields(Moment)})
