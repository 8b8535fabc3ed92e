"""Points spaced evenly along a curve: behind corners, points are crowded and tell nothing new."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray


class SpacedPoints:
    """Points of a curve counted by their distance, so that crowded ones count less.

    number (point,) counts the points up to each. A point nearer to the one before than the mean distance
    counts as the fraction of it.
    """

    def __init__(self, z: FloatArray, crowded: bool) -> None:
        """z (point, unknown + 1). crowded: whether points may be crowded; if not, each counts as one."""
        self.number = np.arange(float(len(z)))
        steps = np.diff(path_lengths(z))
        if crowded and steps.size and steps.sum() > 0.0:
            self.number[1:] = np.cumsum(np.minimum(steps / steps.mean(), 1.0))

    def nodes(self, first: int, last: int, interval: int) -> list[int]:
        """Points from first to last, both included, no more than an interval apart."""
        way = self.number[last] - self.number[first]
        parts = max(int(np.ceil(way / interval)), 1)
        at = self.number[first] + way * np.arange(parts + 1) / parts
        found = np.searchsorted(self.number[first : last + 1], at + 1e-6, "right") - 1
        return sorted({first, last, *(first + found).tolist()})

    def middle(self, first: int, last: int) -> int:
        """The point strictly between two that is nearest to the middle."""
        inside = self.number[first + 1 : last]
        return first + 1 + int(np.abs(inside - 0.5 * (self.number[first] + self.number[last])).argmin())


def path_lengths(z: FloatArray) -> FloatArray:
    """Length of the curve up to each point (point, unknown + 1), relative to its size and frequency."""
    x, omega = z[:, :-1], z[:, -1]
    size = np.abs(x).max(axis=1, initial=np.finfo(float).tiny)[1:]
    steps = np.abs(np.diff(x, axis=0)).max(axis=1, initial=0.0) / size + np.abs(np.diff(omega)) / omega[1:]
    return np.concatenate(([0.0], np.cumsum(steps)))
