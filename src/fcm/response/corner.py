"""Corners of response curves: how far ahead one is, and the way out of one at which the curve turns back.

Where a regime begins, a response curve has a corner. If the curve turns back on itself there, its new
direction is found from the equations just beyond, with the orientation that the sign of the determinant
carries across a corner, as for piecewise linear paths (Allgower and Georg, "Introduction to Numerical
Continuation Methods").
"""

from __future__ import annotations

import numpy as np

from fcm.contact.limits import FloatArray
from fcm.response.newton import Equations, correct, oriented_tangent
from fcm.response.structure import BoolArray

BEND = 0.1  # two pieces that miss each other by less than this of their length meet in a corner
POINT = 1e-7  # a corner known to this is a point from which the curve may turn back
TRIES = 16  # directions around a corner in which its regimes are looked for
DISTANCES = POINT * np.array([1e1, 1e2, 1e3, 1e4])


def corner_ahead(
    chord: FloatArray, before: FloatArray, beyond: FloatArray, cosine: FloatArray
) -> tuple[BoolArray, FloatArray]:
    """Whether straight pieces along two tangents make up a chord, and the length of the first.

    chord, before, beyond: (curve, unknown + 1), scaled; before and beyond are unit vectors with this cosine.
    """
    along_before, along_beyond = (chord * before).sum(axis=1), (chord * beyond).sum(axis=1)
    square = np.maximum(1.0 - cosine * cosine, 1e-6)
    s = (along_before - cosine * along_beyond) / square
    r = (along_beyond - cosine * along_before) / square
    off = chord - s[:, None] * before - r[:, None] * beyond
    meet: BoolArray = (np.minimum(s, r) > 0.0) & (np.sqrt((off * off).sum(axis=1)) < BEND * (s + r))
    return meet, s


def turn_back(
    equations: Equations, z: FloatArray, scale: FloatArray, tangent: FloatArray, orientation: FloatArray
) -> tuple[FloatArray, FloatArray, float] | None:
    """A point beyond the corner at z of one curve, the direction there, and its distance; None if not found.

    Tries the directions of the curve in the regimes around the corner, at growing distances. All arguments
    have a leading axis of length 1.
    """
    directions = np.random.default_rng(0).normal(size=(TRIES, z.shape[1]))
    directions[0] = tangent[0]
    directions /= np.sqrt((directions**2).sum(axis=1, keepdims=True))
    tries = equations.take(np.zeros(TRIES, dtype=np.intp))
    scale, orientation = np.repeat(scale, TRIES, axis=0), np.repeat(orientation, TRIES)
    for reach in DISTANCES:
        around = oriented_tangent(tries, z + reach * scale * directions, scale, directions, orientation)
        new = correct(tries, z + reach * scale * around, scale, around, 1e-3 * reach, reach=reach)
        step = (new.z - z) / scale
        length = np.sqrt((step**2).sum(axis=1))
        ok = new.converged & (new.determinant == orientation) & (length < 3.0 * reach)
        ok &= (new.tangent * step).sum(axis=1) > 0.5 * length  # the curve leads away from the corner
        ok &= step @ tangent[0] > -0.99 * length  # and is not the one that led to it
        if ok.any():
            chosen = int(np.argmax(ok))
            return new.z[chosen], new.tangent[chosen], float(reach)
    return None
