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
    n0_star = np.asarray(n0_star, dtype=np.float64)
    theta_1, sin_1, inside = contact_angle(n0_star)
    N_s = (inside * sin_1 + theta_1) / np.pi
    N_b = np.where(np.abs(n0_star) <= 1.0, (sin_1 + inside * theta_1) / np.pi, np.maximum(n0_star, 0.0))
    return N_b[()], np.where(np.isnan(n0_star), np.nan, N_s)[()]


def normal_gradients(n0_star: npt.ArrayLike) -> tuple[FloatArray, FloatArray]:
    """Derivatives of N_b and N_s by n0_star: theta_1 / pi and 2 sin(theta_1) / pi.

    >>> normal_gradients(0.0)[0].item()
    0.5
    """
    theta_1, sin_1, _ = contact_angle(np.asarray(n0_star, dtype=np.float64))
    return theta_1 / np.pi, 2.0 * sin_1 / np.pi


def contact_angle(n0_star: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """theta_1 of (30), its sine, and n0_star clipped to [-1, 1]; accurate at both ends."""
    inside = np.clip(n0_star, -1.0, 1.0)
    closed, open_ = np.sqrt(1.0 + inside), np.sqrt(1.0 - inside)
    return 2.0 * np.arctan2(closed, open_), closed * open_, inside
