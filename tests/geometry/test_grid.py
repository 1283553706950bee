"""The clearance grid: never optimistic, whatever the zone, and exact where it is asked to be."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.compiled import kernel
from sinuous.geometry import shapes
from sinuous.geometry.bvh import STACK, ZoneArrays
from sinuous.geometry.grid import Grid, at_least, at_least_from_afar, cell_of, exact
from sinuous.geometry.safe_zone import SafeZone

from .scenes import bumpy, l_shape, stress_tube

# A bound of the mean point this far below its clearance would settle nothing [m].
USEFUL = 3e-3


@kernel
def measure(zone: ZoneArrays, grid: Grid, points: Array, out: Array) -> None:
    """Both bounds, the clearance, its gradient and slot of every point: out (M, 7)."""
    stack, keys = np.empty(STACK, np.int64), np.empty(STACK)
    for k in range(points.shape[0]):
        x, y, z = points[k, 0], points[k, 1], points[k, 2]
        cell = cell_of(grid, x, y, z)
        out[k, 0] = at_least(grid, cell, x, y, z)
        out[k, 1] = at_least_from_afar(grid, cell, x, y, z)
        d, gx, gy, gz, slot = exact(zone, grid, cell, x, y, z, stack, keys)
        out[k, 2], out[k, 3], out[k, 4], out[k, 5], out[k, 6] = d, gx, gy, gz, slot


def measured(zone: SafeZone, points: Array) -> Array:
    out = np.empty((len(points), 7))
    measure(zone.arrays, zone.grid, np.ascontiguousarray(points), out)
    return out


def open_tube() -> SafeZone:
    """A tube with an entrance, its guide and an obstacle."""
    axis = shapes.arc_path(0.08, 1.2, stations=12)
    zone = SafeZone.from_mesh(shapes.tube(axis, 0.02), entrance=axis[0], approach=0.05)
    return zone.minus(shapes.sphere(0.004, centre=axis[6]), name="ball")


ZONES = {
    "bumpy": SafeZone.from_mesh(bumpy()),
    "edges": SafeZone.from_mesh(l_shape()),
    "tube": SafeZone.from_mesh(stress_tube()),
    "open, with an obstacle": open_tube(),
}


def around(zone: SafeZone, rng: np.random.Generator, count: int) -> Array:
    """Points in and around the zone's box."""
    corners = zone.triangles.reshape(-1, 3)
    low, high = corners.min(axis=0), corners.max(axis=0)
    return rng.uniform(low - 0.1 * (high - low), high + 0.1 * (high - low), (count, 3))


@pytest.mark.parametrize("name", ZONES)
@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=15, deadline=None)
def test_no_bound_promises_more_room_than_there_is(name: str, seed: int) -> None:
    zone = ZONES[name]
    points = around(zone, np.random.default_rng(seed), 2000)
    found, near = measured(zone, points), zone.nearest(points)
    assert np.all(found[:, 0] <= near.clearance)
    # The second bound is one of the distance, so it holds on the free side.
    free = found[:, 0] >= 0.0
    assert np.all(found[free, 1] <= near.clearance[free])


@pytest.mark.parametrize("name", ZONES)
def test_exact_queries_equal_those_without_a_grid(name: str) -> None:
    zone = ZONES[name]
    points = around(zone, np.random.default_rng(3), 5000)
    found, near = measured(zone, points), zone.nearest(points)
    np.testing.assert_array_equal(found[:, 2], near.clearance)
    np.testing.assert_array_equal(found[:, 3:6], near.gradient)
    np.testing.assert_array_equal(zone.arrays.triangle[found[:, 6].astype(int)], near.triangle)


def test_the_bounds_are_of_use() -> None:
    zone = ZONES["tube"]
    points = around(zone, np.random.default_rng(4), 5000)
    inside = zone.clearance(points) > USEFUL
    found = measured(zone, points[inside])
    first, both = found[:, 0], np.maximum(found[:, 0], found[:, 1])
    assert np.mean(found[:, 2] - first) < USEFUL
    assert np.mean(found[:, 2] - both) < 0.5 * np.mean(found[:, 2] - first)


def test_beyond_an_open_facet_nothing_is_promised() -> None:
    # The clearance jumps there: right behind the far end of the guide is outside.
    axis = shapes.arc_path(0.08, 1.2, stations=12)
    zone = ZONES["open, with an obstacle"]
    behind = axis[0] + np.array([0.0, 0.0, -0.0501])
    before = axis[0] + np.array([0.0, 0.0, -0.0499])
    clearance = zone.clearance([before, behind])
    assert clearance[0] > 0.0 > clearance[1]
    assert measured(zone, behind[None])[0, 0] == -np.inf


def test_space_without_walls_has_room_everywhere() -> None:
    found = measured(SafeZone.unbounded(), np.array([[0.0, 0.0, 0.0], [1e3, -1e3, 1.0]]))
    assert np.all(np.isinf(found[:, 2]))
    assert np.all(found[:, 2] > 0.0)
    assert np.all(found[:, 0] == -np.inf)  # nothing is known, so the query is exact
    assert np.all(found[:, 6] == -1)


def test_points_that_are_no_numbers_and_points_far_away() -> None:
    zone = ZONES["bumpy"]
    far = np.array([[np.nan, 0.0, 0.0], [10.0, 0.0, 0.0], [np.inf, 0.0, 0.0]])
    found = measured(zone, far)
    assert np.all(found[:, 0] == -np.inf)
    assert found[1, 2] == zone.clearance(far[1])
