"""The scattering matrix (29) and its norm, which is at most one for a passive channel (28)."""

import numpy as np

from sinuous.arrays import Array, ArrayLike
from sinuous.teleop.analysis.hybrid import ComplexArray, hybrid_matrix


def scattering_matrix(H: ComplexArray) -> ComplexArray:
    """S = diag(1, -1) (H - I) (H + I)^-1 (..., 2, 2) (29)."""
    one = np.eye(2)
    return np.diag([1.0, -1.0]) @ (H - one) @ np.linalg.inv(H + one)


def scattering_norm(H: ComplexArray) -> Array:
    """|S| (...), the largest singular value."""
    values = np.linalg.svd(scattering_matrix(H), compute_uv=False)
    return np.asarray(values[..., 0], dtype=np.float64)


def largest_norms(
    omega: ArrayLike,
    *,
    gains: ArrayLike,
    impedances: ArrayLike,
    cutoffs: ArrayLike,
    delays: ArrayLike,
) -> Array:
    """Largest |S| over frequency (K, B, L, T), for all combinations: where it is above 1 is active.

    Arguments:
        omega: frequencies to look at [rad/s] (W,)
        gains: K (K,)
        impedances: b [N s/m] (B,)
        cutoffs: lambda [rad/s] (L,)
        delays: T, one way [s] (T,)
    """
    K, b, cutoff, T = (
        np.atleast_1d(np.asarray(v, dtype=np.float64)) for v in (gains, impedances, cutoffs, delays)
    )
    out = np.empty((K.size, b.size, cutoff.size, T.size))
    for at in np.ndindex(out.shape):
        i, j, k, m = at
        H = hybrid_matrix(omega, gain=K[i], impedance=b[j], cutoff=cutoff[k], delay=T[m])
        out[at] = np.max(scattering_norm(H))
    return out
