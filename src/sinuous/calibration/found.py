"""What was found, in the words of the robot: values with intervals."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array
from sinuous.calibration.fit import Fit
from sinuous.calibration.problem import Problem

# Half the width of a 95 % interval of a normal distribution, in standard deviations.
WIDTH = 1.96
STEP = 1e-4


@dataclass(frozen=True, kw_only=True, eq=False)
class Estimate:
    """Values of one kind, with their standard deviations, and their unit."""

    value: Array
    std: Array
    unit: str

    @property
    def low(self) -> Array:
        """Lower ends of the 95 % intervals."""
        return self.value - WIDTH * self.std

    @property
    def high(self) -> Array:
        """Upper ends of the 95 % intervals."""
        return self.value + WIDTH * self.std

    def as_json(self) -> dict[str, object]:
        """What goes into the JSON file."""
        return {
            "unit": self.unit,
            "value": self.value.tolist(),
            "low": self.low.tolist(),
            "high": self.high.tolist(),
        }


UNITS = {
    "base_position": "m",
    "base_rotation": "rad",
    "marker": "m",
    "hole_angle": "rad",
    "twist": "rad",
    "effective_turn": "rad",
    "hole_radius": "m",
    "effective_pitch": "m",
    "stiffness_ratio": "1/m^3",
    "slack": "m",
    "rest_bend": "rad",
    "friction": "1/m",
    "play": "m",
}


def quantities(problem: Problem, x: Array) -> dict[str, Array]:
    """What a robot file and a report say, from parameters."""
    model, p = problem.model(x), problem.parameters
    pitch, turn = effective(problem, x)
    return {
        "base_position": problem.base_pose(x)[:3, 3],
        "base_rotation": p.values(x, "base_rotation"),
        "marker": problem.marker(x),
        "hole_angle": problem.cable_angles(x),
        "twist": model.twist,
        "hole_radius": problem.hole_radii(x),
        "effective_pitch": pitch,
        "effective_turn": turn,
        "stiffness_ratio": model.stiffness[:1],
        "slack": model.slack,
        "rest_bend": model.rest.ravel(),
        "friction": model.friction[:1],
        "play": np.array([model.play]),
    }


def estimates(problem: Problem, fitted: Fit) -> Mapping[str, Estimate]:
    """The same with standard deviations, to first order in those of the parameters."""
    here = quantities(problem, fitted.x)
    slopes = {name: np.empty((value.size, len(fitted.x))) for name, value in here.items()}
    steps = STEP * problem.parameters.spread
    for k, step in enumerate(steps):
        moved = fitted.x.copy()
        moved[k] += step
        for name, value in quantities(problem, moved).items():
            slopes[name][:, k] = (value - here[name]) / step
    return {
        name: Estimate(
            value=value,
            std=np.sqrt(np.einsum("ik,kl,il->i", slopes[name], fitted.covariance, slopes[name])),
            unit=UNITS[name],
        )
        for name, value in here.items()
    }


def effective(problem: Problem, x: Array) -> tuple[Array, Array]:
    """Pitch radius [m] and turn [rad] (J,) with which constant-curvature kinematics come nearest.

    Elastic cables bend a robot less than their lengths say. Up to segment j, kinematics bend by
    D_j / rho_j, turned by alpha_j, with D_j the least-squares solution of its cables; these are
    the rho_j and alpha_j that make the sum of squares to the elastic model's bend least, over
    what was recorded.
    """
    angles = np.concatenate([segment.cable_angles for segment in problem.robot.segments])
    around = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    free = [each for each in problem.sequences if not each.own_zeros] or list(problem.sequences)
    pulls = np.concatenate([each.pulls for each in free])
    bends = np.concatenate([problem.bends(x, each) for each in free])
    total = np.cumsum(bends.reshape(len(bends), -1, 2), axis=1)
    pitch, turn, row = np.empty(len(problem.lengths)), np.empty(len(problem.lengths)), 0
    for j, segment in enumerate(problem.robot.segments):
        cables = slice(row, row + len(segment.cable_angles))
        row = cables.stop
        unit = pulls[:, cables] @ np.linalg.pinv(around[cables]).T
        unit, bent = unit - unit.mean(axis=0), total[:, j] - total[:, j].mean(axis=0)
        along = float(np.sum(unit * bent))
        across = float(np.sum(unit[:, 0] * bent[:, 1] - unit[:, 1] * bent[:, 0]))
        pitch[j] = float(np.sum(unit * unit)) / max(float(np.hypot(along, across)), 1e-12)
        turn[j] = np.arctan2(across, along)
    return pitch, turn
