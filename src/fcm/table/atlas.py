r"""The atlas: coordinates in which the Fourier coefficients are smooth, on the whole domain.

The domain n0_bar in R, b_bar >= 0, phi in R is folded to phi in [0, pi] (phi -> phi + pi changes the sign of
F_b alone) and cut where the behaviour changes. Fully open and never slipping need no table. The two other
regimes have one *chart* each, a cube (u, x, z) in [0, 1]^3 with a smooth function G on it:

    separation |n0| < b       F = beta G,       beta = b / (1 + b)        u from delta = arccos(n0 / b)
    slip       b <= n0 < b+E  F = F_edge + E G, E = (ell_1 + ell_2)/2 - b  u from t = (n0 - b) / E

F_edge = ((ell_2 - ell_1)/2, 1, 0) are the coefficients at the slip limit n0 = b + E of (25). The factors take
out what vanishes, so that derivatives stay bounded however thin a regime becomes; that F has a continuous
gradient across n0 = -b, b and b + E says that dG/du = 0 there. Where F is not smooth the coordinates gather
and turn:

* b -> 0 and b -> infinity, expansions in sqrt(b) and 1/b: s = 4/pi arctan(sqrt(b)) - 1;
* b = 1 with phi = 0 or pi, where ell_1 or ell_2 vanishes and F is a cone in (b - 1, sin(phi)): x turns from
  s to its cube root there, over a width proportional to sin(phi); z gathers near 0 and pi;
* b -> infinity with n0 -> b, a cone in (1/b, delta): u turns from delta to its square root over a width
  1/(1 + b).
"""

from __future__ import annotations

import math
from typing import Any, NamedTuple

import numpy as np
import numpy.typing as npt

FloatArray = npt.NDArray[np.float64]

FOLD_Z = 1.555  # z gathers near phi = 0, pi: 2 phi / pi - 1 = sin(FOLD_Z (2 z - 1)) / sin(FOLD_Z)
FOLD_U = 1.2  # the same towards theta_1 = 0
CONE = 0.1  # (width of the cone at b = 1)^2 is CONE (sin(phi)^2 + TIP)
TIP = 1e-8
LARGEST_B = 1e8  # beyond, G has reached its limit
HUGE_B = 1e150  # beyond, ell_1 and ell_2 would overflow
NEWTON_STEPS = 60  # the first ones gain a third only
NEAR = 1e-14  # a u this close to its end is moved away, so that dG/du over the vanishing slope is defined


class Phase(NamedTuple):
    """phi in [0, pi] with what is needed of it."""

    phi: FloatArray
    sin_half: FloatArray
    cos_half: FloatArray
    sin: FloatArray
    cos: FloatArray

    @classmethod
    def of(cls, phi: FloatArray) -> Phase:
        half = 0.5 * phi
        sin_half, cos_half = np.sin(half), np.cos(half)
        cos = (cos_half - sin_half) * (cos_half + sin_half)
        return cls(phi, sin_half, cos_half, np.sin(phi), cos)

    def at(self, chosen: Any) -> Phase:
        """Some of them."""
        return Phase(*(field[chosen] for field in self))


class Geometry(NamedTuple):
    """Amplitudes of (A9) and the width of the slip regime."""

    b: FloatArray  # at most HUGE_B
    ell_1: FloatArray
    ell_2: FloatArray
    low: FloatArray  # ell_1 - b
    high: FloatArray  # ell_2 - b
    width: FloatArray  # E = (ell_1 + ell_2) / 2 - b

    def slopes(self, phase: Phase) -> tuple[FloatArray, FloatArray, FloatArray, FloatArray]:
        """Derivatives of ell_1 and ell_2 by b, then by phi."""
        safe_1, safe_2 = np.maximum(self.ell_1, 1e-300), np.maximum(self.ell_2, 1e-300)
        side = self.b * phase.sin
        return (self.b - phase.cos) / safe_1, (self.b + phase.cos) / safe_2, side / safe_1, -side / safe_2


