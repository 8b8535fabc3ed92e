"""Fourier coefficients of the variable normal load, equations (28) to (31)."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.contact.limits import FloatArray


def normal_coefficients(n0_star: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    r"""Mean and fundamental of the normal load over a cycle of v = b sin(theta).

    n = k_v b max(n0_star + sin(theta), 0) ~ k_v b (N_b + N_s sin(theta)), equation (29), with

        N_b = (sin(theta_1) + n0_star theta_1) / pi        (30)
        N_s = (n0_star sin(theta_1) + theta_1) / pi        (31)

    and theta_1 = arccos(-n0_star); fully open (0, 0) below -1, never open (n0_star, 1) above 1.

    Parameters
    ----------
    n0_star : array_like, any shape
        Preload or gap n_0 / (k_v b) [-], any real number; NaN gives NaN.

    Returns
    -------
    N_b, N_s : ndarray, the shape of n0_star
        Dimensionless coefficients [-], absolute error below 1e-15 (relative for |n0_star| > 1).

    Examples
    --------
    >>> N_b, N_s = normal_coefficients([-2.0, 0.0, 3.0])
    >>> N_b.round(6).tolist(), N_s.tolist()
    ([0.0, 0.31831, 3.0], [0.0, 0.5, 1.0])
    """
    N_b, N_s, _, _ = _numbers(n0_star)
    return N_b, N_s


def normal_gradients(n0_star: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Derivatives of N_b and N_s by n0_star: theta_1 / pi and 2 sin(theta_1) / pi.

    >>> normal_gradients(0.0)[0].item()
    0.5
    """
    _, _, dN_b, dN_s = _numbers(n0_star)
    return dN_b, dN_s


def _numbers(n0_star: npt.ArrayLike) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
    """N_b, N_s, equations (30) and (31), and their derivatives by n0_star, each of its shape."""
    at = np.asarray(n0_star, dtype=np.float64)
    inside = np.clip(at, -1.0, 1.0)
    # 1 +- n0_star are exact where they are small, and carry theta_1 to full accuracy at both ends
    closed, open_ = np.sqrt(1.0 + inside), np.sqrt(1.0 - inside)
    theta_1 = 2.0 * np.arctan2(closed, open_)
    sin_1 = closed * open_
    N_b = np.where(np.abs(at) > 1.0, np.maximum(at, 0.0), (sin_1 + inside * theta_1) / np.pi)
    return N_b, (inside * sin_1 + theta_1) / np.pi, theta_1 / np.pi, 2.0 * sin_1 / np.pi
