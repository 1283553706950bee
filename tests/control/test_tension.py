"""Cables that stay taut: what the controller around another adds to its rates."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.control.mpc import ShapeConstrainedMPC
from sinuous.control.report import Command, Status
from sinuous.control.tension import TautCables
from sinuous.control.tension_estimate import BackboneTensions
from sinuous.geometry.safe_zone import SafeZone
from sinuous.measurement import Measurement
from sinuous.plants.kinematic import KinematicPlant
from sinuous.robots.cables import cable_rows, co_contractions
from sinuous.robots.pcc import PccRobot
from sinuous.robots.robot import Robot
from sinuous.robots.robot_file import load_robot

DT = 1 / 30
STIFFNESS, FLOOR = 1e4, 1.0  # [N/m], [N]
ROUNDING = 1e-9
BENT = [0.05, 0.02, 0.15]


def mpc(name: str = "hachen2025") -> ShapeConstrainedMPC:
    return ShapeConstrainedMPC(
        load_robot(name), SafeZone.unbounded(), margin=0.003, dt=DT, horizon=3
    )


class Elastic:
    """A robot whose cables pull by how much shorter they are than the nominal shape's."""

    def __init__(self, robot: Robot, rest: Array) -> None:
        self.robot, self.rest, self.lengths = robot, rest, robot.lengths(robot.home)

    def step(self, rates: Array, c: Array) -> Measurement:
        """Moves, given the configuration (n,) that the backbone has."""
        self.lengths = self.lengths + DT * rates
        rows = cable_rows(self.robot)
        stretch = (self.robot.lengths(c) - self.lengths)[rows]
        tensions = np.maximum(self.rest + STIFFNESS * stretch, 0.0)
        return Measurement(tip=self.robot.tip(c), lengths=self.lengths, tensions=tensions)


def run(rest: Array, steps: int = 150, **options: Any) -> tuple[Measurement, Any, list[Command]]:
    inner = mpc()
    taut = TautCables(inner, floor=FLOOR, stiffness=STIFFNESS, **options)
    plant, state, commands = Elastic(inner.robot, rest), taut.init(inner.robot.home), []
    measured = plant.step(np.zeros(12), inner.robot.home)
    for _ in range(steps):
        state, command = taut.step(state, BENT, measured)
        measured = plant.step(command.rates, state.c)
        commands.append(command)
    return measured, state, commands


def test_every_cable_comes_to_the_floor_and_the_robot_to_its_target() -> None:
    measured, state, commands = run(np.full(9, -3.0))
    assert np.min(measured.tensions) == pytest.approx(FLOOR, abs=1e-3)
    assert np.linalg.norm(mpc().robot.tip(state.c) - BENT) < 1e-3
    np.testing.assert_array_equal(commands[0].tensions, 0.0)


def test_what_is_taut_by_itself_is_left_alone() -> None:
    _, state, commands = run(np.full(9, 5.0))
    np.testing.assert_array_equal(state.pulled, 0.0)
    alone = mpc()
    inner = alone.init(alone.robot.home)
    for command in commands:
        inner, plain = alone.step(inner, BENT)
        np.testing.assert_array_equal(command.rates, plain.rates)


def test_what_was_pulled_in_is_let_out_again() -> None:
    inner = mpc()
    taut = TautCables(inner, floor=FLOOR, stiffness=STIFFNESS)
    lengths = inner.robot.lengths(inner.robot.home)
    state = replace(taut.init(inner.robot.home), pulled=np.full(3, 1e-3))
    told = Measurement(tip=inner.robot.tip(inner.robot.home), lengths=lengths,
                       tensions=np.full(9, 100.0))  # fmt: skip
    for _ in range(10):
        state, _ = taut.step(state, inner.robot.tip(inner.robot.home), told)
    np.testing.assert_array_equal(state.pulled, 0.0)


def test_no_more_than_the_most_is_pulled_in_and_no_faster_than_motors_can() -> None:
    robot = mpc().robot
    _, state, commands = run(np.full(9, -1e3), most=1e-3)
    np.testing.assert_allclose(state.pulled, 1e-3)
    slowest, fastest = robot.rate_limits.T
    for command in commands:
        assert np.all(command.rates >= slowest - ROUNDING)
        assert np.all(command.rates <= fastest + ROUNDING)


