"""Where more harmonics end a branch at its folds: of points beyond nothing is told.

Points of the corrected curve next to a fold are found in planes normal to the curve, wherever its own fold
is; at the frequency of a point beyond that it has no solution. With other further harmonics the fold is
elsewhere, by about as much as it moved: an error that is told there hangs on which of them were taken.
"""

from __future__ import annotations

import numpy as np

from fcm.continuation import Mark, Path
from fcm.harmonic.corrected import Corrected
from fcm.scene.model import FloatArray

TWICE = 2.0  # times what harmonics were first found to move a fold, no others move it farther


def without_ended(corrected: Corrected, shift: FloatArray) -> FloatArray:
    """Shifts (point, dof) of amplitudes at the same frequency, NaN beyond folds that move towards the branch.

    The harmonics that move a fold farthest decide. They are looked for where something is told at all.
    """
    found, path = shift.copy(), corrected.path
    for fold in path.where(Mark.FOLD).tolist():
        here, once = float(path.parameter[fold]), float(corrected.change[fold, 0])
        inwards = -_outwards(path.parameter, fold)
        if not once * inwards > 0.0:
            continue
        near = _beyond(path, fold, here * (1.0 + TWICE * once))
        if np.isfinite(found[near]).all(axis=1).sum() > np.isfinite(found[fold]).all():
            found[_beyond(path, fold, corrected.farthest(fold, inwards))] = np.nan
    return found


def _outwards(parameter: FloatArray, fold: int) -> float:
    """1 where the parameter is greatest at a fold, -1 where it is least."""
    beside = parameter[[max(fold - 1, 0), min(fold + 1, len(parameter) - 1)]]
    return 1.0 if parameter[fold] >= beside.mean() else -1.0


def _beyond(path: Path, fold: int, end: float) -> slice:
    """The points around a fold from a frequency on, none of them beyond the next folds."""
    low, high = sorted((end, float(path.parameter[fold])))
    within = (path.parameter >= low) & (path.parameter <= high)
    within[(path.mark & Mark.FOLD) > 0] = False
    first, last = fold, fold
    while first > 0 and within[first - 1]:
        first -= 1
    while last < len(within) - 1 and within[last + 1]:
        last += 1
    return slice(first, last + 1)
