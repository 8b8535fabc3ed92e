"""Finds the points of a curve with unknown stability."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def unknown_stability(stable: npt.NDArray[np.float64]) -> npt.NDArray[np.bool_]:
    """Mask (point,) of the points of unknown stability.

    A single unknown point between a stable and an unstable neighbour does not count.

    >>> unknown_stability(np.array([1.0, np.nan, 0.0, np.nan, np.nan, 1.0, np.nan, 1.0])).tolist()
    [False, False, False, True, True, False, True, False]
    """
    unknown = np.isnan(stable)
    unknown[1:-1] &= np.abs(stable[2:] - stable[:-2]) != 1.0
    return unknown
