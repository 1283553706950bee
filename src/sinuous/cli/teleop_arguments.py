"""What `sinuous teleop` takes; the texts here are its manual."""

from dataclasses import dataclass
from typing import Annotated

from tyro.conf import Positional, arg

from sinuous.cli.arguments import Assignments

LIVE_SCENARIO = "examples/scenarios/live_watchdog.toml"


@dataclass(frozen=True, kw_only=True)
class Teleop:
    """Run a scenario in real time: take the tip on a page in the browser, feel the wall.

    Exit codes: 0 done, 1 it failed and the robot holds still, 2 bad input, 130 interrupted.
    """

    scenario: Positional[Annotated[str, arg(metavar="SCENARIO")]] = LIVE_SCENARIO
    """the scenario's TOML file"""
    leader: Annotated[str | None, arg(metavar="HAND")] = None
    """the hand: "gizmo" is dragged on the page, "recorded" follows the scenario's path, over and
    over again; keyboard (of this terminal), gamepad, spacemouse or haply; a CSV file with columns
    such as t_s,x_mm,y_mm,z_mm; or a recording (.mcap, or its folder), whose hand moves as it did.
    By default the gizmo, or "recorded" where there is no page or no terminal"""
    duration: Annotated[float | None, arg(metavar="S")] = None
    """how long to run [s]; by default until Ctrl-C, or 20 s where there is no terminal"""
    browser: bool = True
    """serve the page, and open it if there is a display"""
    port: Annotated[int, arg(metavar="PORT")] = 8080
    """of the page on this machine; the next that is free if it is taken"""
    out: Annotated[str | None, arg(metavar="DIR")] = None
    """record into a folder; that of an earlier run is overwritten"""
    json: Annotated[str | None, arg(metavar="FILE")] = None
    """file for all numbers: lateness of the loops, missed deadlines, margin, memory"""
    baseline: Annotated[bool, arg()] = False
    """measure beside the loops one that does nothing: what this machine can do just now"""
    set: Assignments = ()
    """change fields of the scenario, such as mpc.horizon=8"""
