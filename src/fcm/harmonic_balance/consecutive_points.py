"""Runs of points in a row."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt


def runs(which: npt.NDArray[np.bool_]) -> list[tuple[int, int]]:
    """Return the first point of each run, and the point after its last.

    Examples
    --------
    >>> runs(np.array([True, False, True, True]))
    [(0, 1), (2, 4)]
    """
    if not which.any():
        return []
    inside = np.zeros(len(which) + 2, dtype=np.bool_)
    inside[1:-1] = which
    ends = (inside[1:] != inside[:-1]).nonzero()[0]
    return [(first, end) for first, end in ends.reshape(-1, 2).tolist()]
