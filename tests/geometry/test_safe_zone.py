"""Keep-outs, entrances, and what a zone says about its triangles."""

import igl
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st

from sinuous.errors import InputError
from sinuous.geometry import shapes
from sinuous.geometry.safe_zone import SafeZone

from .scenes import bumpy, distance_by_trimesh, l_shape, points_around, stress_tube

DISTANCE = 1e-9  # [m] as in test_distance
ROUNDING = 1e-14  # [m] as in test_distance
ON_SURFACE = 1e-12  # [m] as in test_distance
APPROACH = 0.1  # [m] the guides below


def upright() -> trimesh.Trimesh:
    """A straight tube of radius 20 mm from z = 0 to z = 0.15 m."""
    return shapes.tube(np.linspace([0, 0, 0], [0, 0, 0.15], 16), 0.02, sections=32)


def test_a_keep_out_is_the_minimum_of_signed_distances() -> None:
    points = points_around(stress_tube(), np.random.default_rng(0))
    ball = shapes.sphere(0.01, centre=(0.0, 0.0, 0.01), subdivisions=2)
    spike = shapes.spike((0.03, 0.0, 0.05), (0.01, 0.0, 0.05), 0.004)
    wall = SafeZone.from_mesh(stress_tube())
    zone = wall.minus(ball, name="ball").minus(spike, name="spike")
    parts = [SafeZone.from_mesh(m) for m in (stress_tube(), ball, spike)]
    signs = (1.0, -1.0, -1.0)
    distances = np.stack([s * p.clearance(points) for s, p in zip(signs, parts, strict=True)])
    found = zone.nearest(points)
    assert np.array_equal(found.clearance, distances.min(axis=0))
    gradients = np.stack([s * p.gradient(points) for s, p in zip(signs, parts, strict=True)])
    chosen = np.take_along_axis(gradients, distances.argmin(axis=0)[None, :, None], 0)[0]
    assert np.allclose(found.gradient, chosen, atol=1e-15)
    first = np.cumsum([0, *(len(p.triangles) for p in parts)])
    owner = np.searchsorted(first, found.triangle, side="right") - 1
    assert np.array_equal(owner, distances.argmin(axis=0))


def test_order_of_keep_outs_does_not_matter() -> None:
    points = points_around(stress_tube(), np.random.default_rng(1), count=2000)
    ball, box = shapes.sphere(0.01), shapes.box((0.01, 0.02, 0.03), centre=(0.02, 0.0, 0.05))
    wall = SafeZone.from_mesh(stress_tube())
    one = wall.minus(ball, name="a").minus(box, name="b")
    other = wall.minus(box, name="b").minus(ball, name="a")
    assert np.array_equal(one.clearance(points), other.clearance(points))


def test_keep_outs_in_unbounded_space() -> None:
    zone = SafeZone.unbounded().minus(shapes.box((0.02, 0.02, 0.02)), name="block")
    found = zone.nearest([[0.03, 0.0, 0.0], [0.004, 0.0, 0.0]])
    assert np.allclose(found.clearance, [0.02, -0.006], atol=ROUNDING)
    assert np.allclose(found.gradient, [[1, 0, 0], [1, 0, 0]], atol=ROUNDING)
    assert np.allclose(found.foot, [[0.01, 0, 0], [0.01, 0, 0]], atol=ROUNDING)


def test_a_keep_out_may_be_small_but_must_be_closed() -> None:
    zone = SafeZone.from_mesh(upright())
    tiny = shapes.sphere(5e-4, centre=(0.0, 0.0, 0.05))
    assert zone.minus(tiny, name="wire").clearance([0, 0, 0.051]) == pytest.approx(5e-4)
    half = trimesh.Trimesh(tiny.vertices, tiny.faces[5:], process=False)
    with pytest.raises(InputError, match="half: expected a closed mesh"):
        zone.minus(half, name="half")


