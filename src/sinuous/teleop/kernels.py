"""The arithmetic of one tick on vectors of A axes, compiled.

On two or three numbers an operation of numpy takes a hundred times as long as the arithmetic. The
kernels write to arrays that the caller makes, and allocate nothing.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner


@inner
def finite(a: Array, b: Array, c: Array) -> bool:
    """Whether three vectors are finite."""
    total = 0.0
    for i in range(a.size):
        total += 0.0 * a[i] + 0.0 * b[i] + 0.0 * c[i]
    return total == 0.0


@inner
def work(F: Array, s: Array) -> float:
    """F . s."""
    total = 0.0
    for i in range(F.size):
        total += F[i] * s[i]
    return total


@inner
def times(a: float, x: Array, out: Array) -> None:
    """a x."""
    for i in range(x.size):
        out[i] = a * x[i]


@inner
def sound(wave: Array, position: Array, energy: float) -> bool:
    """Whether what a packet says is finite, and its energy not negative."""
    total = 0.0 * energy
    for i in range(wave.size):
        total += 0.0 * wave[i] + 0.0 * position[i]
    return total == 0.0 and energy >= 0.0


@inner
def modified_leader(
    gain: float, b: float, share: float, before: Array, v: Array, received: Array,
    force: Array, sent: Array,
) -> None:  # fmt: skip
    """(16) and (19): the force, and what the low-pass becomes and is sent as a wave.

    Arguments:
        share: of the way to its input that the low-pass goes in a tick, lambda dt
        before: the wave that was sent in the tick before, g / K (A,)
    """
    for i in range(before.size):
        F_r, g = gain * received[i], gain * before[i]
        force[i] = F_r + gain * b * v[i]
        sent[i] = (g + share * (b * v[i] + F_r - g)) / gain


@inner
def modified_follower(
    gain: float, b: float, F: Array, received: Array, desired: Array, sent: Array
) -> None:
    """(18) and (17): desired velocity and wave to send."""
    for i in range(F.size):
        desired[i] = (gain * received[i] - F[i]) / b
        sent[i] = F[i] / gain


@inner
def modified_loss(gain: float, b: float, F: Array, received: Array) -> float:
    """|F_s - g_r|^2 / 2b."""
    total = 0.0
    for i in range(F.size):
        apart = F[i] - gain * received[i]
        total += apart * apart
    return 0.5 * total / b


@inner
def standard_leader(b: float, v: Array, received: Array, force: Array, sent: Array) -> None:
    """Force and wave to send."""
    root = np.sqrt(2.0 * b)
    for i in range(v.size):
        force[i] = b * v[i] - root * received[i]
        sent[i] = root * v[i] - received[i]


@inner
def standard_follower(b: float, F: Array, received: Array, desired: Array, sent: Array) -> None:
    """Desired velocity and wave to send."""
    root = np.sqrt(2.0 * b)
    for i in range(F.size):
        desired[i] = (root * received[i] - F[i]) / b
        sent[i] = received[i] - root / b * F[i]


@inner
def move_device(
    mass: float, dt: float, limit: float, x: Array, v: Array, F_h: Array,
    force: Array, damping: Array, place: Array, speed: Array,
) -> None:  # fmt: skip
    """(27) by implicit Euler against a load force + damping v, and a stop on either side."""
    for i in range(x.size):
        momentum = mass * v[i] + dt * (F_h[i] - force[i])
        speed[i] = momentum / (mass + dt * damping[i])
        place[i] = x[i] + dt * speed[i]
        if abs(place[i]) > max(limit, abs(x[i])):  # farther beyond the stop than it was
            place[i] = max(min(place[i], max(x[i], limit)), min(x[i], -limit))
            speed[i] = (place[i] - x[i]) / dt


@inner
def on_wave_side(scale: Array, x: Array, v: Array, X: Array, V: Array) -> None:
    """Position and velocity of the device on the wave side."""
    for i in range(x.size):
        X[i] = scale[i] * x[i]
        V[i] = scale[i] * v[i]


@inner
def drive(
    mass: float, dt: float, speed: Array, v: Array, force: Array, damping: Array, F_h: Array
) -> None:
    """(27) the other way round: the force that takes the device from v to a speed in a tick."""
    for i in range(v.size):
        F_h[i] = force[i] + damping[i] * speed[i] + mass / dt * (speed[i] - v[i])


@inner
def least_jerk(share: float, dt: float, start: Array, stop: Array, x: Array, speed: Array) -> None:
    """The speed that in a tick takes x to a share of the time of a move of least jerk."""
    way = share**3 * (10.0 - 15.0 * share + 6.0 * share**2)
    for i in range(x.size):
        speed[i] = (start[i] + way * (stop[i] - start[i]) - x[i]) / dt


@inner
def apart(a: Array, b: Array) -> float:
    """Largest |a - b| of any axis."""
    most = 0.0
    for i in range(a.size):
        most = max(most, abs(a[i] - b[i]))
    return most


@inner
def spring_damper(
    stiffness: float, damping: float, goal: Array, x: Array, v: Array, out: Array
) -> None:
    """The force (A,) of a spring to a goal and a damper."""
    for i in range(x.size):
        out[i] = stiffness * (goal[i] - x[i]) - damping * v[i]


@inner
def place(axes: Array, origin: Array, x: Array, out: Array) -> None:
    """The point (3,) of coordinates x (A,) along axes (3, A)."""
    for i in range(3):
        total = origin[i]
        for a in range(x.size):
            total += axes[i, a] * x[a]
        out[i] = total


@inner
def project(axes: Array, origin: Array, p: Array, out: Array) -> None:
    """The coordinates (A,) of a point p (3,) along axes (3, A)."""
    for a in range(out.size):
        out[a] = 0.0
        for i in range(3):
            out[a] += axes[i, a] * (p[i] - origin[i])


@inner
def error_per_axis(gain: float, length: float, desired: Array, actual: Array, out: Array) -> None:
    """(24), resistive: k_f (1/2 - 1/(1 + exp(e/s))) = k_f/2 tanh(e/2s) for every axis."""
    for i in range(out.size):
        out[i] = 0.5 * gain * np.tanh(0.5 * (desired[i] - actual[i]) / length)


@inner
def error_along(gain: float, length: float, desired: Array, actual: Array, out: Array) -> None:
    """(24), resistive, along the error vector: k_f/2 tanh(|e|/2s) e/|e|."""
    size = 0.0
    for i in range(out.size):
        out[i] = desired[i] - actual[i]
        size += out[i] * out[i]
    size = np.sqrt(size)
    # tanh(a) / a goes to 1 at no error.
    a = 0.5 * size / length
    pull = 0.25 * gain / length * (np.tanh(a) / a if a > 0.0 else 1.0)
    for i in range(out.size):
        out[i] *= pull


@inner
def box(
    low: Array, high: Array, stiffness: float, damping: float, x: Array, v: Array, out: Array
) -> None:
    """(25), resistive, on every side; never towards the wall."""
    for i in range(out.size):
        if x[i] >= high[i]:
            out[i] = max(stiffness * (x[i] - high[i]) + damping * v[i], 0.0)
        elif x[i] <= low[i]:
            out[i] = min(stiffness * (x[i] - low[i]) + damping * v[i], 0.0)
        else:
            out[i] = 0.0


@inner
def printed_box(
    low: Array, high: Array, stiffness: float, damping: float, x: Array, v: Array, out: Array
) -> None:
    """(25) as printed, N pointing inward, added to what out (A,) holds."""
    for i in range(out.size):
        if x[i] >= high[i]:
            out[i] += stiffness * (high[i] - x[i]) - damping * v[i]
        elif x[i] <= low[i]:
            out[i] += stiffness * (low[i] - x[i]) + damping * v[i]


@inner
def wall(axes: Array, way: Array, stiffness: float, damping: float, v: Array, out: Array) -> None:
    """(25), resistive, of walls that the way (3,) [m] leads out of, felt along axes (3, A)."""
    depth, outward = np.sqrt(way[0] ** 2 + way[1] ** 2 + way[2] ** 2), 0.0
    for a in range(out.size):
        out[a] = 0.0
        if depth > 0.0:
            for i in range(3):
                out[a] -= axes[i, a] * way[i] / depth
        outward += out[a] * v[a]
    push = max(stiffness * depth + damping * outward, 0.0)
    for a in range(out.size):
        out[a] *= push


@inner
def difference(a: Array, b: Array, dt: float, out: Array) -> None:
    """(a - b) / dt."""
    for i in range(out.size):
        out[i] = (a[i] - b[i]) / dt


@inner
def see(
    axes: Array, origin: Array, p: Array, before: Array, dt: float, X: Array, V: Array
) -> None:  # fmt: skip
    """The coordinates of a point along axes, and their change from before by time."""
    project(axes, origin, p, X)
    difference(X, before, dt, V)


@inner
def advance(x: Array, v: Array, dt: float, out: Array) -> None:
    """x + dt v."""
    for i in range(out.size):
        out[i] = x[i] + dt * v[i]


@inner
def advance_if_finite(
    x: Array, v: Array, dt: float, a: Array, b: Array, out: Array
) -> bool:  # fmt: skip
    """x + dt v, and whether it and two other vectors are finite."""
    advance(x, v, dt, out)
    return finite(out, a, b)
