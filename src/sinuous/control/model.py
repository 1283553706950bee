"""The numbers of a controller as arrays for the compiled step."""

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from sinuous.arrays import Array, BoolArray, IntArray
from sinuous.control.metric import actuator_metric
from sinuous.control.step import assemble
from sinuous.control.step.data import Limits, Model
from sinuous.control.terms import Costs, total_weights
from sinuous.geometry.safe_zone import SafeZone
from sinuous.robots.robot import Robot
from sinuous.robots.routing import Routing

ROUNDING = 1e-14  # coefficients below this share of the largest are zero


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Numbers that steer a controller.

    Arguments:
        margin: [m]
        dt: [s]
        rate_share: of the actuators' speed limits
        tip_speed: [m/s], infinite for no limit
        trust: largest change of an actuator from its predicted length [m]
        reserve, near, rounds, late: see `step.data.Rules`
    """

    margin: float
    dt: float
    rate_share: float
    tip_speed: float
    trust: float
    reserve: float
    near: float
    rounds: int
    late: float


def make_model(*, robot: Robot, zone: SafeZone, costs: Costs, settings: Settings) -> Model:
    """Collect what a step reads."""
    metric = actuator_metric(robot)
    inverse = _plain(np.asarray(np.linalg.inv(metric), dtype=np.float64))
    step = float(np.max(robot.rate_limits)) * settings.dt
    weights, E = total_weights(costs.state, robot), costs.effort.hessian(robot)
    n = len(robot.home)
    Q = np.zeros((n, n)) if weights.Q is None else weights.Q
    q = np.zeros(n) if weights.q is None else weights.q
    body = assemble.body(
        robot.chain,
        _plain(robot.T_w_b),
        robot.required_distance(settings.margin),
        robot.movable,
        zone.arrays,
        zone.grid,
    )
    aims = assemble.aims(weights.tip, weights.posture, _plain(Q), q, _plain(E), robot.home)
    scale = assemble.scale(
        step,
        metric,
        inverse,
        _plain(step**2 * inverse.T @ Q @ inverse),
        _plain(step**2 * inverse.T @ E @ inverse),
    )
    rules = assemble.rules(settings.reserve, settings.near, settings.rounds, settings.late)
    bends = assemble.bends(*robot.bend_limits)
    return assemble.model(body, bends, _limits(robot, inverse, settings), aims, scale, rules)


def _limits(robot: Robot, inverse: Array, settings: Settings) -> Limits:
    """Limits of actuators, and of coordinates that no actuator's limits imply."""
    own = np.flatnonzero(np.any(np.isfinite(robot.coordinate_limits), axis=1))
    picked = np.eye(len(robot.home))[own]
    scaled = np.concatenate([robot.lengths_jacobian(robot.home), picked]) @ inverse
    moving = np.concatenate([_moving(robot.routing), picked != 0.0])
    low, high = np.concatenate([robot.length_limits, robot.coordinate_limits[own]]).T
    slowest, fastest = robot.rate_limits.T * settings.rate_share * settings.dt
    return assemble.limits(
        robot.routing,
        own,
        _plain(scaled),
        *_spans(moving, inverse),
        _plain(low),
        _plain(high),
        _plain(slowest),
        _plain(fastest),
        settings.trust,
        settings.tip_speed * settings.dt,
    )


def _plain(values: Array) -> Array:
    """The layout that compiled code takes."""
    return np.ascontiguousarray(values, dtype=np.float64)


def _moving(routing: Routing) -> BoolArray:
    """Which coordinates change which lengths (P, n), somewhere."""
    moving = routing.A != 0.0
    for k, (first, last) in enumerate(pairwise(routing.first)):
        for column in routing.column[first:last]:
            moving[k, column : column + 2] = True
    return moving


def _spans(moving: BoolArray, inverse: Array) -> tuple[IntArray, IntArray]:
    """First and one past the last coefficient of every row in y that can be other than zero.

    Arguments:
        moving: which coordinates change the row's value (K, n)
        inverse: M^-1 (n, n)
    """
    used = moving @ (np.abs(inverse) > ROUNDING * np.max(np.abs(inverse)))
    return np.argmax(used, axis=1), used.shape[1] - np.argmax(used[:, ::-1], axis=1)
