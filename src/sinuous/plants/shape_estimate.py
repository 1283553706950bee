"""The shape of the whole body from encoders, curvature readings and a tip tracker.

The unknown is how far the curvature of every short arc is off the model's, a Gaussian process
along the body, and how far the base is tilted. Estimating a continuum robot's shape as a
Gaussian process along its arc length follows Lilge, Barfoot and Burgner-Kahrs, "Continuum robot
state estimation using Gaussian process regression on SE(3)" (2022); here the process is one of
curvature, because a backbone that neither twists nor shears needs no more.
"""

from dataclasses import dataclass

import numpy as np
from scipy.linalg import cho_solve, cholesky, solve_triangular

from sinuous.arrays import Array, IntArray
from sinuous.robots.centreline import HINGE, Bends, Centreline

# Gauss-Newton ends when the coil moves less than this [m], far below any tracker's noise.
CONVERGED = 1e-7
ITERATIONS = 50


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

    With x the deviation, K its prior covariance, h(x) what sensors should say, H = dh/dx and
    R their covariance, every iteration goes towards x = K H' (H K H' + R)^-1 (y - h + H x), all
    the way as long as that converges. At the end the covariance is K - K H' (H K H' + R)^-1 H K.

    Arguments:
        line: the robot's centre line, with the tracker's coil
        prior: how far its curvature may be off the model's
    """

    def __init__(self, line: Centreline, prior: ShapePrior) -> None:
        self._line, self._prior = line, prior
        self._bending = np.flatnonzero(line.bends)
        section, middle = line.section[self._bending], line.middle[self._bending]
        apart = np.sqrt(3.0) * np.abs(middle[:, None] - middle) / prior.correlation
        alike = (1.0 + apart) * np.exp(-apart)
        self._alike = np.where(section[:, None] == section, alike, 0.0)

    def estimate(
        self, lengths: Array, *, strain: Strain | None = None, tip: TipFix | None = None
    ) -> ShapeEstimate:
        """The shape (S, 3), given actuator lengths (P,) [m] and what sensors say."""
        model = self._line.model(self._line.robot.configuration(lengths))
        K, sensors = self._prior_covariance(model), _Sensors(strain=strain, tip=tip)
        x, moved, iterations, way = np.zeros(len(K)), np.inf, 0, 1.0
        read = self._read(sensors, model, x)
        while moved > CONVERGED and iterations < ITERATIONS:
            H = read.slope
            KH = K @ H.T
            factor = cholesky(H @ KH + np.diag(read.variance), lower=True)
            goal = KH @ cho_solve((factor, True), read.left + H @ x)
            x, coil, last = x + way * (goal - x), read.points[-1], moved
            read = self._read(sensors, self._bent(model, x), x)
            moved, iterations = float(np.max(np.abs(read.points[-1] - coil))), iterations + 1
            way *= 0.5 if moved > 0.5 * last else 1.0
        return ShapeEstimate(
            points=read.points[:-1],
            covariance=_covariance(read, K),
            bends=self._bent(model, x),
            iterations=iterations,
            converged=moved <= CONVERGED,
        )

    def _prior_covariance(self, model: Bends) -> Array:
        """Of the tilt and of the curvatures, in the order of the centre line's coordinates."""
        bent = np.hypot(*model.curvature[self._bending].T)
        std = np.hypot(self._prior.floor, self._prior.share * bent)
        K = np.zeros((self._line.coordinates, self._line.coordinates))
        K[:HINGE, :HINGE] = self._prior.tilt**2 * np.eye(HINGE)
        for axis in range(2):
            rows = slice(HINGE + axis, None, 2)
            K[rows, rows] = std[:, None] * std * self._alike
        return K

    def _bent(self, model: Bends, x: Array) -> Bends:
        curvature = model.curvature.copy()
        curvature[self._bending] += x[HINGE:].reshape(-1, 2)
        return Bends(lengths=model.lengths, curvature=curvature, tilt=model.tilt + x[:HINGE])

    def _read(self, sensors: "_Sensors", bends: Bends, x: Array) -> "_Linear":
        """What sensors should say of a shape that is the deviation x (n,) away from the model."""
        points, jacobian = self._line.points_with_jacobian(bends)
        slope, left, variance = [np.zeros((0, len(x)))], [np.zeros(0)], [np.zeros(0)]
        if sensors.strain is not None:
            strain = sensors.strain
            column = HINGE + 2 * np.searchsorted(self._bending, strain.arcs)
            slope.append(np.eye(len(x))[(column[:, None] + np.arange(2)).ravel()])
            left.append((strain.curvature - bends.curvature[strain.arcs]).ravel())
            variance.append(strain.variance.ravel())
        if sensors.tip is not None:
            slope.append(jacobian[-1])
            left.append(sensors.tip.position - points[-1])
            variance.append(np.full(3, sensors.tip.variance))
        return _Linear(
            points=points,
            jacobian=jacobian,
            slope=np.concatenate(slope),
            left=np.concatenate(left),
            variance=np.concatenate(variance),
        )


@dataclass(frozen=True, kw_only=True, eq=False)
class _Sensors:
    """What there is of them."""

    strain: Strain | None
    tip: TipFix | None


@dataclass(frozen=True, kw_only=True, eq=False)
class _Linear:
    """A shape and what m readings say of it, to first order.

    Arguments:
        points: guarded points and coil (S + 1, 3) [m]
        jacobian: their derivative (S + 1, 3, n)
        slope: derivative of what should be read (m, n)
        left: what is read less what should be (m,)
        variance: of the readings (m,)
    """

    points: Array
    jacobian: Array
    slope: Array
    left: Array
    variance: Array


def _covariance(read: _Linear, K: Array) -> Array:
    """Covariance (S, 3, 3) [m^2] of the guarded points after the readings, K (n, n) before."""
    jacobian, H = read.jacobian[:-1], read.slope
    count, _, n = jacobian.shape
    rows = jacobian.reshape(-1, n) @ K
    factor = cholesky(H @ K @ H.T + np.diag(read.variance), lower=True)
    known = solve_triangular(factor, H @ rows.T, lower=True).T.reshape(count, 3, -1)
    prior = rows.reshape(count, 3, n) @ jacobian.transpose(0, 2, 1)
    return prior - known @ known.transpose(0, 2, 1)
