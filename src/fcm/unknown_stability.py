"""Where along a curve it is unknown whether a motion is stable."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def unknown_stability(stable: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Where (point,) it is not known whether a motion is stable, other than at the very point at which that
    changes from one neighbour to the other.

    >>> unknown_stability(np.array([1.0, np.nan, 0.0, np.nan, np.nan, 1.0, np.nan, 1.0])).tolist()
    [False, False, False, True, True, False, True, False]
    """
    unknown = np.isnan(stable)
    unknown[1:-1] &= np.abs(stable[2:] - stable[:-2]) != 1.0
    return unknown
