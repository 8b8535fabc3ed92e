"""Local maxima of a curve: points higher than the one before and no lower than the one behind."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def local_maxima(amplitude: npt.NDArray[np.float64], least: float) -> npt.NDArray[np.bool_]:
    """Mask of amplitudes (point, dof) that are local maxima, above a fraction of the greatest of each.

    Ends are none, nor are those of parts between rows of NaN.

    >>> local_maxima(np.array([[1.0], [3.0], [2.0], [4.0], [0.0]]), 0.1).ravel().tolist()
    [False, True, False, True, False]
    """
    found = np.zeros(amplitude.shape, dtype=np.bool_)
    if len(amplitude) > 2:
        inner, enough = amplitude[1:-1], least * np.fmax.reduce(amplitude, axis=0)
        found[1:-1] = (inner > amplitude[:-2]) & (inner >= amplitude[2:]) & (inner > enough)
    return found
