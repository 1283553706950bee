"""The connection between hand and robot, and what the hand feels: changed while it runs."""

from collections.abc import Callable

import viser

from sinuous.live.orders import Order, SetFeel, SetLink
from sinuous.scenario.teleop_tables import SchemeChoice, TeleopTable
from sinuous.view.page.deferred import Deferred
from sinuous.view.units import MS_PER_S, PERCENT

SCHEMES = {
    "modified waves, C2": SchemeChoice.C2,
    "waves, C1": SchemeChoice.C1,
    "standard waves": SchemeChoice.STANDARD,
    "position and force": SchemeChoice.POSITION_FORCE,
}


class LinkControls:
    """Sliders for the link, and for scheme and forces.

    Arguments:
        gui: of the page, in the container where they belong
        order: asks the session for something
    """

    def __init__(self, gui: viser.GuiApi, order: Callable[[Order], None]) -> None:
        self._order = order
        with gui.add_folder("Link"):
            self._delay = gui.add_slider("delay, one way [ms]", 0.0, 1000.0, 5.0, 0.0)
            self._jitter = gui.add_slider("jitter, to either side [ms]", 0.0, 200.0, 1.0, 0.0)
            self._loss = gui.add_slider("packets lost [%]", 0.0, 50.0, 1.0, 0.0)
        with gui.add_folder("Scheme and force"):
            self._scheme = gui.add_dropdown("scheme", tuple(SCHEMES))
            self._impedance = gui.add_slider("impedance b [N s/m]", 0.5, 50.0, 0.5, 2.0)
            self._gain = gui.add_slider("gain of the error [N]", 0.0, 20.0, 0.1, 3.0)
            self._stiffness = gui.add_slider("stiffness of walls [N/m]", 0.0, 1000.0, 5.0, 100.0)
        self._link, self._feel = Deferred(self._set_link), Deferred(self._set_feel)
        for handle in (self._delay, self._jitter, self._loss):
            handle.on_update(self._link.ask)
        for handle in (self._scheme, self._impedance, self._gain, self._stiffness):
            handle.on_update(self._feel.ask)

    def take(self, table: TeleopTable) -> None:
        """Show what a scenario has."""
        link = table.link
        self._delay.value = round(table.delay * MS_PER_S)
        self._jitter.value = round((link.jitter if link else 0.0) * MS_PER_S)
        self._loss.value = round((link.loss if link else 0.0) * PERCENT)
        self._scheme.value = next(k for k, v in SCHEMES.items() if v is table.scheme)
        self._impedance.value = table.waves.impedance
        self._gain.value = table.force.gain
        self._stiffness.value = table.force.stiffness
        for one in (self._link, self._feel):
            one.forget()

    def settle(self) -> None:
        """Send what has come to rest."""
        self._link.settle()
        self._feel.settle()

    def _set_link(self) -> None:
        self._order(
            SetLink(
                delay=self._delay.value / MS_PER_S,
                jitter=self._jitter.value / MS_PER_S,
                loss=self._loss.value / PERCENT,
            )
        )

    def _set_feel(self) -> None:
        self._order(
            SetFeel(
                scheme=SCHEMES[self._scheme.value],
                impedance=self._impedance.value,
                gain=self._gain.value,
                stiffness=self._stiffness.value,
            )
        )
