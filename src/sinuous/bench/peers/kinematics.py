"""The robot of the scene in CasADi, as polynomials.

Coordinates are scaled: y = (theta_x, theta_y, gamma / r) per segment with the pitch radius r,
so that all are of the order of one, and lengths are counted in r. With w = |u theta|^2 a point
at the fraction u of a segment is gamma u (C u theta, S), where S = sum (-w)^k / (2k + 1)! and
C = sum (-w)^k / (2k + 2)! need neither a square root nor a case for the straight shape.
"""

from math import factorial

import casadi as ca
import numpy as np

from sinuous.arrays import Array
from sinuous.robots.pcc import PccRobot

TERMS = 13  # of both series: exact to the last digit up to a bend of 150 deg per segment


def scaling(robot: PccRobot) -> Array:
    """Factors (n,) with c = factors * y; the lengths' unit is the pitch radius."""
    return np.tile([1.0, 1.0, unit(robot)], len(robot.segments))


def unit(robot: PccRobot) -> float:
    """The pitch radius r [m], in which the peers count lengths."""
    return robot.segments[0].pitch_radii[0]


def disk_positions(robot: PccRobot, y: ca.SX) -> ca.SX:
    """Centres of all disks (3, D) in units of r, from base to tip."""
    turn = ca.SX(ca.DM(robot.T_w_b[:3, :3]))
    place = ca.SX(ca.DM(robot.T_w_b[:3, 3] / unit(robot)))
    points: list[ca.SX] = []
    for j, segment in enumerate(robot.segments):
        theta, gamma = y[3 * j : 3 * j + 2], y[3 * j + 2]
        square = ca.sumsqr(theta)
        for i in range(1, segment.disks + 1):
            u = i / segment.disks
            s, c = _series(u * u * square, 1), _series(u * u * square, 2)
            points.append(place + turn @ (gamma * u * ca.vertcat(c * u * theta, s)))
        s, c = _series(square, 1), _series(square, 2)
        axis = ca.skew(ca.vertcat(-theta[1], theta[0], 0.0))
        place, turn = points[-1], turn @ (ca.SX.eye(3) + s * axis + c * axis @ axis)
    return ca.horzcat(*points)


def _series(w: ca.SX, first: int) -> ca.SX:
    """The sum of (-w)^k / (2k + first)!, by Horner's rule."""
    total = ca.SX(0.0)
    for k in reversed(range(TERMS)):
        total = 1.0 / factorial(2 * k + first) - total * w
    return total
