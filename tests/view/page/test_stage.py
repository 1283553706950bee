"""The scene of a page: frames, cables through holes, disks, and what is sent."""

from collections.abc import Generator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import viser
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.robots.cables import cable_rows
from sinuous.robots.robot import Robot
from sinuous.scenario import Scenario, load_scenario
from sinuous.session.header import make_header
from sinuous.view.page.cables import Cables
from sinuous.view.page.frames import Frames, towards
from sinuous.view.page.moment import Moment
from sinuous.view.page.scale import PER_METRE
from sinuous.view.page.solid import Cylinders, cylinder
from sinuous.view.page.stage import Stage
from sinuous.view.page.thinned import thinned

EXACT = 1e-12
CHORD = 1e-4  # [m] what straight stretches between 30 disks are shorter than arcs, at 0.3 rad
BETWEEN = 3e-3  # directions at the border of two arcs are between theirs
SCENARIOS = Path(__file__).parents[3] / "examples" / "scenarios"
JOINTED, ROD = (load_scenario(SCENARIOS / f"{n}.toml") for n in ("live_jointed", "live_watchdog"))
BENDS = st.lists(st.floats(-0.4, 0.4), min_size=16, max_size=16)


def bent(robot: Robot, bends: list[float]) -> Array:
    """The home configuration, bent; lengths stay."""
    c = robot.home.copy()
    angles = [i for i in range(len(c)) if abs(c[i]) < EXACT]
    c[angles] += np.resize(bends, len(angles))
    return c


def lengths(robot: Robot, c: Array) -> Array:
    cables, points = Cables.of(robot), robot.points(c)
    ends = cables.stretches(points, cables.frames.directions(points))
    total = np.zeros(len(cable_rows(robot)))
    np.add.at(total, cables.cable, np.linalg.norm(ends[:, 1] - ends[:, 0], axis=1))
    return total


@given(bends=BENDS)
@settings(max_examples=30, deadline=None)
@pytest.mark.parametrize("scenario", [JOINTED, ROD], ids=["jointed", "rod"])
def test_frames_are_carried_to_the_tip(scenario: Scenario, bends: list[float]) -> None:
    robot = scenario.robot
    c = bent(robot, bends)
    frames, points = Frames.of(robot), robot.points(c)
    R = frames.at(frames.directions(points), np.arange(len(points)))
    assert np.allclose(R @ R.transpose(0, 2, 1), np.eye(3), atol=1e-10)
    assert np.all(np.linalg.det(R) > 0.0)
    assert np.allclose(R[-1], robot.tip_pose(c)[:3, :3], atol=BETWEEN)


@given(bends=BENDS)
@settings(max_examples=30, deadline=None)
def test_cables_of_joints_have_the_robots_lengths(bends: list[float]) -> None:
    robot = JOINTED.robot
    c = bent(robot, bends)
    assert np.allclose(lengths(robot, c), robot.lengths(c)[cable_rows(robot)], atol=1e-10)


@given(bends=BENDS)
@settings(max_examples=30, deadline=None)
def test_cables_of_arcs_have_the_lengths_of_all_segments_they_pass(bends: list[float]) -> None:
    robot = ROD.robot
    c = bent(robot, bends)
    own = robot.lengths(c)[cable_rows(robot)].reshape(3, 3)  # counted inside each segment alone
    total = lengths(robot, c).reshape(3, 3)
    assert np.allclose(np.sort(total[0]), np.sort(own[0]), atol=CHORD)
    # Three holes around the backbone: the mean of a segment's cables is its backbone.
    assert np.allclose(total.mean(axis=1), np.cumsum(own.mean(axis=1)), atol=3.0 * CHORD)


@pytest.mark.parametrize("scenario", [JOINTED, ROD], ids=["jointed", "rod"])
def test_disks_are_where_the_robot_has_them_and_across_the_body(scenario: Scenario) -> None:
    robot = scenario.robot
    points = robot.points(bent(robot, [0.2, -0.1, 0.15]))
    along = Frames.of(robot).directions(points)
    parts = Cylinders.of(make_header(scenario), points)
    placed = parts.placed(points, along)
    disks = robot.disk_indices
    assert np.allclose(placed.centres[-len(disks) :], points[disks], atol=EXACT)
    w, x, y, z = placed.turns[-len(disks) :].T
    axis = np.stack([2 * (x * z + w * y), 2 * (y * z - w * x), 1 - 2 * (x * x + y * y)], axis=1)
    assert np.allclose(axis, along[disks], atol=1e-9)


