"""Whether a straight way is clear of all walls, against the distance sampled along it."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array, BoolArray
from sinuous.compiled import kernel
from sinuous.geometry import shapes
from sinuous.geometry.bvh import STACK, ZoneArrays
from sinuous.geometry.safe_zone import SafeZone
from sinuous.geometry.segment import is_clear

from .scenes import bumpy, l_shape

SAMPLES = 400  # along a way
ROUNDING = 1e-12  # [m]


@kernel
def judge(zone: ZoneArrays, a: Array, b: Array, distance: Array, out: BoolArray) -> None:
    stack = np.empty(STACK, np.int64)
    for k in range(a.shape[0]):
        out[k] = is_clear(
            zone, a[k, 0], a[k, 1], a[k, 2], b[k, 0], b[k, 1], b[k, 2], distance[k], stack
        )


def clear(zone: SafeZone, a: Array, b: Array, distance: Array) -> BoolArray:
    out = np.empty(len(a), dtype=np.bool_)
    judge(zone.arrays, a, b, distance, out)
    return out


ZONES = {
    "bumpy": SafeZone.from_mesh(bumpy()),
    "edges": SafeZone.from_mesh(l_shape()),
    "obstacle": SafeZone.from_mesh(l_shape()).minus(
        shapes.sphere(0.004, centre=(0.02, 0.02, 0.02)), name="ball"
    ),
}


@pytest.mark.parametrize("name", ZONES)
@given(seed=st.integers(0, 2**32 - 1), size=st.sampled_from([0.0, 1e-4, 5e-3, 0.05]))
@settings(max_examples=20, deadline=None)
def test_agrees_with_the_distance_along_the_way(name: str, seed: int, size: float) -> None:
    zone, rng = ZONES[name], np.random.default_rng(seed)
    corners = zone.triangles.reshape(-1, 3)
    a = rng.uniform(corners.min(axis=0), corners.max(axis=0), (40, 3))
    b = a + size * rng.normal(size=a.shape)
    share = np.linspace(0.0, 1.0, SAMPLES)[:, None, None]
    along = np.abs(zone.clearance(a + share * (b - a)))
    least = along.min(axis=0)
    # Between two samples the distance can be less by half of what lies between them.
    missed = 0.5 * np.linalg.norm(b - a, axis=1) / (SAMPLES - 1)
    assert not np.any(clear(zone, a, b, least + ROUNDING))
    below = least - missed - ROUNDING
    some = below > 0.0
    assert np.all(clear(zone, a[some], b[some], below[some]))


def test_a_way_through_a_thin_wall_is_not_clear() -> None:
    plate = SafeZone.from_mesh(shapes.box((0.2, 0.2, 0.2))).minus(
        shapes.box((0.1, 0.1, 1e-5)), name="plate"
    )
    a, b = np.array([[0.0, 0.0, -0.01]]), np.array([[0.001, 0.0, 0.01]])
    assert not clear(plate, a, b, np.array([1e-9]))[0]


def test_parallel_to_an_edge_and_along_a_face() -> None:
    box = SafeZone.from_mesh(shapes.box((0.1, 0.1, 0.1)))
    # 3 mm and 4 mm from two faces, so 3 mm from the nearer one all the way.
    a, b = np.array([[0.047, 0.046, -0.02]]), np.array([[0.047, 0.046, 0.02]])
    assert clear(box, a, b, np.array([0.003 - 1e-9]))[0]
    assert not clear(box, a, b, np.array([0.003 + 1e-9]))[0]


def test_without_walls_everything_is_clear() -> None:
    a = np.zeros((1, 3))
    assert clear(SafeZone.unbounded(), a, a + 1.0, np.array([1e3]))[0]
