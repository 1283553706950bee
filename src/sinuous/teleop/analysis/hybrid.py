"""Hybrid matrices of channels over frequency (30), (31).

    (F_m, -v_sd) = H (v_m, F_s),

so that the power that the channel takes in, F_m v_m - F_s v_sd, is a form of H + H^H. All numbers
may be arrays and are broadcast; a matrix is (..., 2, 2).
"""

import numpy as np
from numpy.typing import NDArray

from sinuous.arrays import Array, ArrayLike

ComplexArray = NDArray[np.complex128]


def low_pass(omega: ArrayLike, cutoff: ArrayLike) -> ComplexArray:
    """Phi = lambda / (j omega + lambda) (...); 1 for an infinite cutoff.

    Arguments:
        omega, cutoff: [rad/s]
    """
    ratio = np.asarray(omega, dtype=np.float64) / np.asarray(cutoff, dtype=np.float64)
    return np.asarray(1.0 / (1.0 + 1j * ratio), dtype=np.complex128)


def hybrid_matrix(
    omega: ArrayLike,
    *,
    gain: ArrayLike,
    impedance: ArrayLike,
    cutoff: ArrayLike,
    delay: ArrayLike,
) -> ComplexArray:
    """H (..., 2, 2) of the paper's waves (31).

    Arguments:
        omega: [rad/s]
        gain: K
        impedance: b [N s/m]
        cutoff: lambda [rad/s], infinite for no low-pass
        delay: T, one way [s]
    """
    w, b = np.asarray(omega, dtype=np.float64), np.asarray(impedance, dtype=np.float64)
    late, phi = np.exp(-1j * w * np.asarray(delay, dtype=np.float64)), low_pass(w, cutoff)
    return _matrix(
        np.asarray(gain, dtype=np.float64) * b, late, -late * phi, (1.0 - late**2 * phi) / b
    )


def standard_hybrid_matrix(
    omega: ArrayLike, *, impedance: ArrayLike, delay: ArrayLike
) -> ComplexArray:
    """H (..., 2, 2) of standard waves: a line without loss; infinite where cos(omega T) = 0.

    Arguments:
        omega: [rad/s]
        impedance: b [N s/m]
        delay: T, one way [s]
    """
    angle = np.asarray(omega, dtype=np.float64) * np.asarray(delay, dtype=np.float64)
    b, secant = np.asarray(impedance, dtype=np.float64), 1.0 / np.cos(angle)
    return _matrix(1j * b * np.tan(angle), secant, -secant, 1j * np.tan(angle) / b)


def _matrix(h11: ArrayLike, h12: ArrayLike, h21: ArrayLike, h22: ArrayLike) -> ComplexArray:
    entries = np.broadcast_arrays(h11, h12, h21, h22)
    lead = np.stack([np.asarray(entry, dtype=np.complex128) for entry in entries], axis=-1)
    return lead.reshape(*lead.shape[:-1], 2, 2)


def dissipation(H: ComplexArray) -> tuple[Array, ComplexArray]:
    """Eigenvalues (..., 2), the least first, and eigenvectors (..., 2, 2) of H + H^H.

    A sinusoid whose complex amplitudes (v_m, F_s) are an eigenvector with eigenvalue e takes
    e / 4 times its squared length in, on average [W]; a passive channel has none below zero.
    """
    values, vectors = np.linalg.eigh(H + np.conj(np.swapaxes(H, -1, -2)))
    return values, vectors
