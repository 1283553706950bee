"""Targets projected onto the zone: closed forms, and where the projection jumps."""

import numpy as np
import pytest

from sinuous.control.dls import DampedLeastSquares
from sinuous.control.mpc import RESERVE, ShapeConstrainedMPC
from sinuous.control.projected import ENOUGH, ProjectedTarget, projected
from sinuous.control.report import Status
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone

from .scenes import START, bent_tube, robot_at

BOX = SafeZone.from_mesh(shapes.box([0.2, 0.3, 0.4]))
HALF = np.array([0.1, 0.15, 0.2])
KEPT = 0.011  # [m]


def test_a_place_with_enough_room_is_left_alone() -> None:
    rng = np.random.default_rng(1)
    for p in rng.uniform(-1.0, 1.0, (50, 3)) * (HALF - KEPT):
        np.testing.assert_array_equal(projected(BOX, p, KEPT), p)


@pytest.mark.parametrize("axis", range(3))
@pytest.mark.parametrize("depth", [-0.05, -1e-6, 0.002, 0.0109])
def test_beside_one_wall_it_is_the_nearest_place(axis: int, depth: float) -> None:
    p = np.array([0.01, -0.02, 0.03])
    p[axis] = HALF[axis] - depth
    nearest = p.copy()
    nearest[axis] = HALF[axis] - KEPT
    np.testing.assert_allclose(projected(BOX, p, KEPT), nearest, rtol=0, atol=2 * ENOUGH)


def test_every_place_gets_its_room() -> None:
    rng = np.random.default_rng(2)
    for p in rng.uniform(-0.4, 0.4, (200, 3)):
        assert BOX.clearance(projected(BOX, p, KEPT)) >= KEPT
        # Not the nearest place beside edges and corners, but not far from it.
        nearest = np.clip(p, -(HALF - KEPT), HALF - KEPT)
        assert np.linalg.norm(projected(BOX, p, KEPT) - nearest) <= 3**0.5 * KEPT


def test_where_it_is_too_narrow_it_is_in_the_middle() -> None:
    slit = SafeZone.from_mesh(shapes.box([0.01, 0.3, 0.4]))
    p = projected(slit, np.array([0.05, 0.0, 0.0]), KEPT)
    assert slit.clearance(p) > 0.004


def test_it_jumps_where_two_walls_are_equally_near() -> None:
    """Two rooms side by side, joined at one end: a U. Between its legs the nearest one changes."""
    legs = shapes.box([0.2, 0.1, 0.2]), shapes.box([0.06, 0.2, 0.15], centre=[0.0, 0.0, 0.03])
    zone = SafeZone.from_mesh(legs[0]).minus(legs[1], name="between the legs")
    left, right = (projected(zone, np.array([x, 0.0, 0.02]), KEPT) for x in (-1e-6, 1e-6))
    assert np.linalg.norm(right - left) > 0.06


def test_the_controller_sees_the_projection_and_nothing_else_changes() -> None:
    scene = bent_tube()
    dls = DampedLeastSquares(scene.robot, scene.zone, margin=0.002)
    behind = ProjectedTarget(dls)
    assert (behind.robot, behind.zone, behind.margin, behind.dt) == (
        dls.robot, dls.zone, dls.margin, dls.dt,
    )  # fmt: skip
    outside = scene.axis[10] + np.array([0.05, 0.0, 0.0])
    inside = behind.project(outside)
    assert scene.zone.clearance(outside) < 0.0
    assert scene.zone.clearance(inside) >= scene.robot.required_distance(0.002)[-1]
    state = behind.init(START)
    _, there = behind.step(state, outside)
    _, here = dls.step(state, inside)
    np.testing.assert_array_equal(there.rates, here.rates)


def test_an_mpc_reaches_the_projection() -> None:
    zone = SafeZone.from_mesh(shapes.box([0.3, 0.3, 0.6]))
    behind = ProjectedTarget(ShapeConstrainedMPC(robot_at(0.0), zone, margin=0.002))
    outside = np.array([0.25, 0.0, 0.12])
    state = behind.init(behind.robot.home)
    for _ in range(200):
        state, _ = behind.step(state, outside)
    # The plan keeps a reserve of its own to the wall.
    assert np.linalg.norm(behind.robot.tip(state.c) - behind.project(outside)) < RESERVE + 1e-5


@pytest.mark.parametrize("target", [[np.nan, 0.0, 0.1], [0.0, 0.1]])
def test_what_is_no_place_is_left_to_the_controller(target: list[float]) -> None:
    scene = bent_tube()
    behind = ProjectedTarget(DampedLeastSquares(scene.robot, scene.zone))
    after, command = behind.step(behind.init(START), target)
    assert command.report.status is Status.HOLDING
    assert np.array_equal(after.c, START)
