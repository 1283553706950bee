"""Makers of meshes: closed, wound outward, of the right size."""

from collections.abc import Callable

import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from sinuous.geometry import shapes
from sinuous.geometry.mesh import prepare

from .scenes import SCENES, l_shape, stress_tube

ROUNDING = 1e-12  # relative, of a volume summed over thousands of triangles

MAKERS: dict[str, tuple[Callable[[], trimesh.Trimesh], float, float]] = {
    # with the exact volume of the round shape and the share that facets may cut off
    "box": (lambda: shapes.box((0.1, 0.2, 0.3), centre=(1, 2, 3)), 0.006, ROUNDING),
    "sphere": (lambda: shapes.sphere(0.1, centre=(1, 0, 0)), 4e-3 / 3 * np.pi, 0.02),
    "capsule": (
        lambda: shapes.capsule((0, 0, 0), (0, 0.3, 0.4), 0.1, sections=48),
        (4e-3 / 3 + 5e-3) * np.pi,
        0.02,
    ),
    "ball": (
        lambda: shapes.capsule((1, 1, 1), (1, 1, 1), 0.1, sections=48),
        4e-3 / 3 * np.pi,
        0.02,
    ),
    "spike": (lambda: shapes.spike((0, 0, 0), (0.3, 0, 0), 0.1, sections=48), 1e-3 * np.pi, 0.02),
    "tube": (
        lambda: shapes.tube(shapes.arc_path(0.3, 1.5), 0.1, sections=48),
        0.01 * np.pi * 0.45,
        0.02,
    ),
}


@pytest.mark.parametrize("name", sorted(MAKERS))
def test_volume(name: str) -> None:
    make, volume, share = MAKERS[name]
    assert volume * (1.0 - share) <= make().volume <= volume * (1.0 + ROUNDING)


@pytest.mark.parametrize(
    "make", [*(m for m, _, _ in MAKERS.values()), *SCENES.values()], ids=[*MAKERS, *SCENES]
)
def test_closed_and_outward(make: Callable[[], trimesh.Trimesh]) -> None:
    mesh = make()
    assert mesh.is_watertight
    assert mesh.is_winding_consistent
    assert mesh.volume > 0.0
    _, report = prepare(mesh.vertices, mesh.faces, name="mesh")
    assert report.findings == ()


def test_the_stress_scene() -> None:
    tube = stress_tube()
    assert (len(tube.vertices), len(tube.faces)) == (350, 696)
    assert len(l_shape().faces) == 20


def test_open_tubes_have_two_ends() -> None:
    tube = shapes.tube(shapes.arc_path(0.08, 1.0), 0.02, caps=False)
    assert len(tube.outline().entities) == 2


def test_a_tube_may_be_narrow_in_places() -> None:
    path = np.linspace([0, 0, 0], [0, 0, 0.1], 11)
    radius = np.full(11, 0.02)
    radius[5] = 0.008
    tube = shapes.tube(path, radius)
    around = np.linalg.norm(tube.vertices[:, :2], axis=1)
    assert np.allclose(around[:-2].reshape(11, -1), radius[:, None])


@given(bend=st.floats(0.03, 0.3), radius=st.floats(0.005, 0.1))
def test_a_tube_that_cuts_itself_is_refused(bend: float, radius: float) -> None:
    path = shapes.arc_path(bend, 1.5, stations=60)
    # The polygon of the path bends a little around the arc, hence the gap between the two cases.
    if radius < 0.99 * bend:
        assert shapes.tube(path, radius, sections=64).volume > 0.0
    elif radius > 1.01 * bend:
        with pytest.raises(ValueError, match="cuts itself"):
            shapes.tube(path, radius, sections=64)


def test_frames_do_not_twist() -> None:
    """Round a planar arc, the side across its plane stays put, and the frame is orthonormal."""
    path = shapes.wandering_path(np.random.default_rng(0), bend=10.0)
    tangent, side = shapes.path_frames(path)
    assert np.allclose(np.sum(tangent * side, axis=1), 0.0, atol=1e-12)
    assert np.allclose(np.linalg.norm(side, axis=1), 1.0)
    tangent, side = shapes.path_frames(shapes.arc_path(0.1, 2.0))
    assert np.allclose(np.cross(tangent, side) @ [0, 1, 0], np.cross(tangent, side)[0, 1])


def test_random_shapes_follow_their_generator() -> None:
    one, other, third = (shapes.bumpy_tube(np.random.default_rng(s)) for s in (1, 1, 2))
    assert np.array_equal(one.vertices, other.vertices)
    assert not np.array_equal(one.vertices, third.vertices)


@pytest.mark.parametrize("seed", range(10))
def test_bumpy_tubes_stay_within_their_bounds(seed: int) -> None:
    rng = np.random.default_rng(seed)
    path = shapes.wandering_path(rng, length=0.25, bend=9.0)
    steps = np.linalg.norm(np.diff(path, axis=0), axis=1)
    assert steps.sum() == pytest.approx(0.25, rel=0.01)
    assert np.array_equal(path[0], np.zeros(3))
    turn = np.diff(np.diff(path, axis=0) / steps[:, None], axis=0)
    assert np.linalg.norm(turn, axis=1).max() <= 9.0 * steps.max() * 1.01
    tube = shapes.bumpy_tube(rng, path=path, radius=0.02, roughness=0.2)
    assert tube.is_watertight
    rings = tube.vertices[:-2].reshape(len(path), -1, 3)
    wall = np.linalg.norm(rings - path[:, None], axis=2)
    assert np.all((wall >= 0.016 - 1e-12) & (wall <= 0.024 + 1e-12))


BAD: dict[str, Callable[[], object]] = {
    "one station": lambda: shapes.tube([[0, 0, 0]], 0.1),
    "repeated station": lambda: shapes.tube([[0, 0, 0], [0, 0, 0]], 0.1),
    "turns back": lambda: shapes.tube([[0, 0, 0], [0, 0, 1], [0, 0, 0]], 0.1),
    "not finite": lambda: shapes.tube([[0, 0, 0], [0, 0, np.nan]], 0.1),
    "no radius": lambda: shapes.tube([[0, 0, 0], [0, 0, 1]], 0.0),
    "two sections": lambda: shapes.tube([[0, 0, 0], [0, 0, 1]], 0.1, sections=2),
    "flat box": lambda: shapes.box((1, 0, 1)),
    "flat sphere": lambda: shapes.sphere(-1.0),
    "thin capsule": lambda: shapes.capsule((0, 0, 0), (0, 0, 1), 0.0),
    "flat spike": lambda: shapes.spike((0, 0, 0), (0, 0, 0), 0.1),
    "too rough": lambda: shapes.bumpy_tube(np.random.default_rng(0), roughness=1.0),
}


@pytest.mark.parametrize("case", sorted(BAD))
def test_impossible_shapes_are_refused(case: str) -> None:
    with pytest.raises(ValueError, match=r"\w"):
        BAD[case]()
