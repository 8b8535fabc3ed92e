"""Local maxima of a curve, and how far they stand out.

A local maximum is a point higher than the one before and no lower than the one behind.
"""

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


def prominence(heights: npt.NDArray[np.float64], k: int) -> float:
    """Prominence of a point: its height above the higher of the two lowest points on either side.

    A side reaches to a higher point, or to the end of the branch; that before the point to one as high, too,
    so that the first of several is the peak.

    >>> prominence(np.array([0.0, 3.0, 2.0, 4.0, 1.0]), 1)
    1.0
    """
    before, behind = heights[k::-1], heights[k:]
    off = max(_lowest(before, before[1:] < before[0]), _lowest(behind, behind[1:] <= behind[0]))
    return float(heights[k] - off)


def _lowest(side: npt.NDArray[np.float64], counts: npt.NDArray[np.bool_]) -> float:
    """The lowest of a way that begins at a peak, as far as the points behind that count."""
    ends = np.flatnonzero(~counts)
    return float(side[: 1 + (ends[0] if ends.size else counts.size)].min())
