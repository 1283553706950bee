"""`sinuous bench scaling`, and the robots and meshes that it is about."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

from sinuous.bench import scene
from sinuous.bench.variants import Variant, robot, scene_of, tube
from sinuous.control.mpc import Costs, ShapeConstrainedMPC
from sinuous.control.report import Status
from sinuous.geometry.safe_zone import SafeZone

EXACT = 1e-12  # rounding of lengths around 0.1 m and of factors around 1
AXES = ("disks", "points", "segments", "horizon", "mesh")
MEASURED = {"median_ms", "p99_ms", "max_ms", "violations", "failures", "points", "horizon"}


def test_every_axis_is_measured_and_drawn(bench: Callable[[str], dict[str, Any]]) -> None:
    found = bench("scaling")
    assert found["figures"] == sorted(f"scaling_{axis}.png" for axis in AXES)
    for axis in AXES:
        assert all(row.keys() >= MEASURED for row in found[axis])
        assert all(row["violations"] == row["failures"] == 0 for row in found[axis])
    assert [row["disks"] for row in found["disks"]] == [9, 30]
    assert [row["segments"] for row in found["segments"]] == [1, 3]
    assert [row["horizon"] for row in found["horizon"]] == [2, 5]
    assert found["loading"][0]["vertices"] == 350
    assert found["loading"][0].keys() >= {"load_s", "build_s", "grid_s", "peak_mb"}
    mesh = [row for row in found["mesh"] if row["horizon"] == 2]
    ratio = mesh[-1]["median_ms"] / mesh[0]["median_ms"]
    assert found["summary"]["median_ratio_n2"] == pytest.approx(ratio)


def test_thirty_disks_are_the_stress_scene() -> None:
    ours, theirs = scene_of(Variant(), scene.tube(), 10), scene.stress_scene(30, 10)
    assert np.array_equal(ours.start, theirs.start)
    assert np.array_equal(ours.targets, theirs.targets)
    assert ours.robot.segments == theirs.robot.segments
    assert np.array_equal(ours.robot.required_distance(0.0), theirs.robot.required_distance(0.0))


@pytest.mark.parametrize("segments", [1, 2, 3, 4, 5, 6])
def test_the_robot_stays_as_long_and_as_bendable(segments: int) -> None:
    body, whole = robot(Variant(segments=segments)), robot(Variant())
    for limit in range(2):
        length = sum(segment.length[limit] for segment in body.segments)
        assert length == pytest.approx(sum(s.length[limit] for s in whole.segments), abs=EXACT)
    curvature = [segment.largest_curvature for segment in body.segments]
    assert curvature == pytest.approx([whole.segments[0].largest_curvature] * segments, abs=EXACT)
    made = scene_of(Variant(segments=segments), scene.tube(), 1)
    assert np.all(made.robot.bend_slack(made.start) > 0.0)
    same = scene_of(Variant(), scene.tube(), 1)
    tips = made.robot.tip(made.start), same.robot.tip(same.start)
    np.testing.assert_allclose(*tips, rtol=0, atol=EXACT)


@pytest.mark.parametrize("disks", [9, 15, 30, 45, 60, 90])
def test_more_disks_bend_as_far(disks: int) -> None:
    made = scene_of(Variant(disks=disks), scene.tube(), 1)
    assert len(made.robot.disk_indices) >= disks
    assert np.all(made.robot.bend_slack(made.start) > 0.0)


@pytest.mark.parametrize("vertices", [350, 1_000, 3_000, 10_000])
def test_the_tube_has_as_many_vertices_as_asked(vertices: int) -> None:
    mesh = tube(vertices)
    assert vertices <= len(mesh.vertices) <= 1.02 * vertices
    along = np.linspace(0.03, 0.22, 20)
    # Chords of the coarsest one come closest to the axis.
    zone = SafeZone.from_mesh(mesh)
    clearance = zone.clearance(scene.axis(along)[0])
    flat = scene.RADIUS * np.cos(np.pi / scene.SECTIONS)
    assert np.all((clearance > 0.99 * flat) & (clearance <= scene.RADIUS))


def test_two_segments_on_the_whole_stress_scene_make_no_solve_fail() -> None:
    # A QP on its way made the undamped interior-point method go round in a circle.
    variant = Variant(segments=2)
    two = scene_of(variant, scene.tube(), 320)
    mpc = ShapeConstrainedMPC(
        two.robot, two.zone, margin=two.margin, dt=two.dt, horizon=2, costs=Costs.printed()
    )
    state = mpc.init(two.start)
    for target in two.targets:
        state, command = mpc.step(state, target)
        assert command.report.status is not Status.HOLDING
