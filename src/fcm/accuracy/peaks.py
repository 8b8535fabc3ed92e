"""The greatest amplitudes of the partner of a curve, and where they cannot be told."""

from __future__ import annotations

import numpy as np

from fcm.accuracy.curve_distance import rises
from fcm.accuracy.options import PAIR
from fcm.accuracy.partner_curve import FollowedStretch, Indices, PartnerCurve
from fcm.continuation import Mark
from fcm.model.scene import FloatArray


def heights(
    partner: PartnerCurve, change: FloatArray, followed: list[FollowedStretch], tops: Indices
) -> FloatArray:
    """Greatest amplitudes (dof,) of the partner of a curve that is highest at the tops (dof,).

    change (point, dof): of the amplitudes along the curve, in their unit. Unknown along a stretch that
    is nearly as high, and that the partner could not be followed along.
    """
    amplitude, options = partner.amplitude, partner.options
    d = np.arange(len(tops))
    now = amplitude[tops, d]
    change, highest = _highest(partner, change)
    greatest: FloatArray = amplitude[highest, d] + partner.unit[highest, d] * change[highest, d]
    greatest += rise_between_points(partner, partner.unit * change, highest)
    for top in np.unique(tops[(partner.path.mark[tops] & Mark.CORNER) > 0]).tolist():
        if _gap(partner, top):
            for piece in partner.stretches.between(top - 1, top + 1):
                beyond = piece.shown.amplitude.max(axis=0)
                greatest = np.where(tops == top, np.fmax(greatest, beyond), greatest)
    for one in followed:
        for piece in one.pieces:
            greatest = np.fmax(greatest, piece.shown.amplitude.max(axis=0))
    for one in followed:
        if not any(piece.whole for piece in one.pieces):
            greatest[amplitude[one.first : one.end].max(axis=0) > options.rival_fraction * now] = np.nan
    return greatest


def rise_between_points(partner: PartnerCurve, moved: FloatArray, places: Indices) -> FloatArray:
    """By how much (dof,) a curve whose amplitudes are moved (point, dof) is higher between its highest points
    and the next; places: the indices of the highest.

    Of the amplitudes that is the cubic with their growth, of what they are moved by a straight line. Nothing
    is told of what lies between a point and a corner.
    """
    corner = ((partner.path.mark & Mark.CORNER) > 0).view(np.uint8)
    return rises(
        partner.place,
        partner.amplitude,
        partner.shown.growth,
        moved,
        corner,
        places,
        partner.options.distance,
    )


def _highest(partner: PartnerCurve, change: FloatArray) -> tuple[FloatArray, Indices]:
    """Changes (point, dof) and where (dof,) with them the partner is highest of the points where it is found:
    also at those near the highest that are expected to be higher, as an interpolated one may be, by more than
    nothing."""
    change, count, near = (
        change.copy(),
        len(change),
        np.arange(-PAIR.peak_neighbours, PAIR.peak_neighbours + 1)[:, None],
    )
    while True:
        expected = partner.amplitude + partner.unit * change
        value = np.where(partner.known[:, None] & np.isfinite(change), expected, 0.0)
        places = value.argmax(axis=0)
        d, around = np.arange(len(places)), np.clip(places + near, 0, count - 1)
        least = value[places, d] * (1.0 + partner.options.negligible_displacement)
        higher = ~partner.known[around] & (expected[around, d] > least)
        if not higher.any():
            return change, places
        new = np.unique(around[higher])
        partner.find(new)
        change[new] = partner.change[new, 1:]


def _gap(partner: PartnerCurve, top: int) -> bool:
    """Whether a corner moves so far along the curve that no point of the partner is near its top.

    Of the two pieces of the partner beside it one then goes on beyond what is displaced to it.
    """
    path, growth, neighbours = partner.path, partner.shown.growth, np.array([top - 1, top + 1])
    if top == 0 or top == len(path.z) - 1:
        return False
    partner.find(neighbours)
    moved = path.parameter[neighbours] * partner.change[neighbours, 0]
    slope = np.abs(growth[neighbours] / path.direction[neighbours, -1][:, None]).min(axis=0)
    higher = np.abs(moved[1] - moved[0]) * slope
    changed = np.abs(partner.change[neighbours, 1:]).max(axis=0) * partner.unit[top]
    top_of = partner.amplitude[top] >= partner.amplitude.max(axis=0)
    return bool((higher > partner.options.gap_fraction * changed)[top_of].any())
