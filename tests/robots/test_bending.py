"""How far joints and segments are bent: against acos(cos cos), differences, and convexity."""

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from sinuous.arrays import Array
from sinuous.robots.bending import (
    SMALL,
    BendLimits,
    bend,
    bend_gradient,
    bend_hessian,
    bends,
    slack,
    slack_jacobian,
)

from .random_jointed import angles

ROUNDING = 1e-15  # relative, of a dozen operations
LOST = 4.0 * float(np.finfo(np.longdouble).eps)  # of the cosine of the reference
DIFFERENCES = 1e-8  # relative error of extrapolated differences
STEP = 1e-3  # of those differences, as a share of the bend
PARALLEL = 1e-12  # of values on both ends of a chord

directions = st.floats(-np.pi, np.pi)
larger = st.floats(0.01, 1.5)  # [rad]


@given(x=st.floats(-1.5, 1.5), y=st.floats(-1.5, 1.5))
@settings(max_examples=200)
def test_a_joint_is_bent_by_the_angle_between_its_links(x: float, y: float) -> None:
    # acos loses half of the digits near a cosine of one, also those of longer numbers.
    exact = float(np.arccos(np.cos(np.longdouble(x)) * np.cos(np.longdouble(y))))
    # Below SMALL the bend is that of a segment, hypot(x, y), larger by at most r^3 / 24.
    allowed = 4 * ROUNDING + LOST / max(exact, 1e-9) + min(exact, SMALL) ** 3 / 20.0
    assert abs(bend(True, x, y) - exact) < allowed
    assert bend(False, x, y) == pytest.approx(np.hypot(x, y), rel=ROUNDING)


@pytest.mark.parametrize("size", [1e-12, 1e-9, 1e-6, 5e-5, 9.9e-5, 1.01e-4, 1e-3])
def test_small_bends_of_a_joint_are_those_of_a_segment(size: float) -> None:
    """acos(cos x cos y) = r - x^2 y^2 / (6 r) and higher terms, with r = hypot(x, y)."""
    x, y = 0.6 * size, 0.8 * size
    assert bend(True, x, y) == pytest.approx(size - (x * y) ** 2 / (6.0 * size), rel=3e-9)


def differences(value: Callable[[Array], Any], q: Array, h: float) -> Array:
    """Derivative by both angles (2, ...), central differences of two steps extrapolated."""
    found = list[Any]()
    for step in h * np.eye(2):
        wide = (np.array(value(q + step)) - np.array(value(q - step))) / (2.0 * h)
        half = (np.array(value(q + step / 2)) - np.array(value(q - step / 2))) / h
        found.append((4.0 * half - wide) / 3.0)
    return np.array(found)


@pytest.mark.parametrize("is_joint", [True, False])
@given(size=larger, direction=directions)
@settings(max_examples=150)
def test_gradient_and_hessian_match_differences(
    is_joint: bool, size: float, direction: float
) -> None:
    q = angles(np.array(size), np.array(direction))
    gradient = differences(lambda q: bend(is_joint, *q), q, STEP * size)
    assert np.max(np.abs(bend_gradient(is_joint, *q) - gradient)) < DIFFERENCES
    xx, xy, yy = bend_hessian(is_joint, *q)
    hessian = differences(lambda q: bend_gradient(is_joint, *q), q, STEP * size)
    assert np.max(np.abs([[xx, xy], [xy, yy]] - hessian)) < DIFFERENCES * max(1.0 / size, 1.0)


def test_what_is_not_bent_has_no_gradient() -> None:
    assert bend_gradient(True, 0.0, 0.0) == (0.0, 0.0)
    assert bend_gradient(False, 0.0, 0.0) == (0.0, 0.0)


@given(size=larger, first=directions, second=directions, share=st.floats(0.0, 1.0))
@settings(max_examples=300)
def test_level_sets_are_convex(size: float, first: float, second: float, share: float) -> None:
    """On a straight way between two equally bent joints none is bent more."""
    a, b = angles(np.array(size), np.array(first)), angles(np.array(size), np.array(second))
    x, y = a + share * (b - a)
    assert bend(True, x, y) <= size * (1.0 + PARALLEL)


@given(seed=st.integers(0, 2**32 - 1))
@settings(max_examples=50)
def test_limits_of_many_at_once(seed: int) -> None:
    """`bends` and `slack` of arrays against the kernels, one by one."""
    rng = np.random.default_rng(seed)
    J, n = 4, 9
    limits = BendLimits(
        column=np.array([0, 2, 4, 7]),
        is_joint=np.array([True, False, True, False]),
        slope=rng.normal(size=(J, n)),
        offset=rng.uniform(0.1, 1.0, J),
        pitch=rng.uniform(0.01, 0.04, J),
    )
    c = rng.uniform(-0.7, 0.7, (5, n))
    one = [[bend(bool(k), v[i], v[i + 1])
            for i, k in zip(limits.column, limits.is_joint, strict=True)] for v in c]  # fmt: skip
    np.testing.assert_allclose(bends(limits, c), one, rtol=4 * ROUNDING, atol=1e-15)
    left = limits.pitch * (c @ limits.slope.T + limits.offset - np.array(one))
    np.testing.assert_allclose(slack(limits, c), left, rtol=0, atol=1e-15)
    steps = 1e-4 * np.eye(n)
    wide = (slack(limits, c[0] + steps) - slack(limits, c[0] - steps)) / 2e-4
    half = (slack(limits, c[0] + steps / 2) - slack(limits, c[0] - steps / 2)) / 1e-4
    expected = ((4.0 * half - wide) / 3.0).T
    if np.min(np.array(one)[0]) > 0.05:
        np.testing.assert_allclose(slack_jacobian(limits, c[0]), expected, rtol=0, atol=DIFFERENCES)
