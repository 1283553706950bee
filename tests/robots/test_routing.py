"""Cables across joints: stretches against rotations, derivatives against differences."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from sinuous.arrays import Array
from sinuous.robots import routing
from sinuous.robots.routing import Routing

ROUNDING = 1e-15  # [m] of lengths of a tenth of a metre
DIFFERENCES = 1e-10  # absolute, of derivatives [m/rad] of a few centimetres
STEP = 1e-3  # [rad] of extrapolated differences
NAMES = "XYZ"


def random_routing(rng: np.random.Generator) -> Routing:
    """Two actuators without crossings, one with three of them, one with one."""
    crossings, n = 4, 8
    return Routing(
        A=rng.normal(size=(4, n)),
        b=rng.normal(size=4),
        first=np.array([0, 0, 3, 3, 4]),
        column=np.array([1, 3, 6, 3]),
        axes=np.array([rng.permutation(3)[:2] for _ in range(crossings)]),
        before=rng.uniform(-0.05, 0.05, (crossings, 3)),
        after=rng.uniform(-0.05, 0.05, (crossings, 3)),
    )


def literal(cables: Routing, c: Array) -> Array:
    """The formula of the module, with scipy's rotations."""
    total = cables.A @ c + cables.b
    for k in range(len(total)):
        for x in range(cables.first[k], cables.first[k + 1]):
            column = cables.column[x]
            turn = Rotation.from_euler(
                "".join(NAMES[axis] for axis in cables.axes[x]), c[column : column + 2]
            )
            total[k] += np.linalg.norm(cables.before[x] + turn.apply(cables.after[x]))
    return total


def lengths(cables: Routing, c: Array) -> Array:
    out = np.full((len(c), len(cables.b)), np.nan)
    routing.lengths_batch(cables, c, out)
    return out


@pytest.mark.parametrize("seed", range(20))
def test_lengths_and_their_derivative(seed: int) -> None:
    rng = np.random.default_rng(seed)
    cables, c = random_routing(rng), rng.uniform(-3.0, 3.0, 8)
    assert np.max(np.abs(lengths(cables, c[None])[0] - literal(cables, c))) < 20 * ROUNDING
    J = np.full((4, 8), np.nan)
    routing.jacobian(cables, c, J)
    steps = STEP * np.eye(8)
    wide = (lengths(cables, c + steps) - lengths(cables, c - steps)) / (2 * STEP)
    half = (lengths(cables, c + steps / 2) - lengths(cables, c - steps / 2)) / STEP
    np.testing.assert_allclose(J, ((4 * half - wide) / 3).T, rtol=0, atol=DIFFERENCES)


def test_a_stretch_of_no_length_has_no_derivative() -> None:
    """Where two holes meet: any finite number will do, and none is not a number."""
    hole = np.array([[0.01, 0.02, 0.03]])
    cables = Routing(
        A=np.zeros((1, 2)), b=np.zeros(1), first=np.array([0, 1]), column=np.array([0]),
        axes=np.array([[2, 0]]), before=-hole, after=hole,
    )  # fmt: skip
    assert np.array_equal(lengths(cables, np.zeros((1, 2))), [[0.0]])
    J = np.full((1, 2), np.nan)
    routing.jacobian(cables, np.zeros(2), J)
    assert np.array_equal(J, [[0.0, 0.0]])


def test_affine_lengths_cross_no_joints() -> None:
    rng = np.random.default_rng(3)
    A, b, c = rng.normal(size=(5, 3)), rng.normal(size=5), rng.normal(size=(4, 3))
    np.testing.assert_allclose(lengths(routing.affine(A, b), c), c @ A.T + b, rtol=1e-14)
