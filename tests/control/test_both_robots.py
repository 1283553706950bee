"""Every controller drives both kinds of robot: none of them knows a robot by name."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.control.dls import DampedLeastSquares
from sinuous.control.hierarchical import HierarchicalController
from sinuous.control.mpc import Costs, ShapeConstrainedMPC
from sinuous.control.projected import ProjectedTarget
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone
from sinuous.plants.kinematic import Disturbance, KinematicPlant
from sinuous.plants.sensors import TipTracker
from sinuous.robots.bending import bends
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot

MARGIN, DT = 0.005, 0.02
CLOSE = 1e-3  # what damped least squares leaves of a way of a fifth of the robot [m]
BIAS = 0.02  # of the printed cost, as a share of the robot (notes B5)
DISTURBED = 5e-3  # largest output disturbance drawn here, and what feedback may leave [m]
ROUNDING = 1e-9  # of a rate, in units of its limit

ROBOTS = {"hachen2025": (0.06, 2), "qin2020": (0.25, 1)}  # radius of the tube [m], its axis


def in_a_tube(name: str) -> tuple[Robot, SafeZone]:
    """A robot in a straight tube with room to bend."""
    robot, (radius, axis) = load_robot(name), ROBOTS[name]
    ends = np.zeros((2, 3))
    ends[:, axis] = -0.3 * robot.tip(robot.home)[axis], 1.5 * robot.tip(robot.home)[axis]
    return robot, SafeZone.from_mesh(shapes.tube(ends, radius))


def plan(robot: Robot, zone: SafeZone, **more: Any) -> ShapeConstrainedMPC:
    return ShapeConstrainedMPC(robot, zone, margin=MARGIN, dt=DT, horizon=5, **more)


CONTROLLERS: dict[str, Callable[[Robot, SafeZone], Any]] = {
    "plan": plan,
    "printed cost": lambda robot, zone: plan(robot, zone, costs=Costs.printed()),
    "feedback": lambda robot, zone: HierarchicalController(plan(robot, zone)),
    "damped least squares": lambda robot, zone: DampedLeastSquares(
        robot, zone, margin=MARGIN, dt=DT, gain=0.2, damping=1e-3
    ),
    "projected": lambda robot, zone: ProjectedTarget(plan(robot, zone)),
}


@pytest.mark.parametrize("controller", CONTROLLERS)
@pytest.mark.parametrize("name", ROBOTS)
def test_the_tip_gets_there_within_all_limits(name: str, controller: str) -> None:
    robot, zone = in_a_tube(name)
    steers, plant = CONTROLLERS[controller](robot, zone), KinematicPlant(robot, seed=0)
    bent = robot.home.copy()
    column = robot.bend_limits.column
    bent[column[0]] += 0.15
    bent[column[-1] + 1] -= 0.1
    target, state, measured = robot.tip(bent), steers.init(robot.home), None
    for _ in range(200):
        state, command = steers.step(state, target, measured)
        measured = plant.step(command.rates, DT)
        worst = np.max(np.abs(command.rates) / robot.rate_limits[:, 1])
        assert worst <= 1.0 + ROUNDING
        assert np.min(robot.bend_slack(state.c)) >= -ROUNDING
    close = BIAS * np.linalg.norm(target) if controller == "printed cost" else CLOSE
    assert np.linalg.norm(plant.truth.points[-1] - target) < close


@pytest.mark.parametrize("name", ROBOTS)
def test_feedback_makes_up_for_disturbances(name: str) -> None:
    robot, zone = in_a_tube(name)
    steers = HierarchicalController(plan(robot, zone))
    plant = TipTracker().on(
        KinematicPlant(robot, seed=3, disturbance=Disturbance.printed()), seed=3
    )
    target, state, measured, errors = robot.tip(robot.home), steers.init(robot.home), None, []
    for _ in range(200):
        state, command = steers.step(state, target, measured)
        measured = plant.step(command.rates, DT)
        errors.append(np.linalg.norm(plant.truth.points[-1] - target))
    assert np.median(errors[50:]) < DISTURBED
    assert np.max(bends(robot.bend_limits, state.c)) < 1.0
