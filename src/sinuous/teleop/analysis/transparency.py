"""What the operator feels of the environment through the channel.

Source: Lawrence, Stability and transparency in bilateral teleoperation, IEEE Trans. Robotics and
Automation 9 (1993).
"""

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from sinuous.teleop.analysis.hybrid import ComplexArray


def transmitted_impedance(H: ComplexArray, environment: ArrayLike) -> ComplexArray:
    """Z_t = F_m / v_m (...) [N s/m] with an environment F_s = Z_e v_sd at the other end.

    Z_t = H11 - H12 H21 Z_e / (1 + H22 Z_e). Transparent would be Z_t = Z_e.

    Arguments:
        H: hybrid matrices (..., 2, 2), see `hybrid`
        environment: Z_e (...) [N s/m]
    """
    Z = np.asarray(environment, dtype=np.complex128)
    h11, h12, h21, h22 = H[..., 0, 0], H[..., 0, 1], H[..., 1, 0], H[..., 1, 1]
    return h11 - h12 * h21 * Z / (1.0 + h22 * Z)


class ZWidth(NamedTuple):
    """Between which impedances an operator can tell environments apart (...) [N s/m].

    Arguments:
        free: Z_t with nothing at the other end
        clamped: Z_t with the other end held
    """

    free: ComplexArray
    clamped: ComplexArray


def z_width(H: ComplexArray) -> ZWidth:
    """Z_t of Z_e = 0 and of Z_e infinite: H11, and H11 - H12 H21 / H22."""
    h11, h12, h21, h22 = H[..., 0, 0], H[..., 0, 1], H[..., 1, 0], H[..., 1, 1]
    return ZWidth(free=h11, clamped=h11 - h12 * h21 / h22)
