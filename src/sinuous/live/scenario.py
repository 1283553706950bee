"""A scenario as it runs live: with an operator in real time, and on a link that may get bad."""

from dataclasses import dataclass, replace
from pathlib import Path

from sinuous.errors import InputError
from sinuous.scenario import Scenario, load_scenario
from sinuous.scenario.link_tables import LinkTable, PassivityTable
from sinuous.scenario.teleop import Teleoperation
from sinuous.scenario.teleop_tables import HandChoice, TeleopTable


@dataclass(frozen=True)
class Recipe:
    """How a scenario is made, in any process: a scenario itself cannot be sent to another one.

    Arguments:
        file: of the scenario
        set: fields to change, as on the command line
    """

    file: str
    set: tuple[str, ...] = ()

    def make(self) -> Scenario:
        """The scenario, as it runs live.

        Raises:
            InputError: if it cannot be used
        """
        return as_live(load_scenario(Path(self.file), set=self.set))


def as_live(scenario: Scenario) -> Scenario:
    """A scenario with all that a live session needs.

    Without an operator it gets one with default settings. The device is held by a spring and a
    damper to where the hand is, unless the scenario says that it is moved as the hand moves. There
    is passivity control on any link, for it may become another one.
    """
    teleop = scenario.teleop
    if teleop is None:
        tip = scenario.robot.tip(scenario.first_configuration)
        teleop = Teleoperation(table=TeleopTable(), mpc=scenario.mpc, tip=tip, seed=scenario.seed)
    table = teleop.table
    kind = table.operator.kind
    if kind is HandChoice.MOVE_AND_WAIT:  # a model of what an operator decides
        kind = HandChoice.IMPEDANCE
    table = replace(
        table,
        operator=replace(table.operator, kind=kind),
        link=table.link or LinkTable(),
        passivity=table.passivity or PassivityTable(),
    )
    return replace(scenario, teleop=replace(teleop, table=table))


def ticks_per_step(scenario: Scenario) -> int:
    """Ticks of the operator's side in a step of the controller.

    Raises:
        InputError: if that is no whole number
    """
    assert scenario.teleop is not None
    dt, tick = scenario.controller.dt, scenario.teleop.dt
    ticks = round(dt / tick)
    if ticks < 1 or abs(dt - ticks * tick) > 1e-9 * dt:
        raise InputError(
            file=scenario.file,
            field="mpc.rate_hz",
            expected=f"a rate that divides {1.0 / tick:g} Hz, the rate of the operator's side",
            found=f"{1.0 / dt:g} Hz",
            remedy="Set it to 100, or with a fast controller to the same.",
        )
    return ticks
