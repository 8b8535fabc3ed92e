"""The two sinusoids between which the slip motion is held (appendix, (A4), (A5), (A9)).

While the contact is closed, ``|f| <= n`` says that the slip motion w = u - f lies between

    lower(theta) = sin(theta) - n(theta) =  ell_1 cos(theta - theta_P) - n0_bar
    upper(theta) = sin(theta) + n(theta) = -ell_2 cos(theta - theta_N) + n0_bar

Positive slip is the lower limit pushing w up, so it ends at theta_P, where that limit is greatest;
negative slip is the upper limit pushing w down, and ends at theta_N.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]
BoolArray = npt.NDArray[np.bool_]

LARGEST = 1e300


class SlipLimits(NamedTuple):
    """Amplitudes and end angles of the two limits; every field has the shape of the arguments."""

    sin_phi: FloatArray
    cos_phi: FloatArray
    ell_1: FloatArray
    ell_2: FloatArray
    ell_1_excess: FloatArray  # ell_1 - b_bar, without the cancellation at large b_bar
    ell_2_excess: FloatArray  # ell_2 - b_bar
    sin_P: FloatArray  # of theta_P, the end of positive slip
    cos_P: FloatArray
    sin_N: FloatArray  # of theta_N, the end of negative slip
    cos_N: FloatArray


def slip_limits(b_bar: FloatArray, phi: FloatArray) -> SlipLimits:
    """Amplitudes ell_1, ell_2 of (A9) and the directions of theta_P, theta_N for every phi.

    theta_P = atan2(1 - b cos phi, -b sin phi) and theta_N = atan2(-(1 + b cos phi), -b sin phi) are the
    branch-free forms of (A4), (A5). Only their sines and cosines are needed. Where an amplitude
    vanishes (b = 1 at phi = 0 or pi) the limit is constant, and any angle serves.
    """
    sin_half, cos_half = np.sin(0.5 * phi), np.cos(0.5 * phi)
    sin_phi = 2.0 * sin_half * cos_half
    cos_phi = (cos_half - sin_half) * (cos_half + sin_half)
    # 1 -+ b cos(phi), written so that nothing cancels near b = 1 with phi near 0 or pi
    minus = (1.0 - b_bar) + 2.0 * b_bar * sin_half * sin_half
    plus = (1.0 - b_bar) + 2.0 * b_bar * cos_half * cos_half
    side = b_bar * sin_phi
    ell_1, ell_2 = np.hypot(minus, side), np.hypot(plus, side)
    twice = 2.0 * b_bar * cos_phi
    safe_1, safe_2 = np.where(ell_1 > 0.0, ell_1, 1.0), np.where(ell_2 > 0.0, ell_2, 1.0)
    return SlipLimits(
        sin_phi=sin_phi,
        cos_phi=cos_phi,
        ell_1=ell_1,
        ell_2=ell_2,
        ell_1_excess=(1.0 - twice) / (ell_1 + b_bar),
        ell_2_excess=(1.0 + twice) / (ell_2 + b_bar),
        sin_P=np.where(ell_1 > 0.0, minus / safe_1, 1.0),
        cos_P=-side / safe_1,
        sin_N=np.where(ell_2 > 0.0, -plus / safe_2, -1.0),
        cos_N=-side / safe_2,
    )


def within_range(n0_bar: FloatArray, b_bar: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Preload and load variation, neither so large that a sum of a few of them overflows.

    Above LARGEST only the ratio n0_bar / b_bar matters: the spacing of float64 is far more than 1 there.
    A larger preload or gap, infinite included, is stuck or open like any other.
    """
    shrink = np.where(b_bar > LARGEST, 2.0**-32, 1.0)
    return np.clip(n0_bar * shrink, -1e4 * LARGEST, 1e4 * LARGEST), b_bar * shrink


def angle_from(sin_0: FloatArray, cos_0: FloatArray, sin_1: FloatArray, cos_1: FloatArray) -> FloatArray:
    """Angle from direction 0 forward to direction 1, in [0, 2 pi) [rad]."""
    turn = np.arctan2(sin_1 * cos_0 - cos_1 * sin_0, cos_1 * cos_0 + sin_1 * sin_0)
    return np.where(turn < 0.0, turn + 2.0 * np.pi, turn)