def test_triangles_are_described() -> None:
    ball = shapes.sphere(0.005, centre=(0.0, 0.0, 0.05), subdivisions=1)
    tube = upright()
    zone = SafeZone.from_mesh(tube, name="tube.stl", entrance=(0, 0, 0)).minus(ball, name="ball")
    guide, total = len(tube.faces), len(zone.triangles)
    assert zone.describe_triangle(5) == "triangle 5 of tube.stl"
    assert (
        zone.describe_triangle(guide + 3) == "triangle 3 of the guide before the entrance of "
        "tube.stl"
    )
    assert zone.describe_triangle(total - 80) == "triangle 0 of keep-out ball"
    for outside in (-1, total):
        with pytest.raises(IndexError):
            zone.describe_triangle(outside)
    assert np.count_nonzero(zone.is_guide) == 2 * 32
    assert np.count_nonzero(zone.is_open) == 32
    assert np.count_nonzero(zone.is_keep_out) == 80
    assert len(zone.is_guide) == len(zone.is_open) == len(zone.is_keep_out) == total
    assert len(SafeZone.unbounded().triangles) == len(SafeZone.unbounded().is_open) == 0


def test_an_entrance_continues_the_tube() -> None:
    """A straight tube with a guide is a longer tube without its first lid."""
    zone = SafeZone.from_mesh(upright(), entrance=(0.001, 0.002, 0.0), approach=APPROACH)
    assert np.allclose(zone.triangles[zone.is_open][..., 2], -APPROACH)
    path = np.linspace([0, 0, -1.0], [0, 0, 0.15], 116)
    longer = SafeZone.from_mesh(shapes.tube(path, 0.02, sections=32))
    rng = np.random.default_rng(0)
    points = rng.uniform([-0.05, -0.05, -APPROACH], [0.05, 0.05, 0.2], (5000, 3))
    # Outside, beside the far end, the longer tube goes on where the guide has ended.
    assert np.abs(zone.clearance(points) - longer.clearance(points)).max() <= DISTANCE


@pytest.mark.parametrize("where", ["start", "end", "both"])
@pytest.mark.parametrize("make", [stress_tube, bumpy, l_shape])
def test_an_entrance_keeps_the_closed_surface_in_the_sign(make: object, where: str) -> None:
    mesh: trimesh.Trimesh = make() if callable(make) else l_shape()
    if make is l_shape:
        points = np.array([[0.132, 0.03, 0.03], [0.03, 0.198, 0.03]])
    else:
        count = len(mesh.vertices)
        points = np.asarray(mesh.vertices[count - 2 :])
    entrance = {"start": points[0], "end": points[1], "both": points}[where]
    zone = SafeZone.from_mesh(mesh, entrance=entrance, approach=APPROACH)
    around = trimesh.Trimesh(*_welded(zone), process=False)
    assert around.is_watertight
    assert around.is_winding_consistent
    samples = points_around(around, np.random.default_rng(2))
    clearance = zone.clearance(samples)
    winding = igl.winding_number(
        np.asarray(around.vertices), np.asarray(around.faces, dtype=np.int64), samples
    )
    lids = trimesh.Trimesh(zone.triangles[zone.is_open].reshape(-1, 3), _soup(zone.is_open))
    clear = (np.abs(clearance) > ON_SURFACE) & (distance_by_trimesh(lids, samples) > ON_SURFACE)
    assert np.count_nonzero(clear) > 0.9 * len(samples)
    assert np.array_equal(clearance[clear] > 0.0, winding[clear] > 0.5)
    walls = trimesh.Trimesh(zone.triangles[~zone.is_open].reshape(-1, 3), _soup(~zone.is_open))
    distance = distance_by_trimesh(walls, samples)
    assert np.abs(np.abs(clearance) - distance).max() <= DISTANCE


def _soup(chosen: np.ndarray) -> np.ndarray:
    return np.arange(3 * np.count_nonzero(chosen)).reshape(-1, 3)


def _welded(zone: SafeZone) -> tuple[np.ndarray, np.ndarray]:
    surface = zone.surfaces[0]
    used, faces = np.unique(surface.faces, return_inverse=True)
    return surface.vertices[used], faces.reshape(-1, 3)


