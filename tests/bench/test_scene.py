"""The stress scene is the one that was measured before."""

import numpy as np
import pytest

from sinuous.bench.ours import DisksOnly
from sinuous.bench.scene import BODY_RADIUS, MARGIN, OUTSIDE, STEPS, WINDOWS, stress_scene

FACETS = 1e-3  # how much closer than the circle the flat sides of the tube are [m]


def test_the_tube_has_350_vertices_and_696_triangles() -> None:
    (surface,) = stress_scene(30).zone.surfaces
    assert (len(surface.vertices), len(surface.faces)) == (350, 696)


@pytest.mark.parametrize("disks", [9, 30])
def test_the_robot_starts_well_inside_and_within_its_limits(disks: int) -> None:
    scene = stress_scene(disks)
    points = scene.robot.points(scene.start)[scene.robot.movable]
    assert scene.zone.clearance(points).min() > BODY_RADIUS + 3 * MARGIN
    assert scene.robot.bend_slack(scene.start).min() > 0.0
    assert len(scene.robot.disk_indices) == disks
    lengths, limits = scene.robot.lengths(scene.start), scene.robot.length_limits
    assert np.all((limits[:, 0] < lengths) & (lengths < limits[:, 1]))


def test_the_target_is_inside_but_for_two_windows() -> None:
    scene = stress_scene(30)
    assert len(scene.targets) == STEPS
    room = scene.zone.clearance(scene.targets)
    outside = np.zeros(STEPS, dtype=bool)
    for first, last, _, _ in WINDOWS:
        outside[first:last] = True
        jump = np.linalg.norm(np.diff(scene.targets, axis=0), axis=1)[[first - 1, last - 1]]
        assert jump.min() > 0.02
    assert np.all(np.abs(room[outside] + OUTSIDE) < 3 * FACETS)
    assert room[~outside].min() > BODY_RADIUS + MARGIN


def test_fewer_steps_are_the_first_ones() -> None:
    np.testing.assert_array_equal(stress_scene(9, 30).targets, stress_scene(9).targets[:30])


def test_guarding_disks_only_guards_nothing_else() -> None:
    scene = stress_scene(9)
    robot = DisksOnly.of(scene.robot)
    np.testing.assert_array_equal(robot.disk_indices, np.arange(1, 10))
    np.testing.assert_allclose(robot.required_distance(MARGIN), BODY_RADIUS + MARGIN, rtol=1e-12)
    disks = scene.robot.points(scene.start)[scene.robot.disk_indices]
    np.testing.assert_allclose(robot.points(scene.start)[1:], disks, atol=1e-12)
