"""How far a segment or a joint is bent, and how far it may be.

A segment of constant curvature with the bend vector theta is bent by |theta|, a universal joint
with the angles q by acos(cos q1 cos q2), the angle between the axes of its two links.  Both have
convex level sets: on a straight way in c the largest bend is at one of its ends.
"""

from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.compiled import inner

# Below this bend a joint's is taken as that of a segment; they differ by its third power [rad].
SMALL = 1e-4


class BendLimits(NamedTuple):
    """Limits bend <= slope c + offset; times the pitch radius they are cable travel."""

    column: IntArray  # (J,) first of the two coordinates that bend it
    is_joint: BoolArray  # (J,) whether they are the angles of a universal joint
    slope: Array  # (J, n)
    offset: Array  # (J,) [rad]
    pitch: Array  # (J,) [m]


@inner
def bend(is_joint: bool, x: float, y: float) -> float:
    """How far it is bent [rad]."""
    flat = np.sqrt(x * x + y * y)
    if is_joint and flat > SMALL:
        # As acos, but exact where the cosine is close to one.
        a, b = np.sin(0.5 * x), np.sin(0.5 * y)
        half = a * a + b * b - 2.0 * a * a * b * b  # (1 - cos x cos y) / 2
        return 2.0 * np.arctan2(np.sqrt(max(half, 0.0)), np.sqrt(max(1.0 - half, 0.0)))
    return flat


@inner
def bend_gradient(is_joint: bool, x: float, y: float) -> tuple[float, float]:
    """Its derivatives by the two coordinates; zero where it is not bent."""
    value = bend(is_joint, x, y)
    if value == 0.0:
        return 0.0, 0.0
    if is_joint and value > SMALL:
        inverse = 1.0 / np.sin(value)
        return np.sin(x) * np.cos(y) * inverse, np.cos(x) * np.sin(y) * inverse
    return x / value, y / value


@inner
def bend_hessian(is_joint: bool, x: float, y: float) -> tuple[float, float, float]:
    """Its second derivatives xx, xy, yy where it is bent."""
    value = bend(is_joint, x, y)
    gx, gy = bend_gradient(is_joint, x, y)
    if is_joint and value > SMALL:
        cosine, inverse = np.cos(value), 1.0 / np.sin(value)
        return (
            cosine * (1.0 - gx * gx) * inverse,
            -(np.sin(x) * np.sin(y) + cosine * gx * gy) * inverse,
            cosine * (1.0 - gy * gy) * inverse,
        )
    return gy * gy / value, -gx * gy / value, gx * gx / value


def slack(limits: BendLimits, c: Array) -> Array:
    """Cable travel left until each limit [m] (..., J); negative: bent too far."""
    return limits.pitch * (c @ limits.slope.T + limits.offset - bends(limits, c))


def slack_jacobian(limits: BendLimits, c: Array) -> Array:
    """Derivative (J, n) of the slack at one configuration (n,)."""
    jacobian = limits.slope.copy()
    for j, column in enumerate(limits.column):
        x, y = bend_gradient(bool(limits.is_joint[j]), float(c[column]), float(c[column + 1]))
        jacobian[j, column] -= x
        jacobian[j, column + 1] -= y
    return limits.pitch[:, None] * jacobian


def bends(limits: BendLimits, c: Array) -> Array:
    """How far each limited segment or joint is bent (..., J) [rad] at configurations (..., n)."""
    x, y = c[..., limits.column], c[..., limits.column + 1]
    flat = np.hypot(x, y)
    a, b = np.sin(0.5 * x) ** 2, np.sin(0.5 * y) ** 2
    half = np.clip(a + b - 2.0 * a * b, 0.0, 1.0)
    return np.where(limits.is_joint, 2.0 * np.arcsin(np.sqrt(half)), flat)
