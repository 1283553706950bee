"""Meshes of 100,000 vertices load like small ones, and bad ones are told apart as quickly."""

from pathlib import Path

import numpy as np
import pytest
import trimesh

from sinuous.arrays import Array
from sinuous.errors import InputError
from sinuous.geometry import shapes
from sinuous.geometry.mesh import prepare
from sinuous.geometry.safe_zone import SafeZone

BEND, RADIUS = 0.08, 0.025  # of a tube [m]
STATIONS, SECTIONS = 500, 200
SAGITTA = 5e-6  # [m] by which chords this fine leave the torus, and what a file in mm rounds
TILT = 0.02  # [rad] of a triangle against the torus: half a section is pi / 200


@pytest.fixture(scope="module")
def path() -> Array:
    """The axis of the tube."""
    return shapes.arc_path(BEND, 2.0, stations=STATIONS)


def test_a_big_file_gives_the_clearance_of_the_torus(path: Array, tmp_path: Path) -> None:
    mesh = shapes.tube(path, RADIUS, sections=SECTIONS)
    assert len(mesh.vertices) > 100_000
    file = tmp_path / "tube.stl"
    mesh.copy().apply_scale(1e3).export(file)
    zone = SafeZone.load(file, unit="mm", entrance=[0.0, 0.0, 0.0])

    rng = np.random.default_rng(0)
    angle, turn = rng.uniform(0.5, 1.5, 1000), rng.uniform(0.0, 2.0 * np.pi, 1000)
    off = rng.uniform(0.2, 2.0, 1000) * RADIUS
    reach = BEND - off * np.cos(turn)
    points = np.stack(
        [BEND - reach * np.cos(angle), off * np.sin(turn), reach * np.sin(angle)], axis=1
    )
    found = zone.nearest(points)
    assert np.abs(found.clearance - (RADIUS - off)).max() < SAGITTA
    axis = BEND * np.stack([1.0 - np.cos(angle), np.zeros(1000), np.sin(angle)], axis=1)
    inward = (axis - points) / off[:, None]
    assert np.abs(found.gradient - inward).max() < TILT
    assert zone.is_open.sum() == SECTIONS  # the fan that closed the end


def test_an_entrance_that_is_as_near_to_every_triangle() -> None:
    ball = shapes.sphere(0.05, subdivisions=6)
    with pytest.raises(InputError, match="50 mm from the nearest planar facet"):
        SafeZone.from_mesh(ball, entrance=[0.0, 0.0, 0.0])


def test_an_obstacle_inside() -> None:
    path = shapes.arc_path(BEND, 2.0, stations=200)
    outer = shapes.tube(path, RADIUS, sections=60)
    inner = shapes.tube(path[20:-20], 0.4 * RADIUS, sections=60)
    _, report = prepare(*_joined(outer, inner), name="nested")
    assert "2 separate pieces, 1 of them inside another" in str(report)
    across = shapes.capsule((-0.05, 0.0, 0.05), (0.05, 0.0, 0.05), 0.01)
    with pytest.raises(InputError, match="pieces that cross each other"):
        prepare(*_joined(outer, across), name="crossing")


def _joined(*meshes: trimesh.Trimesh) -> tuple[Array, Array]:
    """Vertices and faces of several meshes as one."""
    joined = trimesh.util.concatenate(meshes)
    return np.asarray(joined.vertices), np.asarray(joined.faces)


@pytest.mark.parametrize("cap", [False, True])
def test_triangles_that_do_not_meet(path: Array, cap: bool) -> None:
    mesh = shapes.tube(path[::20], RADIUS, sections=SECTIONS)
    rng = np.random.default_rng(0)
    corners = np.asarray(mesh.triangles) + rng.uniform(-1e-3, 1e-3, (len(mesh.faces), 1, 3))
    faces = np.arange(3 * len(corners)).reshape(-1, 3)
    words = "separate pieces" if cap else "open ends"
    with pytest.raises(InputError, match=f"{len(corners)} {words}"):
        prepare(corners.reshape(-1, 3), faces, name="soup", cap=cap)
