"""Rigid registration: motions recovered, what noise leaves, and what cannot be decided."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.spatial.transform import Rotation
from trimesh.registration import procrustes

from sinuous.arrays import Array
from sinuous.geometry.registration import LARGE, register

ROUNDING = 1e-12  # of lengths of a tenth of a metre [m]
CORNERS = 0.1 * np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]], dtype=np.float64)


def moved(points: Array, seed: int) -> tuple[Array, Array, Array]:
    """Points after a random rotation and translation, and these."""
    rng = np.random.default_rng(seed)
    rotation = Rotation.random(rng=rng).as_matrix()
    translation = rng.normal(scale=0.1, size=3)
    return points @ rotation.T + translation, rotation, translation


@given(st.integers(0, 10**6), st.integers(3, 9))
def test_any_rigid_motion_is_recovered(seed: int, number: int) -> None:
    points = 0.1 * np.random.default_rng(seed).normal(size=(number, 3))
    there, rotation, translation = moved(points, seed + 1)
    spread = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
    rounding = ROUNDING * max(spread[0] / spread[1], 1.0) ** 2  # nearly a line is nearly free
    found = register(points, there)
    np.testing.assert_allclose(found.rotation, rotation, atol=100.0 * rounding)
    np.testing.assert_allclose(found.translation, translation, atol=100.0 * rounding)
    assert found.rms < 100.0 * rounding
    assert found.warning == ""
    np.testing.assert_allclose(found.apply(points), there, atol=100.0 * rounding)


@given(st.integers(0, 10**6), st.integers(4, 9))
def test_it_agrees_with_another_implementation(seed: int, number: int) -> None:
    rng = np.random.default_rng(seed)
    points = 0.1 * rng.normal(size=(number, 3))
    there = moved(points, seed)[0] + rng.normal(scale=2e-3, size=points.shape)
    matrix, _, cost = procrustes(points, there, reflection=False, scale=False)
    found = register(points, there)
    np.testing.assert_allclose(found.apply(points), points @ matrix[:3, :3].T + matrix[:3, 3])
    assert found.rms**2 == pytest.approx(cost)


def test_the_mean_residual_is_that_of_theory() -> None:
    """E[FRE^2] = 3 (1 - 2 / K) sigma^2 (Sibson 1979; Fitzpatrick, West and Maurer 1998)."""
    rng, sigma, number = np.random.default_rng(5), 0.5e-3, 6
    points = 0.1 * rng.normal(size=(number, 3))
    squares = [
        register(points, points + rng.normal(scale=sigma, size=points.shape)).rms ** 2
        for _ in range(2000)
    ]
    # 2000 times 12 degrees of freedom: the mean of the squares is known to 0.9 % (one sigma).
    assert np.mean(squares) == pytest.approx(3.0 * (1.0 - 2.0 / number) * sigma**2, rel=0.04)


def test_points_that_do_not_fit_are_said() -> None:
    off = CORNERS.copy()
    off[2, 1] += 0.02
    found = register(CORNERS, off)
    assert found.rms > LARGE
    assert "the worst is point" in found.warning


def test_three_points_that_are_mirrored_cannot_be_told() -> None:
    """Three points lie in a plane and a half turn does what a reflection would."""
    there = CORNERS[:3] * np.array([-1.0, 1.0, 1.0])
    found = register(CORNERS[:3], there)
    assert np.linalg.det(found.rotation) == pytest.approx(1.0)
    assert found.rms < ROUNDING


@pytest.mark.parametrize(
    ("points", "words"),
    [
        (CORNERS[:2], "three or more"),
        (np.zeros((3, 3)) + 0.4, "in different places"),
        (np.outer([0.0, 1.0, 3.0], [0.1, 0.2, 0.3]), "on one line"),
        (np.where(CORNERS == 0.0, np.nan, CORNERS), "finite"),
    ],
)
def test_what_says_too_little_is_refused_in_either_frame(points: Array, words: str) -> None:
    good = CORNERS[: len(points)]
    with pytest.raises(ValueError, match=words):
        register(points, good)
    with pytest.raises(ValueError, match=words):
        register(good, points)


def test_mirror_images_and_lonely_points_are_refused() -> None:
    with pytest.raises(ValueError, match="mirrored"):
        register(CORNERS, CORNERS * np.array([-1.0, 1.0, 1.0]))
    with pytest.raises(ValueError, match="pairs"):
        register(CORNERS, CORNERS[:3])
