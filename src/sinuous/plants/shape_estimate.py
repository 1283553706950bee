"""The shape of the whole body from encoders, curvature readings and a tip tracker.

The unknown is how far the curvature of every short arc is off the model's, a Gaussian process
along the body, and how far the base is tilted. Estimating a continuum robot's shape as a
Gaussian process along its arc length follows Lilge, Barfoot and Burgner-Kahrs, "Continuum robot
state estimation using Gaussian process regression on SE(3)" (2022); here the process is one of
curvature, because a backbone that neither twists nor shears needs no more.
"""

from dataclasses import dataclass

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.plants import shape_kernels
from sinuous.robots.centreline import TILT, Bends, Centreline

# Gauss-Newton ends when the coil moves less than this [m], far below any tracker's noise.
CONVERGED = 1e-7
ITERATIONS = 50
# Of the curvature of a segment along each axis: all others together have 0.03 % of the variance.
MODES = 10


@dataclass(frozen=True, kw_only=True)
class ShapePrior:
    """What is thought of a robot before anything but its encoders is read.

    Deviations of the curvature are a Matern process (3/2) in every segment and independent
    between segments, where cables end and the curvature jumps.

    Arguments:
        floor: standard deviation of the curvature of a straight robot [1/m]
        share: of a bent one, as a share of the segment's curvature; both add in squares
        correlation: distance over which deviations are alike, as a share of the segment
        tilt: standard deviation of the base's tilt towards each axis [rad]

    Raises:
        ValueError: if a value is not positive, or not finite
    """

    floor: float = 0.5
    share: float = 0.1
    correlation: float = 0.7
    tilt: float = float(np.deg2rad(0.6))

    def __post_init__(self) -> None:
        values = (self.floor, self.share, self.correlation, self.tilt)
        if not all(0.0 < value < np.inf for value in values):
            raise ValueError("every number of a prior must be positive and finite")


@dataclass(frozen=True, kw_only=True, eq=False)
class Strain:
    """Curvature read along the body.

    Arguments:
        arcs: on which arcs of the centre line the stations are (K,)
        curvature: read there (K, 2) [1/m]
        variance: of each reading (K, 2) [1/m^2]
    """

    arcs: IntArray
    curvature: Array
    variance: Array


@dataclass(frozen=True, kw_only=True, eq=False)
class TipFix:
    """Where a tracker says that the coil is.

    Arguments:
        position: (3,) [m]
        variance: of each axis [m^2], of bias and noise together
    """

    position: Array
    variance: float


@dataclass(frozen=True, kw_only=True, eq=False)
class ShapeEstimate:
    """The most probable shape, and how sure it is.

    Arguments:
        points: guarded points (S, 3) [m]
        covariance: of each of them (S, 3, 3) [m^2]
        bends: curvature and tilt
        iterations: of Gauss-Newton
        converged: whether its last step was small
    """

    points: Array
    covariance: Array
    bends: Bends
    iterations: int
    converged: bool