def test_turning_round_is_a_rotation_too() -> None:
    q = towards(np.array([[0.0, 0.0, -1.0], [0.0, 0.0, 1.0]]))
    assert np.allclose(np.linalg.norm(q, axis=1), 1.0)
    assert np.allclose(q[1], (1.0, 0.0, 0.0, 0.0))
    assert abs(q[0, 0]) < EXACT
    assert abs(q[0, 3]) < EXACT  # half a turn about an axis across z


def test_the_cylinder_is_closed_and_wound_outward() -> None:
    vertices, faces = cylinder()
    a, b, c = np.swapaxes(vertices[faces], 0, 1)
    volume = float(np.sum(np.cross(a, b) * c)) / 6.0
    sides = len(vertices) // 4
    assert volume == pytest.approx(0.5 * sides * np.sin(2.0 * np.pi / sides))


def test_a_large_mesh_is_thinned_and_stays_where_it_is() -> None:
    n = 330
    x, y = np.meshgrid(np.arange(n) / n, np.arange(n) / n)
    p = np.stack([x, y, 0.0 * x], axis=-1)
    low = np.stack([p[:-1, :-1], p[:-1, 1:], p[1:, 1:]], axis=2).reshape(-1, 3, 3)
    high = np.stack([p[:-1, :-1], p[1:, 1:], p[1:, :-1]], axis=2).reshape(-1, 3, 3)
    triangles = np.concatenate([low, high])
    vertices, faces = thinned(triangles)
    assert len(triangles) > 200_000
    assert 10_000 < len(faces) <= 40_000
    corners = vertices[faces]
    area = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert 0.5 * float(area.sum()) == pytest.approx(1.0, abs=0.05)  # the rim draws in by a cell


@pytest.fixture
def server() -> Generator[viser.ViserServer]:
    """A server that nobody looks at."""
    server = viser.ViserServer(host="127.0.0.1", port=8710, verbose=False)
    yield server
    server.stop()


def moment(scenario: Scenario, **changed: Any) -> Moment:
    points = scenario.robot.points(scenario.first_configuration)
    fields: dict[str, Any] = {
        "target": points[-1], "nominal": points, "actual": points, "tensions": np.zeros(0),
        "nearest": 3, "wall": points[3] + 0.01, "clearance": 0.01, "tip_force": np.zeros(3),
        "pushed": 0, "body_force": np.zeros(3),
    }  # fmt: skip
    return Moment(**(fields | changed))


def test_what_is_shown_is_what_was_asked(server: viser.ViserServer) -> None:
    stage = Stage(server.scene, make_header(ROD), ROD.robot)
    nodes = server.scene._handle_from_node_name  # pyright: ignore[reportPrivateUsage]
    stage.show(moment(ROD))
    target: Any = nodes["/stage/target"]
    tip = ROD.robot.points(ROD.first_configuration)[-1]
    assert np.allclose(target.position, PER_METRE * tip)
    assert not nodes["/stage/tip_force"].visible
    assert not nodes["/stage/nominal"].visible  # it is the actual shape
    force = np.array([1.0, 0.0, 0.0])
    nominal = moment(ROD).nominal + 0.002
    stage.show(moment(ROD, tip_force=force, nominal=nominal))
    arrow: Any = nodes["/stage/tip_force"]
    reach = arrow.points[0, 1] - arrow.points[0, 0]
    assert arrow.visible
    assert np.allclose(reach, PER_METRE * stage.metres_per_newton * force, atol=1e-6)
    assert nodes["/stage/nominal"].visible
    stage.show(moment(ROD, clearance=np.inf, wall=np.full(3, np.nan)))
    assert not nodes["/stage/thread"].visible
    stage.remove()
    assert not [name for name in nodes if name.startswith("/stage/")]
