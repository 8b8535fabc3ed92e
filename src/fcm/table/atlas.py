r"""The atlas: coordinates in which the Fourier coefficients are smooth, on the whole domain.

The domain n0_bar in R, b_bar >= 0, phi in R is folded to phi in [0, pi] (phi -> phi + pi changes only the
sign of F_b), and cut where the behaviour changes. The regimes fully open and never slipping need no table.
The other two regimes have one *chart* each, a cube (u, x, z) in [0, 1]^3 with a smooth function G on it:

    separation |n0| < b       F = beta G,       beta = b / (1 + b)        u from delta = arccos(n0 / b)
    slip       b <= n0 < b+E  F = F_edge + E G, E = (ell_1 + ell_2)/2 - b  u from t = (n0 - b) / E

F_edge = ((ell_2 - ell_1)/2, 1, 0) are the coefficients at the slip limit n0 = b + E of (25). The factors
remove what vanishes, so that derivatives stay bounded however thin a regime becomes. F has a continuous
gradient across n0 = -b, b and b + E; so dG/du = 0 there. Where F is not smooth, the coordinates are graded:

* b -> 0 and b -> infinity, expansions in sqrt(b) and 1/b: s = 4/pi arctan(sqrt(b)) - 1;
* b = 1 with phi = 0 or pi, where ell_1 or ell_2 vanishes and F is a cone in (b - 1, sin(phi)): x turns from
  s to its cube root there, over a width proportional to sin(phi); z gathers near 0 and pi;
* b -> infinity with n0 -> b, a cone in (1/b, delta): u turns from delta to its square root over a width
  1/(1 + b).
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.table.constants import CONE, FOLD_U, FOLD_Z, LARGEST_B, TIP
from fcm.table.options import NODE_OPTIONS
from fcm.table.tabulated import slip_geometry

FloatArray = npt.NDArray[np.float64]


class Geometry(NamedTuple):
    """Amplitudes of (A9) less b, and the width of the slip regime."""

    low: FloatArray  # ell_1 - b
    high: FloatArray  # ell_2 - b
    width: FloatArray  # E = (ell_1 + ell_2) / 2 - b


def geometry(b_bar: FloatArray, phi: FloatArray) -> Geometry:
    """Slip geometry of points of one shape, with E to full relative accuracy however small it is."""
    return Geometry(*slip_geometry(b_bar.reshape(-1), phi.reshape(-1)).reshape(3, *b_bar.shape))


def delta_separation(u: FloatArray, b_bar: FloatArray) -> FloatArray:
    """Angle delta at coordinate u of the separation chart, where u = 0 is n0 = b and u = 1 is n0 = -b.

    It inverts the coordinate u of `AtlasPoint`.
    """
    layer = 1.0 / (1.0 + b_bar)
    scaled = (np.pi * np.sin(FOLD_U * u) / np.sin(FOLD_U)) ** 2 / (np.pi + layer)
    delta: FloatArray = np.minimum(0.5 * (scaled + np.sqrt(scaled * (scaled + 4.0 * layer))), np.pi)
    return delta


def t_slip(u: FloatArray) -> FloatArray:
    """Coordinate t of the slip chart at u, the inverse of the coordinate u of `AtlasPoint`."""
    t: FloatArray = np.sin(0.5 * np.pi * u) ** 2
    return t


def b_variation(x: FloatArray, phi: FloatArray) -> FloatArray:
    """Variation b at x, the inverse of the coordinate x of `AtlasPoint`, by Newton's method; at most 1e8."""
    w = 2.0 * x - 1.0
    cone = CONE * (np.sin(phi) ** 2 + TIP)
    cube = np.abs(w) ** 3 / (1.0 + cone)  # |s|^3 = cube (s^2 + cone); convex above the root, so 1 is a start
    s = np.ones_like(cube)
    for _ in range(NODE_OPTIONS.newton_steps):
        s = s - ((s - cube) * s * s - cube * cone) / np.maximum((3.0 * s - 2.0 * cube) * s, 1e-300)
    limit = 4.0 / np.pi * np.arctan(np.sqrt(LARGEST_B)) - 1.0
    b: FloatArray = np.tan(0.25 * np.pi * (np.minimum(np.sign(w) * s, limit) + 1.0)) ** 2
    return b


def phi_phase(z: FloatArray) -> FloatArray:
    """Phase phi at z, the inverse of the coordinate z of `AtlasPoint`."""
    phi = 0.5 * np.pi * (1.0 + np.sin(FOLD_Z * (2.0 * z - 1.0)) / np.sin(FOLD_Z))
    inside: FloatArray = np.clip(phi, 0.0, np.pi)
    return inside
