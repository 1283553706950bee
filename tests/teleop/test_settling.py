"""What is known of walls settles, without lag where a wall stays and without a wall that stays."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.teleop.held import Settling
from sinuous.teleop.motion import NO_WALLS, Plane, Walls
from sinuous.teleop.wall_kernels import NEGLIGIBLE

ROUNDING = 1e-12
SHARE = 0.2
NORMAL = np.array([0.6, 0.0, -0.8])


@pytest.mark.parametrize("bad", [-1.0, np.nan, np.inf])
def test_bad_times_are_refused(bad: float) -> None:
    with pytest.raises(ValueError, match="time"):
        Settling(time=bad)


def settled(before: Plane, way: Array, target: Array, share: float) -> Plane:
    """In a tick of 1 s, by a time that makes that share."""
    now = Walls(held=Plane(target + way, way), near=NO_WALLS.near)
    settling = Settling(time=1.0 / share - 1.0)
    return settling.step(Walls(held=before), now, target, target, 1.0).held


@given(
    steps=st.lists(st.floats(-0.002, 0.002), min_size=1, max_size=30), share=st.floats(0.01, 1.0)
)
def test_a_wall_that_stays_is_known_without_lag(steps: list[float], share: float) -> None:
    """Pushed deeper or let go of: the depth is right in every step."""
    depth = 0.05
    plane = Plane(np.zeros(3), depth * NORMAL)
    for step in steps:
        depth = max(depth + step, 0.0)
        plane = settled(plane, depth * NORMAL, -depth * NORMAL, share)
        np.testing.assert_allclose(plane.way, depth * NORMAL, atol=NEGLIGIBLE)


def test_a_wall_that_begins_settles_geometrically() -> None:
    plane, way = Plane(), 0.01 * NORMAL
    for k in range(1, 30):
        plane = settled(plane, way, -way, SHARE)
        np.testing.assert_allclose(plane.way, (1.0 - (1.0 - SHARE) ** k) * way, atol=ROUNDING)
        np.testing.assert_allclose(plane.place, plane.way - way, atol=ROUNDING)


@given(speed=st.floats(0.0, 0.01))
def test_a_wall_that_is_gone_goes_however_the_target_moves_on(speed: float) -> None:
    """It must not drag along behind a target that moves where it was."""
    target, plane = np.zeros(3), Plane(0.01 * NORMAL, 0.01 * NORMAL)
    for k in range(1, 60):
        target = target - speed * NORMAL
        plane = settled(plane, np.zeros(3), target, SHARE)
        assert np.linalg.norm(plane.way) <= 0.01 * (1.0 - SHARE) ** k + ROUNDING
    assert not np.any(plane.way)


def test_what_flickers_is_felt_as_its_mean() -> None:
    """Walls that change places from step to step, at a target that rests."""
    a, b = np.array([-0.01, 0.0, 0.0]), np.array([0.0, -0.01, 0.0])
    plane, ways = Plane(), list[Array]()
    for k in range(200):
        plane = settled(plane, a if k % 2 else b, np.zeros(3), SHARE)
        ways.append(plane.way)
    jumps = np.linalg.norm(np.diff(ways[100:], axis=0), axis=1)
    assert jumps.max() < SHARE * np.linalg.norm(a - b)
    np.testing.assert_allclose(np.mean(ways[100:], axis=0), 0.5 * (a + b), atol=1e-4)
