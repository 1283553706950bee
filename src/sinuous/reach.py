"""Whether the robot can bring its tip to a place, and what stops it if not."""

from dataclasses import dataclass, replace

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.control.report import Active, Report, Status
from sinuous.geometry.safe_zone import SafeZone
from sinuous.scenario import Scenario
from sinuous.scenario.start import check_start
from sinuous.session import Rest

REACHED = 1e-5  # the tip is there if it is no farther away [m]
MAX_STEPS = 600
MM_PER_M = 1e3  # explanations speak of millimetres


@dataclass(frozen=True, kw_only=True, eq=False)
class Reach:
    """What became of an attempt to reach a target.

    Arguments:
        target: (3,) [m]
        tip: where the tip ended (3,) [m]
        distance: between them [m]
        steps: of control until the robot rested or gave up
        rested: whether it came to rest
        status: of the last step
        configuration: it ended with (n,)
        obstacles: what stops the robot, the strongest first, in words; empty if it is there
    """

    target: Array
    tip: Array
    distance: float
    steps: int
    rested: bool
    status: Status
    configuration: Array
    obstacles: tuple[str, ...]

    @property
    def reached(self) -> bool:
        """Whether the tip is at the target."""
        return self.distance <= REACHED


def reaches(scenario: Scenario, target: ArrayLike, *, max_steps: int = MAX_STEPS) -> Reach:
    """Drive the undisturbed robot from its start towards a target until it rests.

    The controller looks ahead a few steps only: where it stops, a detour may still exist.

    Arguments:
        scenario: robot, zone, controller and start; its path and plant are not used
        target: (3,) [m]
        max_steps: the most control steps to try

    Raises:
        InputError: if the robot may not start where it stands
    """
    check_start(scenario)
    mpc, goal = scenario.mpc, np.array(target, dtype=np.float64)
    state, rest, rested = mpc.init(scenario.first_configuration), Rest(mpc.dt), False
    report, step = None, 0
    while step < max_steps and not rested:
        state, command = mpc.step(state, goal)
        report, step = command.report, step + 1
        rested = rest.after(report.points)
    if report is None:
        raise ValueError("an attempt takes at least one step")
    tip = report.points[-1]
    found = Reach(
        target=goal,
        tip=tip,
        distance=float(np.linalg.norm(tip - goal)),
        steps=step,
        rested=rested,
        status=report.status,
        configuration=state.c,
        obstacles=(),
    )
    return found if found.reached else replace(found, obstacles=_obstacles(scenario, found, report))


def _obstacles(scenario: Scenario, found: Reach, report: Report) -> tuple[str, ...]:
    reasons = [*_room(scenario, found.target)]
    if report.reason:
        reasons.append(report.reason)
    reasons += [_place(active, scenario.zone) for active in report.active]
    if not found.rested:
        reasons.append(f"still moving after {found.steps} steps")
    return tuple(reasons)


def _room(scenario: Scenario, target: Array) -> list[str]:
    """What is wrong with the target itself."""
    clearance = float(scenario.zone.clearance(target))
    radius, margin = float(scenario.robot.radii[-1]), scenario.mpc.margin
    if clearance >= radius + margin:
        return []
    where = (
        f"{-clearance * MM_PER_M:.3g} mm outside the zone"
        if clearance < 0.0
        else f"{clearance * MM_PER_M:.3g} mm from the wall"
    )
    needed = f"{(radius + margin) * MM_PER_M:.3g} mm"
    return [f"the target is {where}; the tip's radius and the margin need {needed} inside"]


def _place(active: Active, zone: SafeZone) -> str:
    """An active constraint, and where its wall is."""
    if active.triangle < 0:
        return active.name
    centre = zone.triangles[active.triangle].mean(axis=0) * MM_PER_M
    return f"{active.name}, a wall around ({', '.join(f'{x:.1f}' for x in centre)}) mm"
