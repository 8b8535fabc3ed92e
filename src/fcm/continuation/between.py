"""Points of a curve between two neighbours of a path."""

from __future__ import annotations

import numpy as np

from fcm.continuation.newton import Newton
from fcm.continuation.path import FloatArray, Path
from fcm.continuation.problem import Problem


class Between:
    """The curve from a point of a path to the next; `put` finds the point at a fraction of the way.

    Guesses lie on the cubic through both points with their directions, and are corrected across the chord.
    """

    def __init__(self, problem: Problem, path: Path, first: int) -> None:
        self.newton = Newton(problem)
        problem.measure(np.ascontiguousarray(path.z[first]))
        self._scale = np.array(problem.scale)
        self._ends = path.z[first : first + 2] / self._scale
        self._chord = self._ends[1] - self._ends[0]
        self.length = float(np.linalg.norm(self._chord))  # of the chord, in the curve's own size
        direction = path.direction[first : first + 2] / self._scale
        size = np.linalg.norm(direction, axis=1, keepdims=True)
        self._slopes = self.length * direction / np.where(size > 0.0, size, 1.0)

    def put(self, part: float) -> bool:
        """Whether there is a point at the part of the way, in [0, 1]; it is then z."""
        if self.length == 0.0:
            return False
        rest = 1.0 - part
        guess = self._ends[0] * (rest * rest * (1.0 + 2.0 * part))
        guess += self._ends[1] * (part * part * (3.0 - 2.0 * part))
        guess += part * rest * (rest * self._slopes[0] - part * self._slopes[1])
        self.newton.scale[:] = self._scale
        self.newton.row[:] = self._chord / self.length
        self.newton.z[:] = guess * self._scale
        return bool(self.newton.correct(self.length)) and self.newton.moved <= self.length

    @property
    def z(self) -> FloatArray:
        """The point found last, (unknown + 1,)."""
        return np.array(self.newton.z)

    @property
    def direction(self) -> FloatArray:
        """Of the curve there, in the units of z."""
        direction: FloatArray = np.asarray(self.newton.tangent) * self._scale
        return direction

    @property
    def orientation(self) -> float:
        """Sign of the determinant there."""
        return float(self.newton.orientation)
