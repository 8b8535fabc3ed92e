"""Errors of the contact loads along a curve of a balance, estimated by its embedded pair."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import PairOptions
from fcm.accuracy.reference_curve import ComparedQuantities, ReferenceCurve
from fcm.model.scene import FloatArray


def contact_load_errors(
    reference: ReferenceCurve, compared: ComparedQuantities, shift: FloatArray, folds: npt.NDArray[np.intp]
) -> tuple[FloatArray, FloatArray]:
    """Relative errors of contact forces, slip and energy (point, contact, 4), and of their maxima.

    The errors of the maxima are (contact, 4).

    shift (point, column) is the difference at the same frequency, in the units of the compared quantities. At
    a maximum inside the curve, the maxima of curve and reference are compared instead. NaN where the
    reference has no value at that frequency, or, at folds, two.
    """
    columns = slice(reference.amplitude.shape[1], None)
    own, unit = compared.value[:, columns], compared.unit[:, columns]
    error = np.abs(shift[:, columns])
    # differences may cancel at a frequency, but the error of the reference itself does not
    moved = reference.options.reference_error * _moved(reference, compared, columns)
    error = np.where(reference.linear[:, None], 0.0, np.maximum(error, np.where(np.isnan(moved), 0.0, moved)))
    error[folds] = np.nan
    top, last, c = own.argmax(axis=0), len(own) - 1, np.arange(own.shape[1])
    inside = (top > 0) & (top < last)
    of_reference = _greatest(reference, compared, columns)
    error[top[inside], c[inside]] = (np.abs(of_reference - own[top, c]) / unit[top, c])[inside]
    error = relative(error * unit, own, unit, reference.options)
    shape = (len(own), -1, 4)
    return error.reshape(shape), error[top, c].reshape(shape[1:])


def relative(change: FloatArray, own: FloatArray, most: FloatArray, options: PairOptions) -> FloatArray:
    """Changes of the contact loads relative to the loads themselves; `most` is their maximum along the curve.

    The relative change of a zero load is infinite, unless the change is rounding.
    """
    off = np.abs(change)
    with np.errstate(divide="ignore", invalid="ignore"):
        return np.where(off <= options.rounding * most, 0.0, off / own)


def _moved(reference: ReferenceCurve, compared: ComparedQuantities, columns: slice) -> FloatArray:
    """Distance (point, column) from curve to reference in frequency and in each quantity, in its unit.

    The distance in frequency is multiplied by the slope of the curve, up to a limit.
    """
    own, unit, change = compared.value[:, columns], compared.unit[:, columns], compared.change
    omega, most = reference.path.parameter, reference.options.max_steepness
    k = np.arange(len(omega))
    before, after = np.maximum(k - 1, 0), np.minimum(k + 1, len(omega) - 1)
    rise, run = np.abs(own[after] - own[before]), np.abs(omega[after] / omega[before] - 1.0)[:, None]
    with np.errstate(divide="ignore", invalid="ignore"):
        steep = np.where(rise < most * own * run, rise / run, most * own)
    moved: FloatArray = steep / unit * np.abs(change[:, :1]) + np.abs(change[:, 1:][:, columns])
    return moved


def _greatest(reference: ReferenceCurve, compared: ComparedQuantities, columns: slice) -> FloatArray:
    """Greatest value (column,) of each quantity on the reference.

    NaN where it may lie on a stretch along which the reference could not be followed.
    """
    own, unit = compared.value[:, columns], compared.unit[:, columns]
    expected = own + unit * compared.change[:, 1:][:, columns]
    greatest: FloatArray = np.fmax.reduce(expected, axis=0, initial=-np.inf)
    for one in reference.followed:
        for piece in one.pieces:
            greatest = np.fmax(greatest, reference.contact_loads_of(piece).max(axis=0))
    for one in reference.followed:
        if not any(piece.whole for piece in one.pieces):
            rival = own[one.first : one.end].max(axis=0) > reference.options.rival_fraction * own.max(axis=0)
            greatest[rival] = np.nan
    return greatest
