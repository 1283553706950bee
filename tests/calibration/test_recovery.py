"""Parameters that are known are found again, within the intervals that are stated."""

import numpy as np
import pytest
from tests.calibration.made import NOISE, ROBOT, commands, simulated, single_pulls, truth

from sinuous.calibration.fit import fit
from sinuous.calibration.found import WIDTH, estimates, quantities
from sinuous.calibration.parameters import parameters

# Of about 45 numbers, many of them correlated, 95 % are expected within their intervals: far
# fewer than that, and the intervals are too narrow.
LEAST_COVERED = 0.85
# The tip is found as well as the noise allows.
MOST_ERROR = 0.3e-3
SEED = 1


Found = dict[str, tuple[np.ndarray, np.ndarray, np.ndarray]]


@pytest.fixture(scope="module")
def found() -> Found:
    """Value, standard deviation and truth of everything."""
    x = truth(SEED, parameters(ROBOT, own_zeros=True))
    made = simulated(x, commands(), single_pulls(), seed=SEED)
    fitted = fit(made, np.ones(len(made.patterns), dtype=bool))
    assert fitted.noise.size == pytest.approx(NOISE, rel=0.2)
    assert fitted.noise.memory < 2.0
    clean = simulated(x, commands(), single_pulls(), seed=SEED, noise=0.0)
    assert np.sqrt(np.mean(np.sum(clean.residuals(fitted.x) ** 2, axis=1))) < MOST_ERROR
    true = quantities(made, x)
    return {
        name: (each.value, each.std, true[name]) for name, each in estimates(made, fitted).items()
    }


def test_intervals_hold_what_they_promise(found: Found) -> None:
    inside = np.concatenate(
        [
            (np.abs(value - true) <= WIDTH * std)[std > 0.0]
            for name, (value, std, true) in found.items()
            if name != "base_rotation"
        ]
    )
    assert np.mean(inside) > LEAST_COVERED


@pytest.mark.parametrize(
    ("name", "half_width"),
    [
        ("hole_radius", 0.3e-3),
        ("slack", 0.5e-3),
        ("stiffness_ratio", 1.5e6),
        ("play", 0.05e-3),
        ("marker", 4e-3),
        ("twist", np.deg2rad(8.0)),
    ],
)
def test_intervals_are_narrow_enough_to_say_something(
    found: Found, name: str, half_width: float
) -> None:
    assert np.max(WIDTH * found[name][1]) < half_width
