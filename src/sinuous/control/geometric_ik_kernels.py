"""Compiled inverse kinematics of a chain of equal links in closed form (paper A, eq. 10-15).

Lengths are counted from A_1, in the base frame: y along the straight robot.  The plane PTY at
height h = (N-1) L cos(chi) is a disc of radius (N-1) L sin(chi) for A_N, and the reference pose
ends on its rim.  With rho = L sin(chi), zeta = z - (N-1) rho <= 0 and j = N - k the second
condition of (11), |A_N - A_k,r| <= j L, reads

    slack_j = -2 j rho zeta - (x^2 + zeta^2) >= 0,

and (12) bends joint k+1 by b with sin(b/2) = sqrt(slack_j / (j-1)) / (2 L).  In the plane of the
reference line and A_N (notes A5), its second axis along (x, zeta cos(chi)) across the line, the
way from A_k to A_N is

    d = (j L + zeta sin(chi), |(x, zeta cos(chi))|).

Nothing cancels where the targets of different k meet, at the rim and at the reference point.
"""

from math import acos, asin, atan2, hypot, isfinite, sqrt
from typing import NamedTuple

import numpy as np

from sinuous.arrays import Array, IntArray
from sinuous.compiled import inner, kernel

REACHED, UNREACHABLE, JOINT_LIMIT, SENSELESS = 0, 1, 2, 3

# A target that is beyond the reach by less is on its rim: rounding of lengths around 1 m.
ROUNDING = 1e-12  # [m]

Vector = tuple[float, float, float]
Frame = tuple[Vector, Vector, Vector]  # the columns of R: x, y, z

BASE: Frame = ((1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0))


class Arm(NamedTuple):
    """A jointed robot as a chain of links."""

    # Towards which axis the first angle of a joint leans its link (N,): 0 (x) if it turns about
    # Z, 2 (z) if about X. The second angle leans it towards the other.
    lean: IntArray
    link: float  # L [m]
    first: float  # from the base to A_1 [m]
    last: float  # from A_N to the tip [m]
    limit: float  # of the bend of a joint [rad]
    insertion: float  # what a coordinate before those of the joints is held at [m]
    T_w_b: Array  # base in the world (4, 4)


@kernel
def solve_one(arm: Arm, target: Array, c: Array, nearest: Array) -> tuple[int, int, float]:
    """See `solve`."""
    return solve(arm, target, c, nearest)


@kernel
def solve_batch(
    arm: Arm,
    targets: Array,
    c: Array,
    nearest: Array,
    status: IntArray,
    first_joint: IntArray,
    bend: Array,
) -> None:
    """The same for targets (B, 3); see `solve`."""
    for b in range(targets.shape[0]):
        status[b], first_joint[b], bend[b] = solve(arm, targets[b], c[b], nearest[b])


@inner
def solve(arm: Arm, target: Array, c: Array, nearest: Array) -> tuple[int, int, float]:
    """Configuration (n,) for one target (3,) and the nearest that can be reached (3,).

    Returns:
        how it ended, the first joint k that leaves the reference pose, the largest bend [rad]
    """
    N, L = arm.lean.size, arm.link
    reach = (N - 1) * L
    x, h, z = from_first_joint(arm, target)
    if not isfinite(x + h + z):
        return SENSELESS, 0, np.nan
    for i in range(3):
        nearest[i] = target[i]
    square = x * x + h * h + z * z
    outside = square > (reach + ROUNDING) ** 2
    if outside:
        x, h, z = _nearest_in_plane(x, h, z, reach)
        _to_world(arm, x, h, z, nearest)
    elif square > reach * reach:
        share = reach / sqrt(square)
        x, h, z = share * x, share * h, share * z
    radius = sqrt(max((reach - h) * (reach + h), x * x + z * z))
    j, least = _pose(arm, x, z, h / reach, radius, c)
    bend = acos(min(max(least, -1.0), 1.0))
    if outside:
        return UNREACHABLE, N - j, bend
    return (JOINT_LIMIT if bend > arm.limit else REACHED), N - j, bend


@inner
def _pose(
    arm: Arm, x: float, z: float, cosine: float, radius: float, c: Array
) -> tuple[int, float]:
    """Write the configuration; return j and the cosine of the largest bend.

    Arguments:
        x, z: of A_N in its plane [m]
        cosine: of chi
        radius: of the disc [m]
    """
    N, L = arm.lean.size, arm.link
    sine, zeta = radius / ((N - 1) * L), min(z - radius, 0.0)
    j, slack = _fewest_links(N, L * sine, x, zeta)
    frame, least = BASE, 1.0
    straighten(arm, c)
    if j < N - 1:
        frame, least = _tilt(arm, cosine, sine, c), cosine
    across = zeta * cosine
    proximal, distal = _fold(L, j, slack, j * L + zeta * sine, sqrt(x * x + across * across))
    to_x, to_w = _unit(x, across)
    for joint, (ahead, aside) in ((N - j - 1, proximal), (N - j, distal)):
        way = to_w * aside
        v = (to_x * aside, ahead * cosine - way * sine, ahead * sine + way * cosine)
        frame, bent = aim(arm, joint, v, frame, c)
        least = min(least, bent)
    _, bent = aim(arm, N - 1, (0.0, 1.0, 0.0), frame, c)
    return j, min(least, bent)


@inner
def from_first_joint(arm: Arm, target: Array) -> Vector:
    """A_N (10) that puts the tip on the target, from A_1 in the base frame [m]."""
    T = arm.T_w_b
    x, y, z = target[0] - T[0, 3], target[1] - T[1, 3], target[2] - T[2, 3]
    return (
        T[0, 0] * x + T[1, 0] * y + T[2, 0] * z,
        T[0, 1] * x + T[1, 1] * y + T[2, 1] * z - arm.first - arm.last,
        T[0, 2] * x + T[1, 2] * y + T[2, 2] * z,
    )