def test_beyond_the_far_end_is_outside() -> None:
    zone = SafeZone.from_mesh(upright(), entrance=(0, 0, 0), approach=APPROACH)
    apothem = 0.02 * np.cos(np.pi / 32)
    before, after = zone.clearance([[0, 0, 1e-6 - APPROACH], [0, 0, -1e-6 - APPROACH]])
    assert before == pytest.approx(apothem)
    assert after == pytest.approx(-apothem)
    far = zone.clearance([0.0, 0.0, -0.05 - APPROACH])
    assert far == pytest.approx(-np.hypot(apothem, 0.05))


def test_an_entrance_in_a_cap() -> None:
    tube = stress_tube(caps=False)
    zone = SafeZone.from_mesh(tube, cap=True, entrance=(0, 0, 0), approach=APPROACH)
    apothem = 0.025 * np.cos(np.pi / 12)
    path = shapes.arc_path(0.08, 2.0, stations=29)
    back = (path[0] - path[1]) / np.linalg.norm(path[0] - path[1])
    assert zone.clearance(0.05 * back) == pytest.approx(apothem)
    assert np.count_nonzero(zone.is_open) == 10
    end = stress_tube().vertices[-1]
    along = np.array([np.cos(np.pi / 2 - 2.0), 0.0, np.cos(2.0)])
    assert zone.clearance(end - 0.001 * along) == pytest.approx(0.001, rel=0.1)


def test_a_point_on_the_rim_means_the_larger_facet() -> None:
    zone = SafeZone.from_mesh(upright(), entrance=upright().vertices[0], approach=APPROACH)
    assert zone.clearance([0, 0, -0.05]) > 0.0


BAD_ENTRANCES = {
    "far away": ((0.0, 0.0, -0.05), 0.1, "entrance"),
    "in millimetres": ((0.0, 0.0, 150.0), 0.1, "entrance"),
    "not finite": ((0.0, np.nan, 0.0), 0.1, "entrance"),
    "not three": ((0.0, 0.0), 0.1, "entrance"),
    "the same twice": (((0.0, 0.0, 0.0), (0.001, 0.0, 0.0)), 0.1, "entrance"),
    "no length": ((0.0, 0.0, 0.0), 0.0, "approach"),
    "endless": ((0.0, 0.0, 0.0), np.inf, "approach"),
}


@pytest.mark.parametrize("case", sorted(BAD_ENTRANCES))
def test_bad_entrances_are_refused(case: str) -> None:
    entrance, approach, field = BAD_ENTRANCES[case]
    with pytest.raises(InputError) as caught:
        SafeZone.from_mesh(upright(), entrance=entrance, approach=approach)
    assert caught.value.field == field


def test_a_guide_that_runs_into_the_mesh_is_refused() -> None:
    """A spiral: straight on from its inner end lies its outer turn."""
    angle = np.linspace(0.0, 3.0 * np.pi, 90)
    reach = np.linspace(0.16, 0.06, 90)
    path = np.stack([reach * np.cos(angle), reach * np.sin(angle), 0.0 * angle], axis=1)
    loop = shapes.tube(path, 0.015)
    with pytest.raises(InputError, match="runs into the mesh") as caught:
        SafeZone.from_mesh(loop, entrance=loop.vertices[-1], approach=0.3)
    room = float(caught.value.remedy.rstrip(".").split()[-1])
    SafeZone.from_mesh(loop, entrance=loop.vertices[-1], approach=room)


@given(
    shift=st.floats(-0.01, 0.01),
    angle=st.floats(0.0, 6.2),
    depth=st.floats(-APPROACH + 1e-6, 0.13),
)
def test_along_a_straight_passage_nothing_changes(shift: float, angle: float, depth: float) -> None:
    x, y = shift * np.cos(angle), shift * np.sin(angle)
    here, start = STRAIGHT.clearance([[x, y, depth], [x, y, 0.0]])
    lid = 0.15 - depth
    assert here == pytest.approx(min(float(start), lid), abs=ROUNDING)


STRAIGHT = SafeZone.from_mesh(upright(), entrance=(0, 0, 0), approach=APPROACH)
