"""Points of a curve between two neighbours of a path."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from fcm.continuation.corrector import Newton
from fcm.continuation.options import PATH
from fcm.continuation.path import FloatArray, Path
from fcm.continuation.problem import Problem
from fcm.cubic import curve_between


class _Known(NamedTuple):
    """A known point of the curve, in scaled coordinates."""

    at: float  # length along the chord
    z: FloatArray
    slope: FloatArray  # with respect to that length


class Segment:
    """The curve between two successive points of a path; `find` finds the point at a fraction of the way.

    Guesses are corrected in planes normal to the chord. The first guess lies on the cubic through both ends
    with their tangents. Later ones lie at the same length along the chord, on the cubic through the nearest
    points found.
    """

    def __init__(self, problem: Problem, path: Path, first: int) -> None:
        self.newton, self._flat = Newton(problem), PATH.min_cosine
        problem.evaluate_scale(np.ascontiguousarray(path.z[first]))
        self._scale = np.array(problem.scale)
        self._ends = path.z[first : first + 2] / self._scale
        self._chord = self._ends[1] - self._ends[0]
        self.length = float(np.linalg.norm(self._chord))  # of the chord, scaled
        direction = path.direction[first : first + 2] / self._scale
        size = np.linalg.norm(direction, axis=1, keepdims=True)
        self._tangents = direction / np.where(size > 0.0, size, 1.0)
        self._found = list[_Known]()

    def find(self, part: float) -> bool:
        """Whether there is a point at the part of the way, in [0, 1]; `z` is then that point."""
        if self.length == 0.0:
            return False
        self.newton.scale[:] = self._scale
        self.newton.row[:] = self._chord / self.length
        self.newton.z[:] = self._guess(part) * self._scale
        if not (self.newton.correct(self.length) and self.newton.moved <= self.length):
            return False
        self._found.append(self._place(self.z / self._scale, np.array(self.newton.tangent)))
        return True

    def _guess(self, part: float) -> FloatArray:
        """The guess, scaled, for the point at the part of the way."""
        (one, other), (begin, end) = self._ends, self._tangents
        first, last = self._place(one, begin), self._place(other, end)
        whole = curve_between(one, other, begin, end, self.length, part)
        at = self._along(whole)
        low = max((one for one in self._found if one.at <= at), key=lambda one: one.at, default=first)
        high = min((one for one in self._found if one.at > at), key=lambda one: one.at, default=last)
        if not self._found or not low.at < at < high.at:
            return whole
        width = high.at - low.at
        near = curve_between(low.z, high.z, low.slope, high.slope, width, (at - low.at) / width)
        near += (at - self._along(near)) / self.length * self._chord
        return near

    def _along(self, z: FloatArray) -> float:
        """The length along the chord of a point."""
        return float((z - self._ends[0]) @ self._chord) / self.length

    def _place(self, z: FloatArray, tangent: FloatArray) -> _Known:
        """A point of the curve, with its slope with respect to the length along the chord."""
        cosine = float(tangent @ self._chord) / self.length
        return _Known(self._along(z), z, tangent / np.copysign(max(abs(cosine), self._flat), cosine))

    @property
    def z(self) -> FloatArray:
        """The point found last, (unknown + 1,)."""
        return np.array(self.newton.z)

    @property
    def direction(self) -> FloatArray:
        """Direction of the curve at the point found last, in the units of z."""
        direction: FloatArray = np.asarray(self.newton.tangent) * self._scale
        return direction

    @property
    def orientation(self) -> float:
        """Sign of the determinant at the point found last."""
        return float(self.newton.orientation)