@inner
def _to_world(arm: Arm, x: float, h: float, z: float, target: Array) -> None:
    T, y = arm.T_w_b, h + arm.first + arm.last
    for i in range(3):
        target[i] = T[i, 3] + T[i, 0] * x + T[i, 1] * y + T[i, 2] * z


@inner
def _nearest_in_plane(x: float, h: float, z: float, reach: float) -> Vector:
    """The nearest point of the disc in the plane of A_N, or in the nearest that has a disc."""
    h = min(max(h, -reach), reach)
    away, radius = hypot(x, z), sqrt((reach - h) * (reach + h))
    if away > radius:
        x, z = x * (radius / away), z * (radius / away)
    return x, h, z


@inner
def _fewest_links(N: int, rho: float, x: float, zeta: float) -> tuple[int, float]:
    """Fewest links j = N - k >= 2 that reach A_N (11), and their slack [m^2]."""
    needed, step = x * x + zeta * zeta, -2.0 * rho * zeta
    j = 2
    while j < N - 1 and j * step < needed:
        j += 1
    return j, max(j * step - needed, 0.0)


@inner
def _fold(
    L: float, j: int, slack: float, along: float, across: float
) -> tuple[tuple[float, float], tuple[float, float]]:
    """Directions of link k and of links k+1 to N-1 in the plane (12), nearer to A_k+1,r.

    Arguments:
        along, across: the way from A_k to A_N [m]
    """
    square, size = along * along + across * across, 2.0 * L * sqrt(j - 1)
    sine_half = sqrt(slack) / size
    cosine_half = sqrt(max(square - ((j - 2) * L) ** 2, 0.0)) / size
    cosine = cosine_half * cosine_half - sine_half * sine_half
    sine = 2.0 * sine_half * cosine_half
    u, v = 1.0, 0.0  # link k, on its reference place if A_N is on A_k
    if square > 0.0:
        # A_N seen along link k. Turned back by its angle, link k is on the side of A_k+1,r.
        s, t = L * (2.0 * cosine_half * cosine_half + (j - 2) * cosine), L * (j - 1) * sine
        u, v = (along * s + across * t) / square, (across * s - along * t) / square
    return (u, v), (u * cosine - v * sine, v * cosine + u * sine)


@inner
def _unit(a: float, b: float) -> tuple[float, float]:
    """The direction of (a, b); that of the first axis if it has none."""
    size = sqrt(a * a + b * b)
    return (a / size, b / size) if size > 0.0 else (1.0, 0.0)


@inner
def straighten(arm: Arm, c: Array) -> None:
    """All joints straight."""
    c[:] = 0.0
    for i in range(c.size - 2 * arm.lean.size):
        c[i] = arm.insertion


@inner
def _tilt(arm: Arm, cosine: float, sine: float, c: Array) -> Frame:
    """Bend joint 1 by chi, as in the reference pose: theta_1 = 0 and phi_1 = chi."""
    column = c.size - 2 * arm.lean.size
    c[column + (1 if arm.lean[0] == 0 else 0)] = _angle(cosine, sine)
    return (1.0, 0.0, 0.0), (0.0, cosine, sine), (0.0, -sine, cosine)


@inner
def aim(arm: Arm, joint: int, v: Vector, frame: Frame, c: Array) -> tuple[Frame, float]:
    """Angles of a joint whose link shall point along the unit vector v (14), (15).

    The direction in the frame of the link before, d = R' v, decides (notes A3): for Z then X,
    theta = atan2(-d_x, d_y) and phi = asin(d_z).

    Returns:
        the frame of the link, and the cosine of the bend
    """
    x, y, z = frame
    column = c.size - 2 * (arm.lean.size - joint)
    if arm.lean[joint] == 0:
        c[column], c[column + 1], y, x, z, cosine = _lean_twice(-1.0, v, y, x, z)
    else:
        c[column], c[column + 1], y, z, x, cosine = _lean_twice(1.0, v, y, z, x)
    return (x, y, z), cosine


@inner
def _lean_twice(
    sign: float, v: Vector, y: Vector, first: Vector, second: Vector
) -> tuple[float, float, Vector, Vector, Vector, float]:
    """Lean y onto v: by an angle towards sign * first, then by one towards -sign * second."""
    ahead, a, b = _dot(v, y), sign * _dot(v, first), -sign * _dot(v, second)
    level = sqrt(ahead * ahead + a * a)
    cosine, sine = (ahead / level, a / level) if level > 0.0 else (1.0, 0.0)
    y, first = _lean(y, first, cosine, sign * sine)
    y, second = _lean(y, second, level, -sign * b)
    return _angle(cosine, sine), _angle(level, b), y, first, second, ahead


@inner
def _angle(cosine: float, sine: float) -> float:
    # asin takes a third of the time, and is as exact where its slope is small.
    return asin(sine) if cosine > 0.5 else atan2(sine, cosine)


@inner
def _lean(y: Vector, to: Vector, cosine: float, sine: float) -> tuple[Vector, Vector]:
    leant = (
        cosine * y[0] + sine * to[0],
        cosine * y[1] + sine * to[1],
        cosine * y[2] + sine * to[2],
    )
    turned = (
        cosine * to[0] - sine * y[0],
        cosine * to[1] - sine * y[1],
        cosine * to[2] - sine * y[2],
    )
    return leant, turned


@inner
def _dot(u: Vector, v: Vector) -> float:
    return u[0] * v[0] + u[1] * v[1] + u[2] * v[2]
