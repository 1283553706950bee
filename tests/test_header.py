"""The header of a run tells walls, guides and keep-outs apart."""

import numpy as np
import pytest

import sinuous as sn
from sinuous.recording import Header, ZonePart
from sinuous.session.header import make_header

MARGIN, DT = 0.003, 0.1
GUIDE = 0.2  # [m]
EXACT = 1e-12  # [m] rounding of sums of coordinates


@pytest.fixture(scope="module")
def header() -> Header:
    """Of a straight tube along z that is entered at z = 0, with a box in it."""
    robot = sn.load_robot("hachen2025")
    tube = sn.shapes.tube([[0.0, 0.0, 0.0], [0.0, 0.0, 0.3]], 0.06)
    zone = sn.SafeZone.from_mesh(tube, name="tube", entrance=[0.0, 0.0, 0.0], approach=GUIDE)
    box = sn.shapes.box((0.01, 0.01, 0.01), centre=(0.0, 0.04, 0.2))
    zone = zone.minus(box, name="box")
    mpc = sn.ShapeConstrainedMPC(robot, zone, margin=MARGIN, dt=DT, horizon=2)
    return make_header(sn.Scenario(name="test", mpc=mpc, path=sn.waypoints([[0.0, 0.0, 0.2]])))


def heights(header: Header, part: ZonePart) -> list[float]:
    """Least and largest z [m] of the triangles of a part."""
    z = header.zone_triangles[header.zone_parts == part][..., 2]
    return [float(z.min()), float(z.max())]


def test_every_part_is_where_it_belongs(header: Header) -> None:
    assert heights(header, ZonePart.WALL) == pytest.approx([0.0, 0.3], abs=EXACT)
    assert heights(header, ZonePart.GUIDE) == pytest.approx([-GUIDE, 0.0], abs=EXACT)
    assert heights(header, ZonePart.KEEP_OUT) == pytest.approx([0.195, 0.205], abs=EXACT)


def test_open_ends_are_not_recorded(header: Header) -> None:
    assert len(header.zone_parts) == len(header.zone_triangles)
    across = header.zone_triangles[..., 2].max(axis=1) <= -GUIDE + EXACT
    assert not np.any(across)


def test_the_body_has_a_radius_everywhere(header: Header) -> None:
    robot = sn.load_robot("hachen2025")
    assert np.array_equal(header.radii, robot.radii)
    assert header.disk_indices.max() < len(header.radii)