def test_one_slack_cable_pulls_its_own_group_only() -> None:
    rest = np.full(9, 50.0)
    rest[4] = -1.0
    _, state, _ = run(rest)
    own = co_contractions(mpc().robot)[:, 4] > 0.0
    assert np.all(state.pulled[own] > 0.0)
    np.testing.assert_array_equal(state.pulled[~own], 0.0)


def test_no_cable_is_pulled_in_beyond_its_limit() -> None:
    inner = mpc()
    robot, c = inner.robot, inner.robot.home.copy()
    c[[2, 5, 8]] = 0.0225  # of a segment; its cables may be 22 mm short
    taut = TautCables(inner, floor=FLOOR, stiffness=STIFFNESS)
    room = taut._room(c)
    np.testing.assert_allclose(room, 0.5e-3)
    calm = Command(rates=np.zeros(12), report=inner.step(inner.init(robot.home), BENT)[1].report)
    pulled = np.zeros(3)
    for _ in range(100):
        pulled = taut._pulled(pulled, np.full(9, -100.0), calm, room)
    np.testing.assert_allclose(pulled, room)


def test_who_holds_still_does_not_pull() -> None:
    inner = mpc()
    taut = TautCables(inner, floor=FLOOR, stiffness=STIFFNESS)
    lengths = inner.robot.lengths(inner.robot.home)
    told = Measurement(tip=inner.robot.tip(inner.robot.home), lengths=lengths, tensions=np.zeros(9))
    state, command = taut.step(taut.init(inner.robot.home), [np.nan, 0.0, 0.1], told)
    assert command.report.status is Status.HOLDING
    np.testing.assert_array_equal(command.rates, 0.0)
    np.testing.assert_array_equal(state.pulled, 0.0)


@pytest.mark.parametrize("tensions", [np.zeros(0), np.full(9, np.nan)])
def test_without_tensions_it_is_the_controller_inside(tensions: Array) -> None:
    inner = mpc()
    taut = TautCables(inner, floor=FLOOR, stiffness=STIFFNESS)
    told = KinematicPlant(inner.robot, seed=0).step(np.zeros(12), DT)
    state, command = taut.step(taut.init(inner.robot.home), BENT, replace(told, tensions=tensions))
    _, plain = inner.step(inner.init(inner.robot.home), BENT)
    np.testing.assert_array_equal(command.rates, plain.rates)
    np.testing.assert_array_equal(state.pulled, 0.0)


@pytest.mark.parametrize("field", ["floor", "stiffness", "time_constant", "most"])
def test_numbers_that_make_no_sense(field: str) -> None:
    with pytest.raises(ValueError, match=field):
        TautCables(mpc(), **{"floor": 1.0, "stiffness": 1.0} | {field: 0.0})


# --- the estimate -----------------------------------------------------------------------------


def robot() -> PccRobot:
    found = load_robot("hachen2025")
    assert isinstance(found, PccRobot)
    return found


def test_straight_cables_have_their_pretension_and_what_is_pulled_in() -> None:
    cables = robot().mechanics.cables
    shift = 1e-4 * np.arange(9.0)
    found = BackboneTensions(robot=robot())(robot().home, np.repeat(shift[::3], 3))
    np.testing.assert_allclose(
        found, cables.stiffness * (cables.pretension + np.repeat(shift[::3], 3))
    )


def test_estimated_tensions_hold_the_moment_of_the_last_segment() -> None:
    """Sum of t_m h_m = E I theta / gamma, with the holes h_m of three cables at 120 degrees."""
    one, c = robot(), robot().home.copy()
    c[6:8] = 0.3, -0.2
    found = BackboneTensions(robot=one)(c, np.zeros(9))
    holes = one.segments[2].holes
    expected = one.mechanics.backbone.bending_stiffness * c[6:8] / c[8]
    np.testing.assert_allclose(found[6:] @ holes, expected, rtol=1e-9)
    assert np.argmax(found[6:]) == np.argmax(holes @ c[6:8])  # the inner cable pulls most
