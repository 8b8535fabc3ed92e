"""The least of the peaks of a sweep, for sweeps that minimise a peak."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from fcm.model.scene import FloatArray


class LeastPeak(NamedTuple):
    """Curve of a sweep with the least peak, and whether it is at an end of the sweep.

    If so, a lower peak may lie beyond, or between it and the next value.
    """

    curve: int
    at_end_of_sweep: bool


def least_peak(
    amplitude: FloatArray, swept: FloatArray, counted: npt.NDArray[np.bool_], at_end: npt.NDArray[np.bool_]
) -> LeastPeak | None:
    """The least of the peaks of the curves that count, all arrays (curve,); None if there is none.

    at_end : whether the maximum of a curve is at an end of the range of frequencies, and so not a peak.

    >>> amplitude, n_0 = np.array([8.0, 6.0, 7.0]), np.array([0.0, 10.0, 20.0])
    >>> counted = np.ones(3, dtype=bool)
    >>> least_peak(amplitude, n_0, counted, np.zeros(3, dtype=bool))
    LeastPeak(curve=1, at_end_of_sweep=False)
    >>> least_peak(amplitude, n_0, counted, np.array([False, True, False]))
    LeastPeak(curve=2, at_end_of_sweep=True)
    """
    curves = np.flatnonzero(counted & ~at_end)
    if not curves.size:
        return None
    least = int(curves[np.argmin(amplitude[curves])])
    ends = swept[counted].min(), swept[counted].max()
    return LeastPeak(least, bool(ends[0] < ends[1] and swept[least] in ends))
