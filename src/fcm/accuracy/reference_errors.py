r"""The reference's own error, where it may exceed the error that the pair estimates.

The spectrum of the exact forces times the receptance gives the shares s_h of the harmonics that the reference
lacks. These are without feedback, and known all along the curve. With feedback, the error is

    e_reference = g sum_h s_h.

A second reference, with more harmonics, gives the gain g at a few points where e_reference may exceed the
error of the pair. At such points the amplitudes of curve and reference cross, or harmonics converge slowly.
The estimated errors are raised to e_reference.
"""

from __future__ import annotations

import numpy as np

from fcm.accuracy.reference_curve import ReferenceCurve
from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray


def with_reference_errors(reference: ReferenceCurve, error: FloatArray) -> FloatArray:
    """Errors (point, dof), in the unit of `ReferenceCurve`, raised to at least the reference's own error.

    NaN stays NaN.
    """
    options, arc = reference.options, reference.arc
    known = np.flatnonzero(reference.is_found & ~np.isnan(error).any(axis=1))
    known = known[:: -(-len(known) // options.max_spectra) or 1]
    if not known.size or not reference.may_have_second:
        return error
    largest = reference.amplitude.max(axis=1)
    estimated = (error * reference.unit).max(axis=1) / np.where(largest > 0.0, largest, 1.0)
    left = np.interp(arc, arc[known], reference.left_out(known))
    uncertain = (options.feedback_factor * left > estimated) & ~reference.linear
    asked = list[int]()
    for first, end in runs(uncertain):
        asked += known[(first <= known) & (known < end)].tolist() or [(first + end) // 2]
    asked = asked[:: -(-len(asked) // options.max_uncertain) or 1]
    gain = {i: own / left[i] for i in asked if (own := reference.own_error(i)) is not None}
    if not gain:
        return error
    raised, at, rows = error.copy(), arc[list(gain)], ~reference.linear
    for d, each in enumerate(np.transpose(list(gain.values()))):
        raised[rows, d] = np.maximum(raised[rows, d], left[rows] * np.interp(arc[rows], at, each))
    return raised
