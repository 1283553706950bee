"""What the pictures in space show: passage, guide and keep-outs apart, and the robot as it is."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from sinuous.arrays import Array
from sinuous.geometry import shapes
from sinuous.recording import Recording, ZonePart
from sinuous.view.scene import Scene
from sinuous.view.scene3d import keys
from sinuous.view.solids import block, body, cropped, wire

Simulate = Callable[..., Recording]
RED = (1.0, 0.0, 0.0)
RADIUS = 0.008
# Of a cross-section with 20 corners, whose sides cut through the circle.
POLYGON = 0.02
ROUNDING = 1e-12


def with_part(run: Recording, part: ZonePart, triangles: Array) -> Recording:
    """The same run with more triangles of that part."""
    header = run.header
    parts = np.concatenate([header.zone_parts, np.full(len(triangles), int(part))])
    zone = np.concatenate([header.zone_triangles, triangles])
    return replace(run, header=replace(header, zone_triangles=zone, zone_parts=parts))


def labels(scene: Scene) -> list[str]:
    return [str(key.get_label()) for key in keys(scene)]


def test_a_guide_is_cropped_and_does_not_widen_the_picture(run: Recording) -> None:
    plain = Scene.of(run)
    guide = shapes.tube([[0.0, 0.0, -0.3], [0.0, 0.0, 0.0]], 0.02, caps=False).triangles
    scene = Scene.of(with_part(run, ZonePart.GUIDE, guide))
    assert np.array_equal([scene.low, scene.high], [plain.low, plain.high])
    assert scene.guide
    corners = np.concatenate(scene.guide)
    assert np.all(corners >= scene.low - ROUNDING)
    assert np.all(corners <= scene.high + ROUNDING)
    assert np.array_equal(scene.walls, plain.walls)
    assert set(labels(scene)) - set(labels(plain)) == {"guide before the entrance"}


def test_keep_outs_are_solids_of_their_own(run: Recording) -> None:
    plain = Scene.of(run)
    post = shapes.box((0.01, 0.01, 0.01), centre=(0.03, 0.0, 0.03)).triangles
    scene = Scene.of(with_part(run, ZonePart.KEEP_OUT, post))
    assert len(plain.keep_outs.polygons) == 0
    assert np.all(scene.keep_outs.colors[:, 3] == 1.0)
    assert np.ptp(scene.keep_outs.polygons.reshape(-1, 3), axis=0) == pytest.approx([10.0] * 3)
    assert np.array_equal(scene.walls, plain.walls)
    assert set(labels(scene)) - set(labels(plain)) == {"keep-outs"}


def test_the_last_shape_is_the_robot_of_the_last_step(simulated: Simulate) -> None:
    run = simulated(seed=3, steps=40)
    scene = Scene.of(run)
    assert np.array_equal(scene.shapes[-1], run.actual_points[-1] * 1e3)
    assert np.array_equal(scene.shapes[0], run.actual_points[0] * 1e3)


def reach(polygons: Array) -> Array:
    """Distance of every corner from the z axis."""
    return np.hypot(polygons[..., 0], polygons[..., 1]).ravel()


def test_a_body_is_slim_between_its_disks_and_solid_outside_them() -> None:
    line = np.column_stack([np.zeros((41, 2)), np.linspace(0.0, 0.2, 41)])
    radii, disks = np.full(41, RADIUS), np.arange(16, 41, 4)
    robot = body(line, radii, disks, RED)
    assert reach(robot.polygons).max() == pytest.approx(RADIUS, rel=POLYGON)
    height = robot.polygons[..., 2].ravel()
    between = (height > 0.084) & (height < 0.096)
    assert reach(robot.polygons)[between].max() == pytest.approx(RADIUS / 2, rel=POLYGON)
    shaft = (height > 0.021) & (height < 0.029)
    assert reach(robot.polygons)[shaft].max() == pytest.approx(RADIUS, rel=POLYGON)
    # Outward normals: every side faces away from the middle of the body.
    sides = np.abs(robot.normals[:, 2]) < POLYGON
    outward = np.sum(robot.polygons.mean(axis=1)[sides, :2] * robot.normals[sides, :2], axis=1)
    assert np.all(outward > 0.0)


def test_rigid_modules_are_tubes_with_flat_ends_and_slim_between_them() -> None:
    """Two tubes along y of 40 mm, a gap of 20 mm around a joint; plates are no disks."""
    y = np.array([0.0, 10.0, 20.0, 30.0, 40.0, 50.0, 60.0, 70.0, 80.0, 90.0, 100.0])
    points = np.stack([0.0 * y, y, 0.0 * y], axis=1)
    plates, radius = np.array([[0, 4], [6, 10]]), 8.0
    solid = body(points, np.full(len(y), radius), plates.ravel(), RED, plates)
    corners = solid.polygons.reshape(-1, 3)
    thick = np.hypot(corners[:, 0], corners[:, 2]) > 0.9 * radius
    along = corners[thick][:, 1]
    assert np.all((along <= 40.0) | (along >= 60.0))
    assert (along.min(), along.max()) == (0.0, 100.0)
    between = np.abs(corners[:, 1] - 50.0) < 1.0
    assert np.max(np.hypot(*corners[between][:, [0, 2]].T)) == pytest.approx(0.5 * radius)


@pytest.mark.parametrize("points", [np.zeros((3, 3)), np.zeros((1, 3))])
def test_a_body_without_length_is_nothing(points: Array) -> None:
    assert len(wire(points, RADIUS, RED).polygons) == 0
    assert len(body(points, np.full(len(points), RADIUS), np.zeros(0, np.int64), RED).polygons) == 0


def test_points_that_coincide_leave_no_hole() -> None:
    line = np.column_stack([np.zeros((5, 2)), [0.0, 0.0, 0.01, 0.01, 0.02]])
    polygons = wire(line, RADIUS, RED).polygons
    assert np.all(np.isfinite(polygons))
    assert np.array_equal(np.unique(polygons[..., 2]), [0.0, 0.01, 0.02])


def test_splitting_keeps_the_area() -> None:
    triangles = shapes.box((0.1, 0.2, 0.3)).triangles
    small = block(triangles, 0.02, RED).polygons[:, :3]
    sides = np.linalg.norm(np.roll(small, -1, axis=1) - small, axis=2)
    assert sides.max() <= 0.02
    area = np.linalg.norm(np.cross(small[:, 1] - small[:, 0], small[:, 2] - small[:, 0]), axis=1)
    assert area.sum() / 2.0 == pytest.approx(2.0 * (0.02 + 0.03 + 0.06), rel=ROUNDING)


def test_cropping_cuts_at_the_box() -> None:
    triangle = np.array([[[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]])
    (cut,) = cropped(triangle, np.array([0.0, 0.0, -1.0]), np.array([3.0, 2.0, 1.0]))
    expected = {(0.0, 0.0), (3.0, 0.0), (3.0, 1.0), (2.0, 2.0), (0.0, 2.0)}
    assert {(float(x), float(y)) for x, y, _ in cut} == expected
    assert cropped(triangle, np.full(3, 5.0), np.full(3, 6.0)) == []
