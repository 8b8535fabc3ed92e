"""Greatest amplitudes of the reference of a curve, unknown where it could not be followed."""

from __future__ import annotations

import numpy as np

from fcm.accuracy.curve_distance import rises
from fcm.accuracy.reference_curve import FollowedStretch, Indices, ReferenceCurve
from fcm.continuation import Mark
from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray


def heights(
    reference: ReferenceCurve,
    change: FloatArray,
    followed: list[FollowedStretch],
    tops: Indices,
    resonant: Indices,
) -> FloatArray:
    """Greatest amplitudes (dof,) of the reference of a curve whose own highest points are tops (dof,).

    change (point, dof): of the amplitudes along the curve, in their unit. resonant: points where a harmonic
    that only the reference has meets a mode: between these it may have a peak, and is followed where they are
    nearly as high. Unknown along a stretch that is as high, and that the reference could not be followed
    along.
    """
    amplitude, options = reference.amplitude, reference.options
    d = np.arange(len(tops))
    now = amplitude[tops, d]
    change, highest = _highest(reference, change)
    greatest: FloatArray = amplitude[highest, d] + reference.unit[highest, d] * change[highest, d]
    greatest += rise_between_points(reference, reference.unit * change, highest)
    near = np.zeros(len(amplitude), dtype=np.bool_)
    near[resonant] = True
    high = [run for run in runs(near) if (amplitude[slice(*run)] > options.rival_fraction * now).any()]
    between = [
        FollowedStretch(*run, reference.stretches.between(run[0] - 1, run[1], reference.reference_unknowns))
        for run in high
    ]
    for one in (*followed, *between):
        for piece in one.pieces:
            greatest = np.fmax(greatest, piece.quantities.amplitude.max(axis=0))
    for one in followed:
        if not any(piece.whole for piece in one.pieces):
            greatest[amplitude[one.first : one.end].max(axis=0) > options.rival_fraction * now] = np.nan
    return greatest


def rise_between_points(reference: ReferenceCurve, moved: FloatArray, places: Indices) -> FloatArray:
    """Rise (dof,) of a displaced curve between its highest points and their neighbours.

    moved (point, dof): displacements of the amplitudes. places: indices of the highest points.

    Of the amplitudes that is the cubic with their growth, of what they are moved by a straight line. Nothing
    is told of what lies between a point and a corner.
    """
    corner = ((reference.path.mark & Mark.CORNER) > 0).view(np.uint8)
    return rises(
        reference.place,
        reference.amplitude,
        reference.quantities.growth,
        moved,
        corner,
        places,
        reference.options.distance,
    )


def _highest(reference: ReferenceCurve, change: FloatArray) -> tuple[FloatArray, Indices]:
    """Changes (point, dof) and indices (dof,) of the highest points of the reference.

    Neighbours whose interpolated height is clearly greater are computed as well, until the highest is a
    computed one.
    """
    change, count, options = change.copy(), len(change), reference.options
    near = np.arange(-options.peak_neighbours, options.peak_neighbours + 1)[:, None]
    while True:
        expected = reference.amplitude + reference.unit * change
        value = np.where(reference.known[:, None] & np.isfinite(change), expected, 0.0)
        places = value.argmax(axis=0)
        d, around = np.arange(len(places)), np.clip(places + near, 0, count - 1)
        least = value[places, d] * (1.0 + options.negligible_displacement)
        higher = ~reference.known[around] & (expected[around, d] > least)
        if not higher.any():
            return change, places
        new = np.unique(around[higher])
        reference.find(new)
        change[new] = reference.change[new, 1:]
