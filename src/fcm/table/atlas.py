r"""The atlas: coordinates in which the Fourier coefficients are smooth, on the whole domain.

The domain n0_bar in R, b_bar >= 0, phi in R is folded to phi in [0, pi] (phi -> phi + pi changes the sign of
F_b alone) and cut where the behaviour changes. Fully open and never slipping need no table. The two other
regimes have one *chart* each, a cube (u, x, z) in [0, 1]^3 with a smooth function G on it:

    separation |n0| < b       F = beta G,       beta = b / (1 + b)        u from delta = arccos(n0 / b)
    slip       b <= n0 < b+E  F = F_edge + E G, E = (ell_1 + ell_2)/2 - b  u from t = (n0 - b) / E

F_edge = ((ell_2 - ell_1)/2, 1, 0) are the coefficients at the slip limit n0 = b + E of (25). The factors take out
what vanishes, so that derivatives stay bounded however thin a regime becomes; that F has a continuous gradient
across n0 = -b, b and b + E says that dG/du = 0 there. Where F is not smooth the coordinates gather and turn:

* b -> 0 and b -> infinity, expansions in sqrt(b) and 1/b: s = 4/pi arctan(sqrt(b)) - 1;
* b = 1 with phi = 0 or pi, where ell_1 or ell_2 vanishes and F is a cone in (b - 1, sin(phi)): x turns from s to
  its square root there, over a width proportional to sin(phi); z gathers near 0 and pi;
* b -> infinity with n0 -> b, a cone in (1/b, delta): u turns from delta to its square root over a width 1/(1 + b).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

FOLD_Z = 1.55  # z gathers near phi = 0, pi: 2 phi / pi - 1 = sin(FOLD_Z (2 z - 1)) / sin(FOLD_Z)
FOLD_U = 1.2  # the same towards theta_1 = 0
CONE = 0.25  # (width of the cone at b = 1)^2 is CONE (sin(phi)^2 + TIP)
TIP = 1e-8
LARGEST_B = 1e8  # beyond, G has reached its limit
HUGE_B = 1e150  # beyond, ell_1 and ell_2 would overflow
NEAR = 1e-14  # a u this close to its end is moved away, so that dG/du over the vanishing slope is defined


class Geometry(NamedTuple):
    """Amplitudes of (A9) less b, the width of the slip regime, with their derivatives by b and phi."""

    low: FloatArray  # ell_1 - b
    high: FloatArray  # ell_2 - b
    width: FloatArray  # E = (ell_1 + ell_2) / 2 - b, without cancellation
    ell_1_b: FloatArray
    ell_1_phi: FloatArray
    ell_2_b: FloatArray
    ell_2_phi: FloatArray


class Phase(NamedTuple):
    """phi in [0, pi] with what is needed of it."""

    phi: FloatArray
    sin_half: FloatArray
    cos_half: FloatArray
    sin: FloatArray
    cos: FloatArray

    @classmethod
    def of(cls, phi: FloatArray) -> Phase:
        sin_half, cos_half = np.sin(0.5 * phi), np.cos(0.5 * phi)
        return cls(
            phi,
            sin_half,
            cos_half,
            2.0 * sin_half * cos_half,
            (cos_half - sin_half) * (cos_half + sin_half),
        )


def fold(phi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """phi modulo pi in [0, pi], and the sign that F_b takes with it."""
    turns = np.floor(phi / np.pi)
    return np.minimum(np.maximum(phi - turns * np.pi, 0.0), np.pi), 1.0 - 2.0 * np.mod(turns, 2.0)


def geometry(b_bar: FloatArray, phase: Phase) -> Geometry:
    """ell_1, ell_2 of (A9) and the width E of the slip regime; relative accuracy kept where E is small."""
    b = np.minimum(b_bar, HUGE_B)
    gap, root = b - 1.0, 2.0 * np.sqrt(b)
    ell_1, ell_2 = np.hypot(gap, root * phase.sin_half), np.hypot(gap, root * phase.cos_half)
    product, twice, side = ell_1 * ell_2, 2.0 * b * phase.cos, b * phase.sin
    square = np.abs(gap) * (b + 1.0)
    total = product + square
    # ell_1 ell_2 + 1 - b^2, for b > 1 as a quotient
    part = np.where(gap > 0.0, 4.0 * side * side / np.where(total > 0.0, total, 1.0), total)
    safe_1, safe_2 = np.where(ell_1 > 0.0, ell_1, 1.0), np.where(ell_2 > 0.0, ell_2, 1.0)
    return Geometry(
        low=(1.0 - twice) / (ell_1 + b),
        high=(1.0 + twice) / (ell_2 + b),
        width=part / (ell_1 + ell_2 + 2.0 * b),
        ell_1_b=(b - phase.cos) / safe_1,
        ell_1_phi=side / safe_1,
        ell_2_b=(b + phase.cos) / safe_2,
        ell_2_phi=-side / safe_2,
    )


def u_separation(delta: FloatArray, b_bar: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """u of the separation chart, 0 at n0 = b and 1 at n0 = -b, and its derivatives by delta and b."""
    layer = 1.0 / (1.0 + b_bar)
    near, far = 1.0 / (delta + layer), 1.0 / (np.pi + layer)
    ratio = np.sqrt(near / far) * (np.sin(FOLD_U) / np.pi)
    sine = np.minimum(delta * ratio, np.sin(FOLD_U))
    slope = 1.0 / (FOLD_U * np.sqrt(1.0 - sine * sine))
    by_delta = slope * ratio * (1.0 - 0.5 * delta * near)
    by_b = slope * sine * 0.5 * (near - far) * layer * layer
    return np.arcsin(sine) / FOLD_U, by_delta, by_b


def delta_separation(u: FloatArray, b_bar: FloatArray) -> FloatArray:
    """Inverse of `u_separation`."""
    layer = 1.0 / (1.0 + b_bar)
    scaled = (np.pi * np.sin(FOLD_U * u) / np.sin(FOLD_U)) ** 2 / (np.pi + layer)
    return np.minimum(0.5 * (scaled + np.sqrt(scaled * (scaled + 4.0 * layer))), np.pi)


def u_slip(t: FloatArray) -> tuple[FloatArray, FloatArray]:
    """u of the slip chart, t = sin(pi u / 2)^2, and du/dt; t strictly inside (0, 1)."""
    root, rest = np.sqrt(t), np.sqrt(1.0 - t)
    return np.arctan2(root, rest) * (2.0 / np.pi), 1.0 / (np.pi * root * rest)


def t_slip(u: FloatArray) -> FloatArray:
    """Inverse of `u_slip`."""
    t: FloatArray = np.sin(0.5 * np.pi * u) ** 2
    return t


def x_variation(b_bar: FloatArray, phase: Phase) -> tuple[FloatArray, FloatArray, FloatArray]:
    """x, 0 at b = 0 and 1 at infinity, with sqrt(b) dx/db (finite at 0) and dx/dphi."""
    root = np.sqrt(np.minimum(b_bar, LARGEST_B))
    s = np.arctan(root) * (4.0 / np.pi) - 1.0
    cone = CONE * (phase.sin * phase.sin + TIP)
    square = s * s
    inverse = 1.0 / (square + cone)
    half = 0.5 * np.sqrt(np.sqrt((1.0 + cone) * inverse))
    x = s * half + 0.5
    by_s = half * (1.0 - 0.5 * square * inverse)
    by_cone = 0.25 * s * half * (1.0 / (1.0 + cone) - inverse)
    return x, by_s * (2.0 / np.pi) / (1.0 + root * root), by_cone * (2.0 * CONE) * phase.sin * phase.cos


def b_variation(x: FloatArray, phi: FloatArray) -> FloatArray:
    """Inverse of `x_variation`, infinity replaced by LARGEST_B."""
    w = 2.0 * x - 1.0
    cone = CONE * (np.sin(phi) ** 2 + TIP)
    fourth = w**4 / (1.0 + cone)
    square = np.minimum(0.5 * (fourth + np.sqrt(fourth * (fourth + 4.0 * cone))), 1.0)
    s = np.sign(w) * np.sqrt(square)
    limit = 4.0 / np.pi * np.arctan(np.sqrt(LARGEST_B)) - 1.0
    return np.tan(0.25 * np.pi * (np.minimum(s, limit) + 1.0)) ** 2


def z_phase(phi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """z in [0, 1] and dz/dphi."""
    sine = (phi * (2.0 / np.pi) - 1.0) * np.sin(FOLD_Z)
    return np.arcsin(sine) * (0.5 / FOLD_Z) + 0.5, (np.sin(FOLD_Z) / (np.pi * FOLD_Z)) / np.sqrt(
        1.0 - sine * sine
    )


def phi_phase(z: FloatArray) -> FloatArray:
    """Inverse of `z_phase`."""
    phi = 0.5 * np.pi * (1.0 + np.sin(FOLD_Z * (2.0 * z - 1.0)) / np.sin(FOLD_Z))
    return np.clip(phi, 0.0, np.pi)
