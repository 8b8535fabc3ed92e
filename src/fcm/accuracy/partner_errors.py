r"""What a partner is off by itself, where that may be more than the error that it tells.

What the harmonics that it lacks would do without feedback is known all along of the spectrum of its exact
forces times the receptance. Feedback makes

    e_partner = g sum_h s_h

of it. The gain g is that of a partner of its own, at a few points where this may be more than what is told:
where amplitudes of curve and partner cross, or harmonics converge slowly. No error is less than e_partner.
"""

from __future__ import annotations

import numpy as np

from fcm.accuracy.partner_curve import PartnerCurve
from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray


def with_partner_errors(partner: PartnerCurve, error: FloatArray) -> FloatArray:
    """Errors (point, dof) in units of the partner's curve, at least what that is off by itself. NaN stays."""
    options, place = partner.options, partner.place
    known = np.flatnonzero(partner.is_found & ~np.isnan(error).any(axis=1))
    known = known[:: -(-len(known) // options.max_spectra) or 1]
    if not known.size or not partner.may_have_second:
        return error
    largest = partner.amplitude.max(axis=1)
    told = (error * partner.unit).max(axis=1) / np.where(largest > 0.0, largest, 1.0)
    left = np.interp(place, place[known], partner.left_out(known))
    doubtful = (options.feedback_factor * left > told) & ~partner.linear
    asked = list[int]()
    for first, end in runs(doubtful):
        asked += known[(first <= known) & (known < end)].tolist() or [(first + end) // 2]
    asked = asked[:: -(-len(asked) // options.max_doubts) or 1]
    gain = {i: own / left[i] for i in asked if (own := partner.own_error(i)) is not None}
    if not gain:
        return error
    raised, at, rows = error.copy(), place[list(gain)], ~partner.linear
    for d, each in enumerate(np.transpose(list(gain.values()))):
        raised[rows, d] = np.maximum(raised[rows, d], left[rows] * np.interp(place[rows], at, each))
    return raised
