"""The limit of vanishing variation of the normal load, which the closed form can only approach."""

from __future__ import annotations

import numpy as np

from fcm.table.atlas import FloatArray


def vanishing_variation(delta: FloatArray, phi: FloatArray) -> FloatArray:
    r"""Limit of (F_b, F_s, F_c) / b_bar as b_bar -> 0 at fixed n0 / b = cos(delta), shape (3, ...).

    The load is so small that the contact slips whenever it is closed, f = sign(cos(theta)) n. The
    coefficients are integrals of nu + sin(theta + phi), nu = cos(delta), between the ends of contact and the
    turning points of the motion.

    Parameters
    ----------
    delta : ndarray
        pi minus half the contact duration, 0 (the onset of separation) to pi (fully open) [rad].
    phi : ndarray
        Phase in [0, pi], of the same shape [rad].

    Examples
    --------
    Half a cycle of contact, in phase with the motion (phi = 0): f = sign(cos) sin over 0 to pi.

    >>> vanishing_variation(np.array([np.pi / 2]), np.array([0.0])).round(6).tolist()
    [[0.0], [0.0], [0.31831]]
    """
    nu = np.cos(delta)
    opening = 1.5 * np.pi - delta - phi
    closing = opening - 2.0 * (np.pi - delta)
    turns = [np.clip(turn * np.pi, closing, opening) for turn in (-1.5, -0.5, 0.5, 1.5)]
    before, first, second, after = (_primitive(theta, nu, phi) for theta in turns)
    G: FloatArray = (2.0 * (second - first) - (after - before)) / np.pi
    return G


def _primitive(theta: FloatArray, nu: FloatArray, phi: FloatArray) -> FloatArray:
    """Antiderivatives of nu + sin(theta + phi) times 1/2, sin(theta) and cos(theta)."""
    mean = 0.5 * (nu * theta - np.cos(theta + phi))
    sine = -nu * np.cos(theta) + 0.5 * (theta * np.cos(phi) - 0.5 * np.sin(2.0 * theta + phi))
    cosine = nu * np.sin(theta) + 0.5 * (theta * np.sin(phi) - 0.5 * np.cos(2.0 * theta + phi))
    return np.stack((mean, sine, cosine))