def fold(phi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """phi modulo pi in [0, pi], and the sign that F_b takes with it."""
    turn = np.remainder(phi, 2.0 * np.pi)
    upper = (turn >= np.pi).astype(np.float64)
    return turn - np.pi * upper, 1.0 - 2.0 * upper


def geometry(b_bar: FloatArray, phase: Phase) -> Geometry:
    """ell_1, ell_2 of (A9), and E with full relative accuracy however small it is."""
    b = np.minimum(b_bar, HUGE_B)
    gap, root = b - 1.0, 2.0 * np.sqrt(b)
    ell_1, ell_2 = np.hypot(gap, root * phase.sin_half), np.hypot(gap, root * phase.cos_half)
    twice, side = 2.0 * b * phase.cos, 2.0 * b * phase.sin
    sum_1, sum_2 = ell_1 + b, ell_2 + b
    # E (ell_1 + ell_2 + 2 b) = ell_1 ell_2 + 1 - b^2, for b > 1 as a quotient
    total = ell_1 * ell_2 + np.abs(gap) * (b + 1.0)
    part = np.where(gap > 0.0, side * side / np.maximum(total, 1e-300), total)
    return Geometry(b, ell_1, ell_2, (1.0 - twice) / sum_1, (1.0 + twice) / sum_2, part / (sum_1 + sum_2))


def u_separation(delta: FloatArray, b_bar: FloatArray) -> tuple[FloatArray, FloatArray, FloatArray]:
    """u of the separation chart, 0 at n0 = b and 1 at n0 = -b, and its derivatives by delta and b."""
    layer = 1.0 / (1.0 + b_bar)
    near, far = 1.0 / (delta + layer), 1.0 / (np.pi + layer)
    ratio = np.sqrt(near / far) * (math.sin(FOLD_U) / np.pi)
    sine = delta * ratio
    slope = 1.0 / (FOLD_U * np.sqrt(1.0 - sine * sine))
    by_delta = slope * ratio * (1.0 - 0.5 * delta * near)
    by_b = slope * sine * 0.5 * (near - far) * layer * layer
    return np.arcsin(sine) / FOLD_U, by_delta, by_b


def delta_separation(u: FloatArray, b_bar: FloatArray) -> FloatArray:
    """Inverse of `u_separation`."""
    layer = 1.0 / (1.0 + b_bar)
    scaled = (np.pi * np.sin(FOLD_U * u) / np.sin(FOLD_U)) ** 2 / (np.pi + layer)
    delta: FloatArray = np.minimum(0.5 * (scaled + np.sqrt(scaled * (scaled + 4.0 * layer))), np.pi)
    return delta


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
    inverse, other = 1.0 / (square + cone), 1.0 / (1.0 + cone)
    half = 0.5 * np.cbrt(inverse / other)
    moved = s * half
    by_s = half * (1.0 - square * inverse * (2.0 / 3.0)) * (2.0 / np.pi)
    by_cone = moved * (other - inverse) * (2.0 * CONE / 3.0)
    return moved + 0.5, by_s / (1.0 + root * root), by_cone * phase.sin * phase.cos


def b_variation(x: FloatArray, phi: FloatArray) -> FloatArray:
    """Inverse of `x_variation` by Newton's method, infinity replaced by LARGEST_B."""
    w = 2.0 * x - 1.0
    cone = CONE * (np.sin(phi) ** 2 + TIP)
    cube = np.abs(w) ** 3 / (1.0 + cone)  # |s|^3 = cube (s^2 + cone); convex above the root, so 1 is a start
    s = np.ones_like(cube)
    for _ in range(NEWTON_STEPS):
        s = s - ((s - cube) * s * s - cube * cone) / np.maximum((3.0 * s - 2.0 * cube) * s, 1e-300)
    limit = 4.0 / np.pi * np.arctan(np.sqrt(LARGEST_B)) - 1.0
    b: FloatArray = np.tan(0.25 * np.pi * (np.minimum(np.sign(w) * s, limit) + 1.0)) ** 2
    return b


def z_phase(phi: FloatArray) -> tuple[FloatArray, FloatArray]:
    """z in [0, 1] and dz/dphi."""
    height = math.sin(FOLD_Z)
    sine = phi * (2.0 * height / np.pi) - height
    slope = (height / (np.pi * FOLD_Z)) / np.sqrt(1.0 - sine * sine)
    return np.arcsin(sine) * (0.5 / FOLD_Z) + 0.5, slope


def phi_phase(z: FloatArray) -> FloatArray:
    """Inverse of `z_phase`."""
    phi = 0.5 * np.pi * (1.0 + np.sin(FOLD_Z * (2.0 * z - 1.0)) / np.sin(FOLD_Z))
    inside: FloatArray = np.clip(phi, 0.0, np.pi)
    return inside
