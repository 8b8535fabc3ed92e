"""Tracked curves with exact points at given values of the number, such as that of the optimum."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.optimize import brentq

from fcm.model.scene import FloatArray
from fcm.tracking.curve import SpecialPointCurve, with_points
from fcm.tracking.peak_envelope import MonotonePiece, Target, pieces_of
from fcm.tracking.tracked_point import TrackedPoint, TrackingSetup


def with_user_points(
    setup: TrackingSetup, track: SpecialPointCurve, values: Sequence[float]
) -> SpecialPointCurve:
    """Add points at values of s that a curve passes, by Newton's method from the chord."""
    points = list[TrackedPoint]()
    for i, point in enumerate(track.points):
        points.append(point)
        if i + 1 == len(track.points):
            break
        one, other = float(track.s[i]), float(track.s[i + 1])
        rising = 1.0 if other > one else -1.0
        piece = MonotonePiece(setup, track, [i, i + 1], 0)
        inside = {s for s in values if (s - one) * (s - other) < 0.0}
        there = [piece.point(s, rising) for s in sorted(inside, key=lambda s: rising * s)]
        points += [one for one in there if one is not None]
    return with_points(setup, track, points) if len(points) > len(track.points) else track


def values_at_height(
    setup: TrackingSetup, tracks: Sequence[SpecialPointCurve], targets: Sequence[Target], limit: float
) -> list[float]:
    """Exact values of s at which a peak of a target has the height limit."""
    found = list[float]()
    for piece in (piece for target in targets for piece in pieces_of(setup, tracks, target)):
        off: FloatArray = piece.height - limit
        for i in np.flatnonzero(off[:-1] * off[1:] < 0.0):
            ends = [float(piece.s[i]), float(piece.s[i + 1])]
            exact = [piece.at(s).value - limit for s in ends]
            if exact[0] * exact[1] < 0.0:
                fine = setup.options.envelope.value_tolerance * (setup.span[1] - setup.span[0])
                found.append(
                    float(brentq(lambda s, piece=piece: piece.at(s).value - limit, *ends, xtol=fine))
                )
    return found
