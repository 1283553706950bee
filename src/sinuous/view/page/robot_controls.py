"""Controller and plant: what takes a new start to change."""

from collections.abc import Callable

import viser

from sinuous.live.orders import Order, Reset
from sinuous.scenario import Scenario
from sinuous.view.units import MM_PER_M

KINEMATIC, PHYSICS = "kinematics alone", "physics (MuJoCo)"
PLANTS = (KINEMATIC, PHYSICS)
LONGEST = 20  # horizon [steps]


class RobotControls:
    """Fields and a button that begins again with them.

    Arguments:
        gui: of the page, in the container where they belong
        order: asks the session for something
    """

    def __init__(self, gui: viser.GuiApi, order: Callable[[Order], None]) -> None:
        self._order = order
        self._before = dict[str, str]()
        with gui.add_folder("Controller"):
            self._horizon = gui.add_slider("horizon [steps]", 1, LONGEST, 1, 5)
            self._margin = gui.add_number("margin to every wall [mm]", 3.0, min=0.0, step=0.5)
            self._speed = gui.add_number("tip speed, at most [mm/s]", 60.0, min=1.0, step=5.0)
        with gui.add_folder("Robot"):
            self._plant = gui.add_dropdown("stands in for the robot", PLANTS)
            self._disturbance = gui.add_slider(
                "disturbed by, standard deviation [mm]", 0.0, 5.0, 0.1, 0.0
            )
            self._payload = gui.add_number(
                "payload at the tip [g]", 0.0, min=0.0, step=5.0, hint="physics only"
            )
        self._apply = gui.add_button(
            "Begin again with these", hint="the robot holds still for a second or two"
        )
        self._apply.on_click(lambda _: self._reset())

    def take(self, scenario: Scenario) -> None:
        """Show what a scenario has."""
        mpc = scenario.mpc
        self._horizon.value = min(mpc.horizon, LONGEST)
        self._margin.value = round(mpc.margin * MM_PER_M, 3)
        if mpc.tip_speed is not None:
            self._speed.value = round(mpc.tip_speed * MM_PER_M, 3)
        self._plant.value = KINEMATIC if scenario.plant is None else PHYSICS
        disturbance = scenario.disturbance
        deviation = 0.0 if disturbance is None else disturbance.length_std
        self._disturbance.value = round(deviation * MM_PER_M, 1)
        self._before = self._fields()

    def _fields(self) -> dict[str, str]:
        """Fields of the scenario and what they would be."""
        return {
            "mpc.horizon": str(int(self._horizon.value)),
            "mpc.margin_mm": f"{self._margin.value:g}",
            "mpc.tip_speed_mm_s": f"{self._speed.value:g}",
            "plant": self._plant_table(),
        }

    def _plant_table(self) -> str:
        """The whole table, for a plant of one kind must not keep fields of another."""
        if self._plant.value == PHYSICS:
            return f"{{physics={{payload_g={self._payload.value:g}}}}}"
        if self._disturbance.value > 0.0:
            return f"{{disturbance={{length_std_mm={self._disturbance.value:g}}}}}"
        return "{}"

    def _reset(self) -> None:
        fields = self._fields()
        changed = tuple(f"{k}={v}" for k, v in fields.items() if self._before.get(k) != v)
        self._order(Reset(set=changed))
