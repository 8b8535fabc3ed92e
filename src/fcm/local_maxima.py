"""Local maxima of a curve, and their prominence.

A local maximum is a point that is higher than the previous one and not lower than the next one.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def local_maxima(amplitude: npt.NDArray[np.float64], least: float) -> npt.NDArray[np.bool_]:
    """Mask of amplitudes (point, dof) that are local maxima, and above a fraction of the greatest of the dof.

    Ends do not count, nor do ends of parts between rows of NaN.

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

    A side extends to the next higher point, or to the end of the branch. The side before the point also ends
    at an equally high point, so that the first of several equal points is the peak.

    >>> prominence(np.array([0.0, 3.0, 2.0, 4.0, 1.0]), 1)
    1.0
    """
    before, behind = heights[k::-1], heights[k:]
    off = max(_lowest(before, before[1:] < before[0]), _lowest(behind, behind[1:] <= behind[0]))
    return float(heights[k] - off)


def _lowest(side: npt.NDArray[np.float64], counts: npt.NDArray[np.bool_]) -> float:
    """The lowest height of a side that begins at the peak, up to the first point that does not count."""
    ends = np.flatnonzero(~counts)
    return float(side[: 1 + (ends[0] if ends.size else counts.size)].min())