class ShapeEstimator:
    """Maximum a posteriori by Gauss-Newton: the prior's mean is the model's shape.

    The prior is written as deviation = modes * std * z, with z normal and independent: the modes
    are those of the Matern process with the largest variances. With h(z) what sensors should say,
    over the standard deviation of each, and H = dh/dz, every iteration goes along

        (I + H'H)^-1 (H' (y - h) - z),

    all the way as long as that converges, and (I + H'H)^-1 is the covariance of z at the end.

    Arguments:
        line: the robot's centre line, with the tracker's coil
        prior: how far its curvature may be off the model's
    """

    def __init__(self, line: Centreline, prior: ShapePrior) -> None:
        self._line, self._prior = line, prior
        self._bending = np.flatnonzero(line.bends)
        section = line.section[self._bending]
        owners, columns = list[int](), list[Array]()
        for one in np.unique(section):
            own = np.flatnonzero(section == one)
            for mode in _modes(line.middle[self._bending[own]], prior.correlation):
                for axis in range(2):
                    column = np.zeros(line.coordinates)
                    column[TILT + 2 * own + axis] = mode
                    owners.append(int(self._bending[own[0]]))
                    columns.append(column)
        tilts = np.eye(TILT, line.coordinates)
        self._modes = np.concatenate([tilts, np.array(columns)]).T.copy()
        self._owner = np.array(owners)  # an arc of the mode's segment

    def estimate(
        self, lengths: Array, *, strain: Strain | None = None, tip: TipFix | None = None
    ) -> ShapeEstimate:
        """The shape (S, 3), given actuator lengths (P,) [m] and what sensors say."""
        model = self._line.model(self._line.robot.configuration(lengths))
        bases = self._modes * self._deviation(model)
        z, step = np.zeros(bases.shape[1]), np.empty(bases.shape[1])
        L, bends, moved, iterations, way = np.empty((len(z), len(z))), model, np.inf, 0, 1.0
        points, jacobian = self._line.points_with_jacobian(model)
        while moved > CONVERGED and iterations < ITERATIONS:
            shape_kernels.newton(*self._readings(bends, points, jacobian, bases, strain, tip),
                                 z, L, step)  # fmt: skip
            z, coil, last = z + way * step, points[-1], moved
            bends = self._bent(model, bases @ z)
            points, jacobian = self._line.points_with_jacobian(bends)
            moved, iterations = float(np.max(np.abs(points[-1] - coil))), iterations + 1
            way *= 0.5 if moved > 0.5 * last else 1.0
        covariance = np.empty((len(points) - 1, 3, 3))
        shape_kernels.covariance(L, np.matmul(jacobian[:-1], bases), covariance)
        return ShapeEstimate(
            points=points[:-1],
            covariance=covariance,
            bends=bends,
            iterations=iterations,
            converged=moved <= CONVERGED,
        )

    def _deviation(self, model: Bends) -> Array:
        """Standard deviation of every mode (r,): tilts [rad], then curvatures [1/m]."""
        bent = np.hypot(*model.curvature[self._owner].T)
        curvature = np.hypot(self._prior.floor, self._prior.share * bent)
        return np.concatenate([np.full(TILT, self._prior.tilt), curvature])

    def _bent(self, model: Bends, x: Array) -> Bends:
        curvature = model.curvature.copy()
        curvature[self._bending] += x[TILT:].reshape(-1, 2)
        return Bends(lengths=model.lengths, curvature=curvature, tilt=model.tilt + x[:TILT])

    def _readings(
        self,
        bends: Bends,
        points: Array,
        jacobian: Array,
        bases: Array,
        strain: Strain | None,
        tip: TipFix | None,
    ) -> tuple[Array, Array]:
        """Derivative H (m, r) of what is read and what is left of it (m,), over its deviation."""
        H, left = [np.zeros((0, bases.shape[1]))], [np.zeros(0)]
        if strain is not None:
            column = TILT + 2 * np.searchsorted(self._bending, strain.arcs)
            std = np.sqrt(strain.variance).ravel()
            H.append(bases[(column[:, None] + np.arange(2)).ravel()] / std[:, None])
            left.append((strain.curvature - bends.curvature[strain.arcs]).ravel() / std)
        if tip is not None:
            std = np.sqrt(tip.variance)
            H.append(jacobian[-1] @ bases / std)
            left.append((tip.position - points[-1]) / std)
        return np.concatenate(H), np.concatenate(left)


def _modes(places: Array, correlation: float) -> Array:
    """The largest modes (MODES, K) of a Matern process (3/2) of unit variance at places (K,)."""
    apart = np.sqrt(3.0) * np.abs(places[:, None] - places) / correlation
    values, vectors = np.linalg.eigh((1.0 + apart) * np.exp(-apart))
    return (vectors * np.sqrt(np.maximum(values, 0.0))).T[::-1][:MODES]
