"""Greatest amplitudes of the reference of a curve, unknown where it could not be followed."""

from __future__ import annotations

import numpy as np

from fcm.accuracy.curve_distance import rises
from fcm.accuracy.reference_curve import FollowedStretch, Indices, ReferenceCurve, ReferenceTop
from fcm.continuation import Mark
from fcm.distinct_values import distinct_values
from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray


def tops_of_reference(
    reference: ReferenceCurve, change: FloatArray, shift: FloatArray, resonant: Indices
) -> list[list[ReferenceTop]]:
    """The reference at the top of the curve, and at its own top, for each degree of freedom.

    If both are at the same place, only the latter is returned. Its height is NaN if it is unknown, as the
    reference could not be followed along a stretch nearly as high as the curve.

    change, shift (point, dof) are those of the amplitudes along the curve, and at equal frequency, in their
    unit. resonant are the points where a harmonic that only the reference has meets a mode. The reference may
    have a peak beside them, and is followed there.
    """
    amplitude, options = reference.amplitude, reference.options
    now = amplitude.max(axis=0)
    near = np.zeros(len(amplitude), dtype=np.bool_)
    near[resonant] = True
    between = [
        FollowedStretch(*run, reference.stretches.between(run[0] - 1, run[1], reference.reference_unknowns))
        for run in runs(near)
    ]
    tops = _displaced_tops(reference, change, shift)
    for piece in (piece for one in (*reference.followed, *between) for piece in one.pieces):
        rows = piece.quantities.amplitude.argmax(axis=0)
        heights = piece.quantities.amplitude.max(axis=0)
        for own, row, height in zip(tops, rows.tolist(), heights.tolist(), strict=True):
            if not height <= own[-1].height:
                own[1:] = [ReferenceTop(height, row, piece)]
    for one in reference.followed:
        if not any(piece.whole for piece in one.pieces):
            rivals = amplitude[one.first : one.end].max(axis=0) > options.rival_fraction * now
            for d in np.flatnonzero(rivals).tolist():
                tops[d] = [tops[d][-1]._replace(height=np.nan)]
    return tops


def _displaced_tops(
    reference: ReferenceCurve, change: FloatArray, shift: FloatArray
) -> list[list[ReferenceTop]]:
    """The point to which the top of a curve is displaced, and the highest displaced point, if it is another.

    If the curve is highest at an end, the reference's amplitudes at the curve's frequencies are used.
    """
    amplitude, unit, last = reference.amplitude, reference.unit, len(reference.amplitude) - 1
    own = amplitude.argmax(axis=0)
    change, highest = _highest(reference, change)
    normal, at_frequency = amplitude + unit * change, amplitude + unit * shift
    rise = rise_between_points(reference, unit * change, highest)
    for end in {0, last}.intersection(own.tolist()):
        there = reference.amplitude_at_frequency(end)
        if there is not None:
            at_frequency[end] = there
    tops = []
    for d, (point, most) in enumerate(zip(own.tolist(), highest.tolist(), strict=True)):
        if 0 < point < last:
            every = [ReferenceTop(float(normal[point, d]), point)]
            top = ReferenceTop(float(normal[most, d] + rise[d]), most)
        else:
            every = [ReferenceTop(float(at_frequency[point, d]), point)]
            known = np.where(np.isnan(at_frequency[:, d]), 0.0, at_frequency[:, d])
            top = (
                every[0]
                if np.isnan(every[0].height)
                else ReferenceTop(float(known.max()), int(known.argmax()))
            )
        is_one = np.isnan(every[0].height) or every[0].point == top.point
        tops.append([top] if is_one else [*every, top])
    return tops


def rise_between_points(reference: ReferenceCurve, moved: FloatArray, places: Indices) -> FloatArray:
    """Rise (dof,) of a displaced curve between its highest points and their neighbours; see `rises`.

    moved (point, dof): displacements of the amplitudes. places (dof,): indices of the highest points.
    """
    corner = ((reference.path.mark & Mark.CORNER) > 0).view(np.uint8)
    return rises(
        reference.arc,
        reference.quantities,
        moved,
        corner,
        places,
        reference.options.distance,
    )


def _highest(reference: ReferenceCurve, change: FloatArray) -> tuple[FloatArray, Indices]:
    """Changes (point, dof), and indices (dof,) of the highest points of the reference.

    Neighbours whose interpolated height is clearly greater are computed, too, until a computed one is the
    highest.
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
        new = distinct_values(around[higher])
        reference.find(new)
        change[new] = reference.change[new, 1:]
