"""From a controller's report to planes at the tip."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from sinuous.control.report import Report, Status, Workload
from sinuous.control.wall_force import Walls
from sinuous.scenario import Scenario, load_scenario
from sinuous.session.lookout import Lookout
from sinuous.teleop.motion import NO_WALLS

LIVE = Path(__file__).parents[1] / "examples" / "scenarios" / "live_watchdog.toml"
PUSH = np.array([0.0, 0.0, -0.004])
DAMPED = 1e-6  # what the damping of the tip's mapping takes from 4 mm [m]


def scene(*set: str) -> Scenario:
    return load_scenario(LIVE, set=set)


def leaning(scenario: Scenario, *, qps: int = 1) -> Report:
    """A wall that pushes the tip back by 4 mm of the 10 mm to its target."""
    robot, c = scenario.robot, scenario.first_configuration
    points = robot.points(c)
    walls = Walls(
        robot=robot,
        c=c,
        point=np.array([len(points) - 1]),
        push=PUSH[None],
        goal=points[-1] + [0.0, 0.0, 0.01],
    )
    return Report(
        status=Status.TRACKING,
        solve_time=0.0,
        workload=Workload(qps=qps),
        step_fraction=1.0,
        points=points,
        robot=robot,
        zone=scenario.zone,
        walls=walls,
    )


def test_the_plane_is_where_walls_hold_the_tip_that_wants_to_its_target() -> None:
    scenario = scene()
    target = np.array([0.01, 0.0, 0.07])
    held, near = Lookout(scenario).walls(scenario.first_configuration, target, leaning(scenario))
    np.testing.assert_allclose(held.way, PUSH, atol=DAMPED)
    np.testing.assert_allclose(held.place, target + PUSH, atol=DAMPED)
    assert near == NO_WALLS.near


def test_a_step_without_a_plan_leaves_the_wall_where_it_was() -> None:
    scenario, lookout = scene(), Lookout(scene())
    c, report = scenario.first_configuration, leaning(scenario)
    before = lookout.walls(c, np.zeros(3), report).held
    for blind in (leaning(scenario, qps=0), replace(report, walls=None)):
        assert lookout.walls(c, np.ones(3), blind).held is before


def test_who_does_not_ask_for_walls_gets_none() -> None:
    scenario = scene("teleop.force.constraints=false")
    walls = Lookout(scenario).walls(scenario.first_configuration, np.zeros(3), leaning(scenario))
    assert walls == NO_WALLS


def test_closeness_is_looked_for_if_asked() -> None:
    scenario = scene("teleop.force.nearness_mm=30")
    near = (
        Lookout(scenario).walls(scenario.first_configuration, np.zeros(3), leaning(scenario)).near
    )
    assert np.any(near.way)
    np.testing.assert_array_equal(
        near.place - near.way, scenario.robot.tip(scenario.first_configuration)
    )
