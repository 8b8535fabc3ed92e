"""Points of a curve that are too far from the exact motion for their stability to be trusted."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from fcm.accuracy.options import VALIDITY, ValidityOptions
from fcm.harmonic_balance.consecutive_points import runs
from fcm.model.scene import FloatArray

Mask = npt.NDArray[np.bool_]


def unreliable_points(
    frequency: FloatArray,
    truncations: Sequence[FloatArray],
    stable: FloatArray,
    fold: Mask,
    options: ValidityOptions = VALIDITY,
) -> Mask:
    """Mask of the points of successive branches that are, or may be, too far from the exact motion.

    Parameters
    ----------
    frequency, stable, fold : array (point,)
        Frequencies, stability, and whether a point is a fold.
    truncations : sequence of array (point,)
        Estimated errors of each branch, NaN where there is none.
    options : ValidityOptions, optional
        Errors up to which a solution is called stable.
    """
    truncation = np.concatenate(truncations)
    lost = np.concatenate([on_other_branch(one, options) for one in truncations])
    unknown = _without_error(frequency, truncation, stable, fold, options)
    far: Mask = (truncation > options.max_error) | lost | unknown
    return far


def on_other_branch(truncation: FloatArray, options: ValidityOptions = VALIDITY) -> Mask:
    """Mask (point,) of long stretches on which the reference was not found.

    There a branch says nothing about the exact motion.
    """
    far = np.zeros(len(truncation), dtype=np.bool_)
    for first, end in runs(np.isnan(truncation)):
        far[first:end] = end - first > options.max_unknown_points
    return far


def without_neighbour(
    truncation: FloatArray, is_same_curve: Mask, options: ValidityOptions = VALIDITY
) -> Mask:
    """Mask (point,) of points that have no motion with more harmonics near them.

    truncation is their relative distance from the reference's curve, or from its nearest motion.
    """
    far: Mask = ~is_same_curve & (truncation > options.max_change)
    return far


def _without_error(
    frequency: FloatArray, truncation: FloatArray, stable: FloatArray, fold: Mask, options: ValidityOptions
) -> Mask:
    """Mask (point,) of stretches without a known error, which time integration often leaves.

    A fold has no error either: a stretch at a fold is not marked if its stable part is narrow. A single point
    with a small error, as at a corner, does not split a stretch.
    """
    found, unknown = np.zeros(len(truncation), dtype=np.bool_), np.isnan(truncation)
    unknown[1:-1] |= unknown[:-2] & unknown[2:] & (truncation[1:-1] <= options.max_error)
    for first, end in runs(unknown):
        own = frequency[first:end][stable[first:end] == 1.0]
        wide = own.size > 0 and np.ptp(own) > options.max_fold_error * own.max()
        found[first:end] = wide or not fold[max(first - 1, 0) : end + 1].any()
    return found
