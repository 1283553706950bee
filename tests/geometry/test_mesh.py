"""Loading, checking and repairing meshes."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
import trimesh

from sinuous.arrays import Array, IntArray
from sinuous.errors import InputError
from sinuous.geometry import shapes
from sinuous.geometry.mesh import check_mesh, load_surface, prepare
from sinuous.geometry.report import Severity
from sinuous.geometry.safe_zone import SafeZone
from sinuous.geometry.surface import Part

from .scenes import bumpy, points_around, stress_tube

SINGLE = 2.0**-23  # relative step of the single-precision numbers in STL and PLY files
DECIMALS = 1e-8  # relative step of the decimals that trimesh writes to OBJ and ASCII STL files


def joined(*meshes: trimesh.Trimesh) -> trimesh.Trimesh:
    starts = np.cumsum([0, *(len(m.vertices) for m in meshes)])
    return trimesh.Trimesh(
        np.concatenate([m.vertices for m in meshes]),
        np.concatenate([m.faces + k for m, k in zip(meshes, starts, strict=False)]),
        process=False,
    )


def cube(size: float = 0.1, at: float = 0.0) -> trimesh.Trimesh:
    return shapes.box((size, size, size), centre=(at, 0.0, 0.0))


def with_faces(mesh: trimesh.Trimesh, faces: IntArray) -> trimesh.Trimesh:
    return trimesh.Trimesh(mesh.vertices, faces, process=False)


def with_nan() -> trimesh.Trimesh:
    mesh = cube()
    mesh.vertices[3] = np.nan
    return mesh


def fins() -> trimesh.Trimesh:
    mesh = cube()
    vertices = np.concatenate([mesh.vertices, [[0.0, 0.0, 0.2]]])
    a, b = mesh.faces[0][:2]
    return trimesh.Trimesh(vertices, np.concatenate([mesh.faces, [[a, b, 8]]]), process=False)


def moebius() -> trimesh.Trimesh:
    around, n = 2.0 * np.pi * np.arange(12) / 12, 12
    arm = np.stack([np.cos(around), np.sin(around), 0.0 * around], 1)
    tilt = np.cos(around / 2.0)[:, None] * arm + np.sin(around / 2.0)[:, None] * [0.0, 0.0, 1.0]
    vertices = np.concatenate([0.1 * arm - 0.03 * tilt, 0.1 * arm + 0.03 * tilt])
    i, j = np.arange(n), (np.arange(n) + 1) % n
    low_j = np.where(j == 0, n, j)
    high_j = np.where(j == 0, 0, j + n)
    faces = np.concatenate([np.stack([i, low_j, high_j], 1), np.stack([i, high_j, i + n], 1)])
    return trimesh.Trimesh(vertices, faces, process=False)


def crack() -> trimesh.Trimesh:
    """A flat triangle that closes a T-junction: it cannot go without opening the mesh."""
    mesh = cube()
    a, b, c = mesh.faces[0]
    middle = (mesh.vertices[a] + mesh.vertices[b]) / 2.0
    faces = np.concatenate([mesh.faces[1:], [[a, 8, c], [8, b, c], [a, b, 8]]])
    return trimesh.Trimesh(np.concatenate([mesh.vertices, [middle]]), faces, process=False)


FATAL: dict[str, tuple[Callable[[], trimesh.Trimesh], str]] = {
    "nothing": (lambda: trimesh.Trimesh(np.zeros((0, 3)), np.zeros((0, 3), int)), "no triangles"),
    "nan": (with_nan, "1 vertices that are not finite"),
    "open": (lambda: stress_tube(caps=False), "2 open ends, "),
    "hole": (lambda: with_faces(cube(), cube().faces[1:]), "one open end, "),
    "fin": (fins, "not a manifold: 1 edges"),
    "moebius": (moebius, "single side"),
    "crack": (crack, "1 triangles without area"),
    "crossing": (lambda: joined(cube(), cube(at=0.05)), "pieces that cross"),
    "debris": (lambda: joined(*(cube(0.01, 0.02 * k) for k in range(65))), "65 separate pieces"),
    "small": (lambda: cube(1e-4), "implausible size, 0.0001 m"),
    "large": (lambda: cube(100.0), "implausible size, 100 m"),
}


@pytest.mark.parametrize("case", sorted(FATAL))
def test_unusable_meshes_are_refused(case: str) -> None:
    make, message = FATAL[case]
    with pytest.raises(InputError) as caught:
        SafeZone.from_mesh(make(), name="my mesh")
    assert message in caught.value.found
    assert str(caught.value).startswith("my mesh: expected ")
    assert caught.value.remedy.endswith(".")


def test_faces_of_missing_vertices_are_refused() -> None:
    with pytest.raises(InputError, match="does not exist"):
        prepare(cube().vertices, [[0, 1, 9]], name="mesh")


def test_an_open_mesh_says_where_and_offers_caps() -> None:
    with pytest.raises(InputError) as caught:
        SafeZone.from_mesh(stress_tube(caps=False))
    assert "2 open ends, 50, 50 mm across" in caught.value.found
    assert "(0, 0, 0) m" in caught.value.found
    assert "cap = true" in caught.value.remedy


def test_an_open_keep_out_is_to_be_closed_elsewhere() -> None:
    zone = SafeZone.from_mesh(stress_tube())
    with pytest.raises(InputError, match="one open end") as caught:
        zone.minus(with_faces(cube(), cube().faces[1:]), name="post")
    assert "mesh editor" in caught.value.remedy
    assert "cap =" not in caught.value.remedy


def test_a_keep_out_may_be_small_but_not_huge() -> None:
    zone = SafeZone.from_mesh(stress_tube())
    zone.minus(cube(1e-4), name="speck")
    with pytest.raises(InputError, match=r"largest extent of at most 10 m"):
        zone.minus(cube(100.0), name="mountain")


def test_a_wrong_unit_is_suspected(tmp_path: Path) -> None:
    stress_tube().export(tmp_path / "tube.stl")
    with pytest.raises(InputError, match=r"unit is probably wrong: .* larger one"):
        SafeZone.load(tmp_path / "tube.stl", unit="mm")
    large = stress_tube()
    large.apply_scale(1e3)
    large.export(tmp_path / "large.stl")
    with pytest.raises(InputError, match=r"unit is probably wrong: .* smaller one"):
        SafeZone.load(tmp_path / "large.stl", unit="m")
    with pytest.raises(InputError, match="unit"):
        SafeZone.load(tmp_path / "large.stl", unit="inch")


def repeated() -> trimesh.Trimesh:
    return with_faces(cube(), np.concatenate([cube().faces, cube().faces[[2, 5]][:, [1, 2, 0]]]))


def back_to_back() -> trimesh.Trimesh:
    return with_faces(cube(), np.concatenate([cube().faces, [[0, 1, 6], [0, 6, 1]]]))


def partly_flipped() -> trimesh.Trimesh:
    faces = cube().faces.copy()
    faces[[1, 4, 7]] = faces[[1, 4, 7]][:, ::-1]
    return with_faces(cube(), faces)


def hairline() -> trimesh.Trimesh:
    rng = np.random.default_rng(0)
    soup = cube().triangles.reshape(-1, 3) + rng.uniform(-1e-10, 1e-10, (36, 3))
    return trimesh.Trimesh(soup, np.arange(36).reshape(-1, 3), process=False)


def needle() -> trimesh.Trimesh:
    """Two flat triangles back on each other: dropping them leaves the mesh closed."""
    mesh = cube()
    return with_faces(mesh, np.concatenate([mesh.faces, [[0, 0, 1], [2, 2, 2]]]))


REPAIRABLE: dict[str, tuple[Callable[[], trimesh.Trimesh], str]] = {
    "inverted": (lambda: with_faces(cube(), cube().faces[:, ::-1]), "an inverted mesh"),
    "winding": (partly_flipped, "inconsistent winding: 3 triangles"),
    "duplicates": (repeated, "2 duplicate triangles"),
    "back to back": (back_to_back, "2 duplicate triangles"),
    "soup": (
        lambda: trimesh.Trimesh(
            cube().triangles.reshape(-1, 3), np.arange(36).reshape(-1, 3), process=False
        ),
        "",
    ),
    "hairline": (hairline, "cracks between 28 pairs"),
    "collapsed": (needle, ""),
}


@pytest.mark.parametrize("case", sorted(REPAIRABLE))
def test_repairs_restore_the_mesh(case: str) -> None:
    make, message = REPAIRABLE[case]
    broken = make()
    surface, report = prepare(broken.vertices, broken.faces, name="cube")
    repairs = [f.what for f in report.findings if f.severity is Severity.REPAIRED]
    assert [message in r for r in repairs] == ([True] if message else [])
    assert report.usable
    points = points_around(cube(), np.random.default_rng(0), count=1000)
    repaired = SafeZone(surfaces=(surface,)).clearance(points)
    assert np.abs(repaired - SafeZone.from_mesh(cube()).clearance(points)).max() <= 1e-9


def test_flat_triangles_are_dropped_where_the_mesh_stays_closed() -> None:
    """A sheet without thickness that hangs on no edge of the mesh."""
    mesh = cube()
    sheet = np.array([[0.2, 0.0, 0.0], [0.21, 0.0, 0.0], [0.22, 0.0, 0.0], [0.23, 0.0, 0.0]])
    flaps = np.array([[8, 9, 10], [8, 10, 11], [8, 11, 9], [9, 11, 10]])
    broken = np.concatenate([mesh.vertices, sheet])
    surface, report = prepare(broken, np.concatenate([mesh.faces, flaps]), name="cube")
    assert len(surface.faces) == 12
    assert "4 triangles without area" in report.findings[0].what


def test_inner_pieces_are_obstacles() -> None:
    for inner in (cube(0.02), with_faces(cube(0.02), cube().faces[:, ::-1])):
        mesh = joined(cube(), inner)
        _, report = prepare(mesh.vertices, mesh.faces, name="mesh")
        assert "2 separate pieces, 1 of them inside" in str(report)
        clearance = SafeZone.from_mesh(mesh).clearance([[0, 0, 0], [0, 0, 0.02], [0, 0, 0.06]])
        assert np.allclose(clearance, [-0.01, 0.01, -0.01])


def test_pieces_that_touch_in_a_vertex_keep_their_signs() -> None:
    mesh = joined(cube(), cube())
    mesh.vertices[8:] += 0.1
    points = points_around(cube(), np.random.default_rng(0), count=2000)
    one, other = (SafeZone.from_mesh(m).clearance(points) for m in (cube(), mesh.split()[1]))
    both = SafeZone.from_mesh(mesh).clearance(points)
    assert np.abs(both - np.maximum(one, other)).max() <= 1e-9


@pytest.mark.parametrize("unit", ["m", "cm", "mm"])
@pytest.mark.parametrize("name", ["a.stl", "b.obj", "c.ply", "d.STL", "ascii.stl", "ascii.ply"])
def test_files_round_trip(tmp_path: Path, name: str, unit: str) -> None:
    mesh, metres = bumpy(), {"m": 1.0, "cm": 1e-2, "mm": 1e-3}[unit]
    scaled = mesh.copy()
    scaled.apply_scale(1.0 / metres)
    kind = {"ascii.stl": {"file_type": "stl_ascii"}, "ascii.ply": {"encoding": "ascii"}}
    scaled.export(tmp_path / name, **kind.get(name, {}))
    report = check_mesh(tmp_path / name, unit=unit)
    assert report.usable
    assert report.findings == ()
    assert (report.triangles, report.vertices) == (len(mesh.faces), len(mesh.vertices))
    surface, _ = load_surface(tmp_path / name, unit=unit)
    size = np.abs(mesh.vertices).max()
    error = np.abs(surface.vertices[surface.faces] - mesh.triangles).max()
    assert error <= max(SINGLE * size, DECIMALS * metres)
    zone = SafeZone.load(tmp_path / name, unit=unit)
    assert zone.describe_triangle(7) == f"triangle 7 of {tmp_path / name}"


def test_caps_close_open_ends() -> None:
    tube = stress_tube(caps=False)
    surface, report = prepare(tube.vertices, tube.faces, name="tube", cap=True)
    assert np.count_nonzero(surface.part == Part.CAP) == 2 * (12 - 2)
    assert len(report.findings) == 2
    points = points_around(stress_tube(), np.random.default_rng(0))
    capped = SafeZone.from_mesh(tube, cap=True)
    closed = SafeZone.from_mesh(stress_tube())
    assert np.abs(capped.clearance(points) - closed.clearance(points)).max() <= 1e-9
    assert capped.describe_triangle(len(tube.faces)) == "triangle 0 of the caps of mesh"


def straight_box(outline: Array) -> trimesh.Trimesh:
    """An upright box, open on top, with the given outline (N, 2)."""
    n = len(outline)
    i, j = np.arange(n), (np.arange(n) + 1) % n
    low, high = (np.column_stack([outline, np.full(n, z)]) for z in (0.0, 0.1))
    foot = np.concatenate([low, [[0.0, 0.0, 0.0]]])
    faces = [[i, j, j + n + 1], [i, j + n + 1, i + n + 1], [j, i, np.full(n, n)]]
    stacked = np.concatenate([np.stack(f, 1) for f in faces])
    return trimesh.Trimesh(np.concatenate([foot, high]), stacked, process=False)


def test_caps_use_vertices_on_straight_edges() -> None:
    """A square outline with many vertices on its sides, which ear cutting likes to skip."""
    side = np.linspace(-0.05, 0.05, 6)[:-1]
    square = np.concatenate(
        [
            np.column_stack([side, 0.0 * side - 0.05]),
            np.column_stack([0.0 * side + 0.05, side]),
            np.column_stack([-side, 0.0 * side + 0.05]),
            np.column_stack([0.0 * side - 0.05, -side]),
        ]
    )
    clearance = SafeZone.from_mesh(straight_box(square), cap=True).clearance([0.0, 0.0, 0.08])
    assert clearance == pytest.approx(0.02, abs=1e-12)


def test_caps_of_star_shaped_ends_are_flat() -> None:
    angle = 2.0 * np.pi * np.arange(14) / 14
    reach = np.where(np.arange(14) % 2, 0.02, 0.06)
    star = np.column_stack([reach * np.cos(angle), reach * np.sin(angle)])
    clearance = SafeZone.from_mesh(straight_box(star), cap=True).clearance([0.0, 0.0, 0.095])
    assert clearance == pytest.approx(0.005, abs=1e-12)


def test_an_end_that_is_not_planar_is_refused() -> None:
    tube = stress_tube(caps=False)
    tube.vertices[0] += [0.0, 0.0, -0.004]
    with pytest.raises(InputError, match="mm from planar") as caught:
        SafeZone.from_mesh(tube, cap=True)
    assert float(caught.value.found.split(" mm")[0].split()[-1]) == pytest.approx(4.0, rel=0.3)
    with pytest.raises(InputError, match="caps are only made for planar ends"):
        SafeZone.from_mesh(tube)


def test_a_ring_shaped_end_is_refused() -> None:
    """A pipe with a wall: its ends are rings, which caps on both outlines would fill."""
    path = np.linspace([0, 0, 0], [0, 0, 0.1], 5)
    outer, inner = (shapes.tube(path, r, caps=False) for r in (0.03, 0.02))
    pipe = joined(outer, with_faces(inner, inner.faces[:, ::-1]))
    with pytest.raises(InputError, match="a ring-shaped open end"):
        SafeZone.from_mesh(pipe, cap=True)


def test_the_report_reads_well() -> None:
    tube = stress_tube(caps=False)
    _, report = prepare(tube.vertices, tube.faces[:, ::-1], name="tube.stl", cap=True)
    text = str(report)
    assert text.startswith("tube.stl: 692 triangles")
    assert "repaired: an open end 50 mm across at (0, 0, 0) m" in text
    assert "repaired: an inverted mesh" in text
    assert max(report.extents) == pytest.approx(float(tube.extents.max()))
