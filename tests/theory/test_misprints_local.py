"""The local controller of paper B: printed and other readings of (25)-(27), side by side."""

from collections.abc import Callable

import numpy as np

from sinuous.arrays import Array
from sinuous.control.local import LocalController
from sinuous.control.observed import Observed
from sinuous.robots.robot_file import load_robot

ROBOT = load_robot("hachen2025")
DISKS = ROBOT.disk_indices[:-1]  # all but the tip, as (26) sums
NOMINAL = ROBOT.home
REAL = ROBOT.home + np.array([0.2, -0.1, 0.003, -0.15, 0.1, -0.002, 0.1, 0.2, 0.001])
STEP = 1e-6  # of finite differences, in units of the coordinates
CLOSE = 1e-6  # relative, of central differences


def body_error(real: Array, nominal: Array) -> float:
    """D_body (26) [m^2] of two configurations (n,)."""
    apart = ROBOT.points(nominal)[DISKS] - ROBOT.points(real)[DISKS]
    return float(np.mean(np.sum(apart**2, axis=1)))


def slope(function: Callable[[Array], float], c: Array) -> Array:
    """Derivative (n,) by central differences."""
    return np.array(
        [
            (function(c + STEP * e) - function(c - STEP * e)) / (2.0 * STEP)
            for e in np.eye(len(c))
        ]
    )  # fmt: skip


def printed() -> Array:
    """The right side of (27) (n,), by coordinates: 2 / (3n - 1) sum (p^ - p)' J_i."""
    apart = ROBOT.points(NOMINAL)[DISKS] - ROBOT.points(REAL)[DISKS]
    return 2.0 / len(DISKS) * np.einsum("sd,sdn->n", apart, ROBOT.points_jacobian(REAL)[DISKS])


def test_b11_27_is_minus_the_derivative_by_the_real_state() -> None:
    by_real = slope(lambda c: body_error(c, NOMINAL), REAL)
    np.testing.assert_allclose(printed(), -by_real, rtol=0, atol=CLOSE * np.max(np.abs(by_real)))


def test_b11_27_is_no_derivative_by_the_nominal_state() -> None:
    """As (27) is written: its left side has x^ below, and its Jacobians are of the real body."""
    by_nominal = slope(lambda c: body_error(REAL, c), NOMINAL)
    assert np.linalg.norm(printed() - by_nominal) > 0.05 * np.linalg.norm(by_nominal)


def test_b11_moving_along_the_printed_right_side_brings_the_bodies_together() -> None:
    step = 1e-3 * printed() / np.linalg.norm(printed())
    assert body_error(REAL + step, NOMINAL) < body_error(REAL, NOMINAL)
    # Moving along what (25) says, the derivative itself, takes them apart.
    assert body_error(REAL - step, NOMINAL) > body_error(REAL, NOMINAL)


def test_b11_ours_brings_them_together() -> None:
    points = ROBOT.points(REAL)
    seen = Observed(c=REAL, tip=points[-1], points=points)
    local = LocalController(tip_gain=0.0)
    rates = local.rates(ROBOT, seen, ROBOT.points(NOMINAL), 1 / 30)
    change = np.linalg.lstsq(ROBOT.lengths_jacobian(REAL), rates, rcond=None)[0]
    assert body_error(REAL + 0.01 * change, NOMINAL) < body_error(REAL, NOMINAL)
