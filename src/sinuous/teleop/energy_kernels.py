"""The arithmetic of passivity control, limits and links on vectors of A axes, compiled.

As in `kernels`, everything is written to arrays that the caller makes.
"""

import numpy as np

from sinuous.arrays import Array
from sinuous.compiled import inner
from sinuous.teleop.kernels import times, work


@inner
def wave_energy(factor: float, wave: Array) -> float:
    """Of a wave that is used for a tick [J]."""
    total = 0.0
    for i in range(wave.size):
        total += wave[i] * wave[i]
    return factor * total


@inner
def limit_wave(factor: float, wave: Array, heard: float, used: float, out: Array) -> None:
    """A wave as it is, or as much of it as the energy left is enough for."""
    energy = wave_energy(factor, wave)
    # The sum is the sender's own: without loss both are equal to the last digit.
    enough = used + energy <= heard or energy == 0.0
    scale = 1.0 if enough else np.sqrt(max(heard - used, 0.0) / energy)
    for i in range(wave.size):
        out[i] = scale * wave[i]


@inner
def limit_motion(F: Array, v: Array, spare: float, dt: float, out: Array) -> None:
    """The velocity nearest to v that takes no more than the energy left: v - beta F."""
    too_much, square = -spare / dt, 0.0
    for i in range(F.size):
        too_much += F[i] * v[i]
        square += F[i] * F[i]
    beta = too_much / square if too_much > 0.0 and square > 0.0 else 0.0
    for i in range(F.size):
        out[i] = v[i] - beta * F[i]


@inner
def left(F: Array, v: Array, spare: float, dt: float) -> float:
    """The share of a force that stays when it moves whom it pushes, see `position_force`."""
    given = -dt * work(F, v)
    if given <= 0.0:
        return 1.0
    return max(1.0 - 0.25 * given / spare, 0.0) if spare > 0.0 else 0.0


@inner
def kept(
    mass: float, dt: float, v: Array, F_h: Array,
    force: Array, damping: Array, spare: float, scale: Array,
) -> float:  # fmt: skip
    """The share h = 1 - a / (4 spare) of a force that stays, with the a of the device's own tick.

    A force h F gives out a = a_1 - (1 - h) y, with a_1 of the whole force and y of how the device
    yields to it.
    """
    whole, gives = 0.0, 0.0
    for i in range(v.size):
        inertia = mass + dt * damping[i]
        weight = dt * force[i] * scale[i] / inertia
        whole -= weight * (mass * v[i] + dt * (F_h[i] - force[i]))
        gives += weight * dt * force[i]
    if whole <= 0.0:
        return 1.0
    return max(1.0 - whole / (4.0 * spare + gives), 0.0)


@inner
def capped(size: float, wanted: Array, out: Array) -> None:
    """A vector, at most that long."""
    square = work(wanted, wanted)
    times(size / np.sqrt(square) if square > size * size else 1.0, wanted, out)


@inner
def limit_signal(size: float, slew: float, wanted: Array, before: Array, out: Array) -> None:
    """The signal nearest to what is wanted, of a size and a change from before within limits."""
    capped(size, wanted, out)
    for i in range(out.size):
        out[i] -= before[i]
    capped(slew, out, out)
    for i in range(out.size):
        out[i] += before[i]
