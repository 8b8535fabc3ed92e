"""Points of a curve, evenly along it: behind corners they lie close together, and tell the same."""

from __future__ import annotations

import numpy as np

from fcm.model.scene import FloatArray


class SpacedPoints:
    """Points of a curve counted by their distance, so that crowded ones count less.

    number (point,): how many points there are up to each, of which those that are nearer to the one before
    than the mean distance count less.
    """

    def __init__(self, z: FloatArray, crowded: bool) -> None:
        """z (point, unknown + 1); crowded: whether they may be; else each counts as one."""
        self.number = np.arange(float(len(z)))
        steps = np.diff(path_lengths(z))
        if crowded and steps.size and steps.sum() > 0.0:
            self.number[1:] = np.cumsum(np.minimum(steps / steps.mean(), 1.0))

    def nodes(self, first: int, last: int, interval: int) -> list[int]:
        """Points from one to another, no more than an interval apart."""
        way = self.number[last] - self.number[first]
        parts = max(int(np.ceil(way / interval)), 1)
        at = self.number[first] + way * np.arange(parts + 1) / parts
        found = np.searchsorted(self.number[first : last + 1], at + 1e-6, "right") - 1
        return sorted({first, last, *(first + found).tolist()})

    def middle(self, first: int, last: int) -> int:
        """The point between two, more than one apart, that is nearest to the middle."""
        inside = self.number[first + 1 : last]
        return first + 1 + int(np.abs(inside - 0.5 * (self.number[first] + self.number[last])).argmin())


def path_lengths(z: FloatArray) -> FloatArray:
    """Way up to each point (point, unknown + 1), relative to the size of the solution and the frequency."""
    x, omega = z[:, :-1], z[:, -1]
    size = np.abs(x).max(axis=1, initial=np.finfo(float).tiny)[1:]
    steps = np.abs(np.diff(x, axis=0)).max(axis=1, initial=0.0) / size + np.abs(np.diff(omega)) / omega[1:]
    return np.concatenate(([0.0], np.cumsum(steps)))
